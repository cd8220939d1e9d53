// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/DequantizeRows.h"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "Series/Quantize/DequantizeRows.cxx"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{
namespace hn = hwy::HWY_NAMESPACE;

/// Values of numbers that lie side by side.
template <class Number, class T>
class RowOfValues
{
public:
  RowOfValues(double origin, double step)
    : Origin(origin)
    , Step(step)
    , Origins(hn::Set(Real(), origin))
    , Steps(hn::Set(Real(), step))
  {
  }

  HWY_INLINE void Write(const Number* from, int count, T* to) const
  {
    const int lanes = static_cast<int>(hn::Lanes(Real()));
    if (count == 2 * lanes) // what a block has, where vectors are long
    {
      this->Compute(from, to);
      this->Compute(from + lanes, to + lanes);
      return;
    }
    int x = 0;
    for (; x + lanes <= count; x += lanes)
    {
      this->Compute(from + x, to + x);
    }
    if (x < count && count >= lanes)
    {
      this->Compute(from + count - lanes, to + count - lanes); // the rest, and some once more
      return;
    }
    for (; x < count; ++x)
    {
      to[x] = static_cast<T>(this->Origin + static_cast<double>(from[x]) * this->Step);
    }
  }

private:
  using Real = hn::ScalableTag<double>;

  HWY_INLINE void Compute(const Number* from, T* at) const
  {
    const Real real;
    const hn::Rebind<std::int32_t, Real> whole;
    hn::VFromD<decltype(whole)> n;
    if constexpr (sizeof(Number) == sizeof(std::int32_t))
    {
      n = hn::LoadU(whole, from);
    }
    else
    {
      n = hn::PromoteTo(whole, hn::LoadU(hn::Rebind<Number, Real>(), from));
    }
    // Not fused: a product is rounded before it is added, wherever this runs.
    const auto y = hn::Add(hn::Mul(hn::PromoteTo(real, n), this->Steps), this->Origins);
    if constexpr (sizeof(T) == sizeof(double))
    {
      hn::StoreU(y, real, at);
    }
    else
    {
      const hn::Rebind<float, Real> single;
      hn::StoreU(hn::DemoteTo(single, y), single, at);
    }
  }

  double Origin, Step;
  hn::VFromD<Real> Origins, Steps;
};

template <class Number, class T>
void Values(const Number* numbers, const glm::i64vec3& pitch, const glm::ivec3& size, double origin,
  double step, T* values, const glm::i64vec3& to)
{
  const RowOfValues<Number, T> row(origin, step);
  for (int z = 0; z < size.z; ++z)
  {
    for (int y = 0; y < size.y; ++y)
    {
      T* const at = values + z * to.z + y * to.y;
      // Rows are lines of the cache that lie far apart: ask for them before they are written.
      __builtin_prefetch(at + 2 * to.z, 1);
      row.Write(numbers + z * pitch.z + y * pitch.y, size.x, at);
    }
  }
}

template <class Number, class T>
void Parts(const LatticePart<Number>* parts, int count, int y, int z, double origin, double step,
  T* values, const glm::i64vec3& to)
{
  const RowOfValues<Number, T> row(origin, step);
  // Boxes that did not have to be decoded are not at hand: some rows ahead they are asked for. They
  // may end before.
  constexpr std::uintptr_t ahead = 256;
  for (int k = 0; k < z; ++k)
  {
    for (int j = 0; j < y; ++j)
    {
      T* at = values + k * to.z + j * to.y;
      for (int i = 0; i < count; ++i)
      {
        const Number* const from = parts[i].Numbers + k * parts[i].Z + j * parts[i].Y;
        __builtin_prefetch(
          reinterpret_cast<const void*>(reinterpret_cast<std::uintptr_t>(from) + ahead));
        row.Write(from, parts[i].Width, at);
        at += parts[i].Width;
      }
    }
  }
}

/// Transposes 8 x 8 numbers.
template <class Number>
HWY_INLINE void TransposeTile(
  const Number* from, std::int64_t fromStride, Number* to, std::int64_t toStride)
{
  for (int i = 0; i < 8; ++i)
  {
    for (int j = 0; j < 8; ++j)
    {
      to[j * toStride + i] = from[i * fromStride + j];
    }
  }
}

