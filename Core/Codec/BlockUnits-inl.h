// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockDecoder.cxx and BlockEncoder.cxx.
#if defined(banyan_Codec_BlockUnits_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BlockUnits_inl_h
#undef banyan_Codec_BlockUnits_inl_h
#else
#define banyan_Codec_BlockUnits_inl_h
#endif

#include "Codec/BlockPasses-inl.h"

#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Samples in an array of any strides: where a unit lies in a box, or in a whole field.
template <class Sample>
struct View
{
  Sample* Base;
  glm::i64vec3 Stride;

  /// The same array with its axes in another order; see AxesOf.
  View Along(const glm::ivec3& axes) const
  {
    return { this->Base, { this->Stride[axes.x], this->Stride[axes.y], this->Stride[axes.z] } };
  }
  View At(const glm::ivec3& position) const
  {
    return { this->Base + position.x * this->Stride.x + position.y * this->Stride.y +
               position.z * this->Stride.z,
      this->Stride };
  }
  Sample* Row(int y, int z) const { return this->Base + y * this->Stride.y + z * this->Stride.z; }
};

/// Where the samples of references lie; the same place as the unit's own.
template <class Sample>
struct References
{
  block::Reference From = block::Reference::None;
  View<const Sample> A{ nullptr, {} }, B{ nullptr, {} };

  References Along(const glm::ivec3& axes) const
  {
    return { this->From, this->A.Along(axes), this->B.Along(axes) };
  }
  References At(const glm::ivec3& position) const
  {
    return this->From == block::Reference::None
             ? *this
             : References{ this->From, this->A.At(position), this->B.At(position) };
  }
};

/// How many units of D dimensions a block has: three edges, three faces, one interior.
template <int D>
constexpr int UnitsOf = D < 3 ? 3 : 1;

/// The axes of an edge, a face or an interior in the unit's own order: the free ones first. Edges
/// run along x, y, z; faces along x and y, x and z, y and z.
template <int D>
HWY_INLINE glm::ivec3 AxesOf(int number)
{
  if (D == 1)
  {
    return number == 1   ? glm::ivec3{ 1, 0, 2 }
           : number == 2 ? glm::ivec3{ 2, 0, 1 }
                         : glm::ivec3{ 0, 1, 2 };
  }
  if (D == 2)
  {
    return number == 1   ? glm::ivec3{ 0, 2, 1 }
           : number == 2 ? glm::ivec3{ 1, 2, 0 }
                         : glm::ivec3{ 0, 1, 2 };
  }
  return { 0, 1, 2 };
}

/// The free axes as bits.
template <int D>
HWY_INLINE int MaskOf(int number)
{
  const glm::ivec3 axes = AxesOf<D>(number);
  return 1 << axes.x | (D > 1 ? 1 << axes.y : 0) | (D > 2 ? 1 << axes.z : 0);
}

/// A vector in the order of a unit's axes; those that the unit does not have do not limit it.
template <int D>
HWY_INLINE glm::ivec3 InOrderOf(const glm::ivec3& axes, const glm::ivec3& v, int edge)
{
  return { v[axes.x], D > 1 ? v[axes.y] : edge, D > 2 ? v[axes.z] : edge };
}

/// What is subtracted from samples, whose kind the compiler knows. Arithmetic wraps.
template <class Number, block::Reference From>
struct Subtracted
{
  using V = Numbers<Number>;
  using Vector = typename V::Unsigned;
  static HWY_INLINE Vector Of(Vector a, Vector b)
  {
    switch (From)
    {
      case block::Reference::Mean:
        return V::Shift(a + b + Number{ 1 }, 1);
      case block::Reference::HalfMean:
        return V::Shift(a + b + Number{ 2 }, 2);
      case block::Reference::A:
        return a;
      case block::Reference::B:
        return b;
      default:
        return Vector{};
    }
  }
  static HWY_INLINE Number Of(Number a, Number b)
  {
    using U = std::make_unsigned_t<Number>;
    const U sum = static_cast<U>(static_cast<U>(a) + static_cast<U>(b));
    switch (From)
    {
      case block::Reference::Mean:
        return static_cast<Number>(static_cast<Number>(sum + 1u) >> 1);
      case block::Reference::HalfMean:
        return static_cast<Number>(static_cast<Number>(sum + 2u) >> 2);
      case block::Reference::A:
        return a;
      case block::Reference::B:
        return b;
      default:
        return 0;
    }
  }
};