#if HWY_TARGET != HWY_SCALAR && !HWY_HAVE_SCALABLE
HWY_INLINE void TransposeTile(
  const std::int16_t* from, std::int64_t fromStride, std::int16_t* to, std::int64_t toStride)
{
  const hn::FixedTag<std::int16_t, 8> d;
  const hn::FixedTag<std::int32_t, 4> pairs;
  const hn::FixedTag<std::int64_t, 2> fours;
  hn::VFromD<decltype(d)> rows[8];
  for (int i = 0; i < 8; ++i)
  {
    rows[i] = hn::LoadU(d, from + i * fromStride);
  }
  hn::VFromD<decltype(pairs)> two[8]; // columns 0 to 3, and 4 to 7, of two rows
  for (int i = 0; i < 4; ++i)
  {
    two[i] = hn::BitCast(pairs, hn::InterleaveLower(d, rows[2 * i], rows[2 * i + 1]));
    two[i + 4] = hn::BitCast(pairs, hn::InterleaveUpper(d, rows[2 * i], rows[2 * i + 1]));
  }
  for (int half = 0; half < 2; ++half)
  {
    const auto* const t = two + 4 * half;
    std::int16_t* const at = to + 4 * half * toStride;
    const auto low0 = hn::BitCast(fours, hn::InterleaveLower(pairs, t[0], t[1]));
    const auto low1 = hn::BitCast(fours, hn::InterleaveLower(pairs, t[2], t[3]));
    const auto high0 = hn::BitCast(fours, hn::InterleaveUpper(pairs, t[0], t[1]));
    const auto high1 = hn::BitCast(fours, hn::InterleaveUpper(pairs, t[2], t[3]));
    hn::StoreU(hn::BitCast(d, hn::InterleaveLower(fours, low0, low1)), d, at);
    hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(fours, low0, low1)), d, at + toStride);
    hn::StoreU(hn::BitCast(d, hn::InterleaveLower(fours, high0, high1)), d, at + 2 * toStride);
    hn::StoreU(hn::BitCast(d, hn::InterleaveUpper(fours, high0, high1)), d, at + 3 * toStride);
  }
}
#endif

template <class Number>
void Transpose(
  const Number* numbers, const glm::i64vec3& stride, const glm::ivec3& size, Number* ordered)
{
  // v is contiguous in memory, w neither that nor x.
  const int v = stride.y == 1 ? 1 : 2;
  const int w = 3 - v;
  const std::int64_t to[3] = { 1, size.x, std::int64_t{ size.x } * size.y };
  constexpr int tile = 8;
  for (int k = 0; k < size[w]; ++k)
  {
    const Number* const from = numbers + k * stride[w];
    Number* const at = ordered + k * to[w];
    if (size.x < tile || size[v] < tile)
    {
      for (int x = 0; x < size.x; ++x)
      {
        for (int j = 0; j < size[v]; ++j)
        {
          at[x + j * to[v]] = from[x * stride.x + j];
        }
      }
      continue;
    }
    for (int x = 0; x < size.x; x += tile)
    {
      const int column = x + tile <= size.x ? x : size.x - tile; // the rest, and some once more
      for (int j = 0; j < size[v]; j += tile)
      {
        const int row = j + tile <= size[v] ? j : size[v] - tile;
        TransposeTile(from + column * stride.x + row, stride.x, at + column + row * to[v], to[v]);
      }
    }
  }
}

void ShortFloats(const std::int16_t* n, const glm::i64vec3& pitch, const glm::ivec3& size,
  double origin, double step, float* v, const glm::i64vec3& to)
{
  Values(n, pitch, size, origin, step, v, to);
}
void ShortDoubles(const std::int16_t* n, const glm::i64vec3& pitch, const glm::ivec3& size,
  double origin, double step, double* v, const glm::i64vec3& to)
{
  Values(n, pitch, size, origin, step, v, to);
}
void LongFloats(const std::int32_t* n, const glm::i64vec3& pitch, const glm::ivec3& size,
  double origin, double step, float* v, const glm::i64vec3& to)
{
  Values(n, pitch, size, origin, step, v, to);
}
void LongDoubles(const std::int32_t* n, const glm::i64vec3& pitch, const glm::ivec3& size,
  double origin, double step, double* v, const glm::i64vec3& to)
{
  Values(n, pitch, size, origin, step, v, to);
}

void ShortFloatParts(const LatticePart<std::int16_t>* parts, int count, int y, int z, double origin,
  double step, float* values, const glm::i64vec3& to)
{
  Parts(parts, count, y, z, origin, step, values, to);
}
void ShortDoubleParts(const LatticePart<std::int16_t>* parts, int count, int y, int z,
  double origin, double step, double* values, const glm::i64vec3& to)
{
  Parts(parts, count, y, z, origin, step, values, to);
}
void LongFloatParts(const LatticePart<std::int32_t>* parts, int count, int y, int z, double origin,
  double step, float* values, const glm::i64vec3& to)
{
  Parts(parts, count, y, z, origin, step, values, to);
}
void LongDoubleParts(const LatticePart<std::int32_t>* parts, int count, int y, int z, double origin,
  double step, double* values, const glm::i64vec3& to)
{
  Parts(parts, count, y, z, origin, step, values, to);
}

void TransposeShorts(const std::int16_t* numbers, const glm::i64vec3& stride,
  const glm::ivec3& size, std::int16_t* ordered)
{
  Transpose(numbers, stride, size, ordered);
}
void TransposeLongs(const std::int32_t* numbers, const glm::i64vec3& stride, const glm::ivec3& size,
  std::int32_t* ordered)
{
  Transpose(numbers, stride, size, ordered);
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace banyan
{

HWY_EXPORT(ShortFloats);
HWY_EXPORT(ShortDoubles);
HWY_EXPORT(LongFloats);
HWY_EXPORT(LongDoubles);
HWY_EXPORT(ShortFloatParts);
HWY_EXPORT(ShortDoubleParts);
HWY_EXPORT(LongFloatParts);
HWY_EXPORT(LongDoubleParts);
HWY_EXPORT(TransposeShorts);
HWY_EXPORT(TransposeLongs);

template <>
void DequantizeRows(const std::int16_t* numbers, const glm::i64vec3& pitch, const glm::ivec3& size,
  double origin, double step, float* values, const glm::i64vec3& to)
{
  HWY_DYNAMIC_DISPATCH(ShortFloats)(numbers, pitch, size, origin, step, values, to);
}
template <>
void DequantizeRows(const std::int16_t* numbers, const glm::i64vec3& pitch, const glm::ivec3& size,
  double origin, double step, double* values, const glm::i64vec3& to)
{
  HWY_DYNAMIC_DISPATCH(ShortDoubles)(numbers, pitch, size, origin, step, values, to);
}
template <>
void DequantizeRows(const std::int32_t* numbers, const glm::i64vec3& pitch, const glm::ivec3& size,
  double origin, double step, float* values, const glm::i64vec3& to)
{
  HWY_DYNAMIC_DISPATCH(LongFloats)(numbers, pitch, size, origin, step, values, to);
}
template <>
void DequantizeRows(const std::int32_t* numbers, const glm::i64vec3& pitch, const glm::ivec3& size,
  double origin, double step, double* values, const glm::i64vec3& to)
{
  HWY_DYNAMIC_DISPATCH(LongDoubles)(numbers, pitch, size, origin, step, values, to);
}

template <>
void DequantizeParts(const LatticePart<std::int16_t>* parts, int count, int y, int z, double origin,
  double step, float* values, const glm::i64vec3& to)
{
  HWY_DYNAMIC_DISPATCH(ShortFloatParts)(parts, count, y, z, origin, step, values, to);
}
template <>
void DequantizeParts(const LatticePart<std::int16_t>* parts, int count, int y, int z, double origin,
  double step, double* values, const glm::i64vec3& to)
{
  HWY_DYNAMIC_DISPATCH(ShortDoubleParts)(parts, count, y, z, origin, step, values, to);
}
template <>
void DequantizeParts(const LatticePart<std::int32_t>* parts, int count, int y, int z, double origin,
  double step, float* values, const glm::i64vec3& to)
{
  HWY_DYNAMIC_DISPATCH(LongFloatParts)(parts, count, y, z, origin, step, values, to);
}
template <>
void DequantizeParts(const LatticePart<std::int32_t>* parts, int count, int y, int z, double origin,
  double step, double* values, const glm::i64vec3& to)
{
  HWY_DYNAMIC_DISPATCH(LongDoubleParts)(parts, count, y, z, origin, step, values, to);
}

template <>
void TransposeBox(const std::int16_t* numbers, const glm::i64vec3& stride, const glm::ivec3& size,
  std::int16_t* ordered)
{
  HWY_DYNAMIC_DISPATCH(TransposeShorts)(numbers, stride, size, ordered);
}
template <>
void TransposeBox(const std::int32_t* numbers, const glm::i64vec3& stride, const glm::ivec3& size,
  std::int32_t* ordered)
{
  HWY_DYNAMIC_DISPATCH(TransposeLongs)(numbers, stride, size, ordered);
}

} // namespace banyan
#endif