template <class Number, class Body>
HWY_INLINE void WithReference(block::Reference from, const Body& body)
{
  using block::Reference;
  switch (from)
  {
    case Reference::Mean:
      return body(Subtracted<Number, Reference::Mean>{});
    case Reference::HalfMean:
      return body(Subtracted<Number, Reference::HalfMean>{});
    case Reference::A:
      return body(Subtracted<Number, Reference::A>{});
    case Reference::B:
      return body(Subtracted<Number, Reference::B>{});
    default:
      return body(Subtracted<Number, Reference::None>{});
  }
}

/// Width samples as numbers that are computed with.
template <class Number, class Sample>
HWY_INLINE typename Numbers<Number>::Unsigned LoadSamples(const Sample* from)
{
  using Vector = typename Numbers<Number>::Unsigned;
  if constexpr (std::is_same_v<Number, Sample>)
  {
    return LoadVector<Vector>(from);
  }
  else
  {
    return __builtin_convertvector(LoadVector<typename Numbers<Sample>::Unsigned>(from), Vector);
  }
}

/// A row of samples and of both references.
template <class Sample>
struct SampleRow
{
  Sample* X;
  const Sample* A;
  const Sample* B;
  std::int64_t StrideX, StrideA, StrideB;
};

template <class Sample, class Other>
HWY_INLINE SampleRow<Other> RowOf(
  const View<Other>& samples, const References<Sample>& from, int y, int z)
{
  if (from.From == block::Reference::None)
  {
    Other* row = samples.Row(y, z);
    return { row, row, row, samples.Stride.x, samples.Stride.x, samples.Stride.x };
  }
  return { samples.Row(y, z), from.A.Row(y, z), from.B.Row(y, z), samples.Stride.x, from.A.Stride.x,
    from.B.Stride.x };
}

/// Takes samples first to last of a row, less their references.
template <class Number, class Reference, class Sample>
HWY_INLINE void LoadRow(
  const Reference&, const SampleRow<const Sample>& row, int first, int last, Number* w)
{
  int x = first;
  if (row.StrideX == 1 && row.StrideA == 1 && row.StrideB == 1 && last - first >= Width)
  {
    const auto take = [&](int at)
    {
      StoreVector(LoadSamples<Number>(row.X + at) -
                    Reference::Of(LoadSamples<Number>(row.A + at), LoadSamples<Number>(row.B + at)),
        w + at);
    };
    for (; x + Width <= last; x += Width)
    {
      take(x);
    }
    take(last - Width + 1); // the rest, and some once more
    return;
  }
  for (; x <= last; ++x)
  {
    using U = std::make_unsigned_t<Number>;
    const Number reference = Reference::Of(
      static_cast<Number>(row.A[x * row.StrideA]), static_cast<Number>(row.B[x * row.StrideB]));
    w[x] = static_cast<Number>(
      static_cast<U>(static_cast<U>(row.X[x * row.StrideX]) - static_cast<U>(reference)));
  }
}

/// Takes a unit with its borders (edge + 1 samples per free axis), less its reference.
/// @param all false: what is known before the unit is decoded, its borders and every fourth sample,
/// is enough; the rest is anything
/// @param w its sample 0
template <int D, class Number, class Edge, class Sample>
HWY_INLINE void LoadUnit(const View<const Sample>& samples, const References<Sample>& from,
  const Edge& edge, bool all, Number* w)
{
  const block::Shape<D> shape{ edge() };
  const int n = edge();
  WithReference<Number>(from.From,
    [&](auto reference)
    {
      for (int z = 0; z <= (D > 2 ? n : 0); ++z)
      {
        for (int y = 0; y <= (D > 1 ? n : 0); ++y)
        {
          const auto row = RowOf(samples, from, y, z);
          Number* to = w + z * shape.Z() + y * shape.Y();
          const bool border = z % n == 0 && D > 2;
          // Whole rows take no longer than two samples where they lie side by side.
          const bool whole = all || row.StrideX == 1;
          if (whole || border || y % n == 0 || ((y | z) & 3) == 0)
          {
            LoadRow(reference, row, 0, n, to);
            continue;
          }
          LoadRow(reference, row, 0, 0, to);
          LoadRow(reference, row, n, n, to);
        }
      }
    });
}

/// Stores the lanes of a vector from the first one on.
template <class Vector, class Sample>
HWY_INLINE void StoreSamples(const Vector& value, int first, Sample* to)
{
  typename Numbers<Sample>::Signed samples;
  if constexpr (sizeof(samples) == sizeof(value))
  {
    samples = value;
  }
  else
  {
    samples = __builtin_convertvector(value, typename Numbers<Sample>::Signed);
  }
  if (first == 0)
  {
    StoreVector(samples, to);
    return;
  }
  Sample lanes[Width];
  StoreVector(samples, lanes);
  std::memcpy(to + 1, lanes + 1, sizeof(lanes) - sizeof(Sample));
}

/// Puts the inside of a unit (samples 1 to edge - 1 of its free axes) back, with its reference and
/// within the limits of the lattice. Nothing else is written: other threads may read it.
template <int D, class Number, class Edge, class Sample>
HWY_INLINE void StoreUnit(const Number* w, const References<Sample>& from, const Edge& edge,
  std::int32_t least, std::int32_t greatest, const View<Sample>& samples)
{
  const block::Shape<D> shape{ edge() };
  const int n = edge();
  using V = Numbers<Number>;
  using Signed = typename V::Signed;
  const Signed low = Signed{} + static_cast<Number>(least);
  const Signed high = Signed{} + static_cast<Number>(greatest);
  WithReference<Number>(from.From,
    [&](auto reference)
    {
      for (int z = (D > 2 ? 1 : 0); z < (D > 2 ? n : 1); ++z)
      {
        for (int y = (D > 1 ? 1 : 0); y < (D > 1 ? n : 1); ++y)
        {
          const SampleRow<Sample> row = RowOf(samples, from, y, z);
          const Number* in = w + z * shape.Z() + y * shape.Y();
          int x = D > 1 ? 0 : 1;
          if (D > 1 && row.StrideX == 1 && row.StrideA == 1 && row.StrideB == 1)
          {
            for (; x + Width <= n; x += Width)
            {
              const auto sum = V::Load(in + x) + reference.Of(LoadSamples<Number>(row.A + x),
                                                   LoadSamples<Number>(row.B + x));
              Signed value = reinterpret_cast<Signed>(sum);
              value = value < low ? low : value;
              value = value > high ? high : value;
              StoreSamples(value, x == 0 ? 1 : 0, row.X + x);
            }
          }
          for (x = std::max(x, 1); x < n; ++x)
          {
            using U = std::make_unsigned_t<Number>;
            const Number subtracted = reference.Of(static_cast<Number>(row.A[x * row.StrideA]),
              static_cast<Number>(row.B[x * row.StrideB]));
            const Number sum = static_cast<Number>(
              static_cast<U>(static_cast<U>(in[x]) + static_cast<U>(subtracted)));
            row.X[x * row.StrideX] =
              std::min(std::max<Sample>(sum, least), static_cast<Sample>(greatest));
          }
        }
      }
    });
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
