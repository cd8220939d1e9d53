// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockDecoder.cxx and BlockEncoder.cxx.
#if defined(banyan_Codec_BlockContexts_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BlockContexts_inl_h
#undef banyan_Codec_BlockContexts_inl_h
#else
#define banyan_Codec_BlockContexts_inl_h
#endif

#include "Codec/BlockPasses-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Sum of the magnitudes of residuals around that are known when a slice is coded: those at and
/// beside both ends of the interpolation, and those of the slice that the same pass coded before,
/// which count most. At most 26 times 8.
/// @param m lane First + at of a row
template <class P, class Edge>
HWY_INLINE ByteVector RoughnessOf(const std::uint8_t* m, const Edge& edge, const RowPlace& place)
{
  const block::Shape<P::D> shape{ edge() };
  constexpr int s = P::S;
  const auto load = [m](std::ptrdiff_t offset) { return LoadVector<ByteVector>(m + offset); };
  const auto sides = [&](std::ptrdiff_t offset, std::ptrdiff_t distance)
  { return load(offset - distance) + load(offset + distance); };
  // Beyond the last row nothing of this block is known: the other side stands for it.
  const auto ahead = [&](int position, int step, std::ptrdiff_t gap)
  { return position + step < edge() ? gap : -gap; };
  const std::ptrdiff_t y = shape.Y();
  const std::ptrdiff_t z = shape.ZM();
  ByteVector sum;
  if (P::Axis == 0)
  {
    const ByteVector ends = sides(0, s);
    sum = ends + ends;
    if (P::D > 1)
    {
      const std::ptrdiff_t gap = 2 * s * y;
      sum += sides(-gap, s) + sides(ahead(place.Y, 2 * s, gap), s);
    }
    if (P::D > 2)
    {
      const std::ptrdiff_t gap = 2 * s * z;
      sum += sides(-gap, s) + sides(ahead(place.Z, 2 * s, gap), s);
    }
  }
  else
  {
    const std::ptrdiff_t gap = s * (P::Axis == 1 ? y : z);
    const std::ptrdiff_t next = ahead(P::Axis == 1 ? place.Y : place.Z, s, gap);
    const ByteVector ends = load(-gap) + load(next);
    sum = ends + ends + sides(-gap, s) + sides(next, s);
    if (P::D > 2)
    {
      const std::ptrdiff_t across = P::Axis == 1 ? 2 * s * z : s * y;
      const std::ptrdiff_t beside =
        P::Axis == 1 ? ahead(place.Z, 2 * s, across) : ahead(place.Y, s, across);
      sum += load(-gap - across) + load(next - across) + load(-gap + beside) + load(next + beside);
    }
  }
  if (P::D == 1)
  {
    return sum;
  }
  if ((P::D == 2 ? place.Y : place.Z) < 2 * s)
  {
    return sum + sum; // the pass has coded none before
  }
  const std::ptrdiff_t before = 2 * s * (P::D == 2 ? y : z);
  ByteVector near = sides(-before, P::Step);
  if (P::D > 2)
  {
    constexpr int step = P::RowStep;
    const std::ptrdiff_t gap = step * y;
    const std::ptrdiff_t up = ahead(place.Y, step, gap);
    near += load(-before + (place.Y >= step ? -gap : up)) + load(-before + up);
  }
  const ByteVector same = load(-before);
  const ByteVector twice = same + near;
  return sum + twice + twice + (same + same) + (same + same);
}

/// What the residuals at the same place in the two slices before, of the same pass, hint at: its
/// sign is likely that of the residual. 0 where there are none, or the place is not rough.
/// @param r lane First + at of a row
template <class P, class Edge>
HWY_INLINE SignedByteVector HintOf(
  const std::int8_t* r, const Edge& edge, const RowPlace& place, ByteVector roughness)
{
  SignedByteVector hint{};
  const int slice = P::D == 2 ? place.Y : place.Z;
  if (P::D == 1 || slice < 2 * P::S)
  {
    return hint;
  }
  const block::Shape<P::D> shape{ edge() };
  const std::ptrdiff_t before = 2 * P::S * (P::D == 2 ? shape.Y() : shape.ZM());
  const auto near = LoadVector<SignedByteVector>(r - before);
  hint = near + near;
  if (slice >= 4 * P::S)
  {
    hint += LoadVector<SignedByteVector>(r - 2 * before);
  }
  return hint & reinterpret_cast<SignedByteVector>(roughness != std::uint8_t{ 0 });
}

/// Sets Width lanes of kept residuals.
/// @param mask -1 for those that are set
HWY_INLINE void KeepResiduals(SignedByteVector residuals, ByteVector mask, std::int8_t* to)
{
  const auto lanes = reinterpret_cast<SignedByteVector>(mask);
  StoreVector((residuals & lanes) | (LoadVector<SignedByteVector>(to) & ~lanes), to);
}

template <class Vector, class Element>
HWY_INLINE Vector Limited(Vector v, Element most)
{
  const Vector high = Vector{} + most;
  v = v < high ? v : high;
  return v > -high ? v : -high;
}

/// Classes of roughness, 0 to 7.
HWY_INLINE ByteVector ClassesOf(ByteVector sum)
{
  ByteVector result{};
  for (const std::uint8_t limit : { 0, 5, 12, 22, 36, 56, 90 })
  {
    result -= reinterpret_cast<ByteVector>(sum > limit); // -1 where it holds
  }
  return result;
}

HWY_INLINE bool AnyOf(ByteVector v)
{
  std::uint64_t words[2];
  std::memcpy(words, &v, sizeof(v));
  return (words[0] | words[1]) != 0;
}

typedef std::uint16_t SumVector __attribute__((vector_size(32)));

/// Sum of up to Width magnitudes.
HWY_INLINE std::uint16_t SumOf(ByteVector magnitudes)
{
  std::uint64_t words[2];
  std::memcpy(words, &magnitudes, sizeof(magnitudes));
  // Each is 8 at most, so that no byte overflows.
  return static_cast<std::uint16_t>(((words[0] + words[1]) * 0x0101010101010101u) >> 56);
}

/// Sets the sums of rows to those of the magnitudes that a unit starts with: those of its first
/// slice, and of the first row and the first lane of others.
template <int D, class Edge>
HWY_INLINE void SumRows(const std::uint8_t* m, const Edge& edge, std::uint16_t* s)
{
  const block::Shape<D> shape{ edge() };
  const auto sum = [&](const std::uint8_t* row)
  {
    std::uint16_t result = 0;
    for (int x = 0; x < edge(); x += Width)
    {
      const ByteVector inside = LaneMask<Pass<3, 2, 1>, ByteVector>(edge() - x);
      result = static_cast<std::uint16_t>(result + SumOf(LoadVector<ByteVector>(row + x) & inside));
    }
    return result;
  };
  const int rows = D > 2 ? edge() : 3;
  for (int slice = 0; slice < edge(); ++slice)
  {
    const std::uint8_t* first = m + slice * (D > 2 ? shape.ZM() : shape.Y());
    std::uint16_t* to = s + slice * shape.SumPitch();
    for (int row = 0; row < rows; ++row)
    {
      const std::uint8_t* from = first + row * shape.Pitch();
      to[row] = slice == 0 || (D > 2 && row == 0) ? sum(from) : from[0];
    }
  }
}

/// How likely rows of a slice have residuals: weighted sums of the magnitudes around, as in
/// RoughnessOf.
/// @param s of the slice's row `first`
template <class P, class Edge>
HWY_INLINE SumVector RowWeights(const std::uint16_t* s, const Edge& edge, int slice, int first)
{
  const block::Shape<P::D> shape{ edge() };
  constexpr int S = P::S;
  const std::ptrdiff_t pitch = shape.SumPitch();
  const SumVector rows = LaneNumbers<SumVector>() + static_cast<std::uint16_t>(first);
  const auto load = [s](std::ptrdiff_t offset) { return LoadVector<SumVector>(s + offset); };
  // Beyond the last row or slice the other side stands for it.
  const auto ahead = [&](std::ptrdiff_t offset, int step)
  {
    return rows + static_cast<std::uint16_t>(step) < static_cast<std::uint16_t>(edge())
             ? load(offset + step)
             : load(offset - step);
  };
  const auto slices = [&](int step) { return (slice + step < edge() ? step : -step) * pitch; };
  SumVector sum;
  if (P::D == 1)
  {
    return load(0) * std::uint16_t{ 4 };
  }
  if (P::Axis == 0)
  {
    sum = load(-2 * S * pitch) + load(slices(2 * S));
    if (P::D > 2)
    {
      sum += load(-2 * S) + ahead(0, 2 * S);
    }
    sum = (sum + load(0) + load(0)) * std::uint16_t{ 2 };
  }
  else if (P::D == 2)
  {
    sum = (load(-S * pitch) + load(slices(S))) * std::uint16_t{ 4 };
  }
  else if (P::Axis == 1)
  {
    sum = (load(-S) + ahead(0, S)) * std::uint16_t{ 4 };
    for (const std::ptrdiff_t beside : { -2 * S * pitch, slices(2 * S) })
    {
      sum += load(beside - S) + ahead(beside, S);
    }
  }
  else
  {
    sum = SumVector{};
    for (const std::ptrdiff_t end : { -S * pitch, slices(S) })
    {
      sum += load(end) * std::uint16_t{ 4 } + load(end - S) + ahead(end, S);
    }
  }
  if (slice < 2 * S)
  {
    return sum + sum;
  }
  const std::ptrdiff_t before = -2 * S * pitch;
  sum += load(before) * std::uint16_t{ 10 };
  if (P::D > 2)
  {
    constexpr int step = P::RowStep;
    const SumVector up = ahead(before, step);
    const SumVector down = rows >= static_cast<std::uint16_t>(step) ? load(before - step) : up;
    sum += (up + down) * std::uint16_t{ 2 };
  }
  return sum;
}

/// Classes of the rows of a slice, by what is around them: RowClasses and more where residuals are
/// so likely that rows have no flags.
/// @param to of all rows from 0 on, those included that the pass does not have
template <class P, class Edge, class Number>
HWY_INLINE void RowClasses(
  const Unit<Number, P::D>& unit, const Edge& edge, int slice, std::uint8_t* to)
{
  const std::ptrdiff_t pitch = block::Shape<P::D>{ edge() }.SumPitch();
  const int rows = P::D > 2 ? edge() : 3;
  for (int row = 0; row < rows; row += Width)
  {
    const SumVector weights =
      RowWeights<P>(unit.S + (P::D > 1 ? slice * pitch : 0) + row, edge, slice, row);
    SumVector classes{};
#pragma GCC unroll 16
    for (const std::uint16_t limit : residual::RowLimits)
    {
      classes -= reinterpret_cast<SumVector>(weights > limit); // -1 where it holds
    }
    StoreVector(__builtin_convertvector(classes, ByteVector), to + row);
  }
}

/// Every Step-th lane, side by side from lane 0 on.
template <int Step, class Vector>
HWY_INLINE Vector Compressed(Vector v)
{
  if (Step == 2)
  {
    return __builtin_shuffle(v, Vector{ 0, 2, 4, 6, 8, 10, 12, 14, 0, 2, 4, 6, 8, 10, 12, 14 });
  }
  if (Step == 4)
  {
    return __builtin_shuffle(v, Vector{ 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12, 0, 4, 8, 12 });
  }
  return v;
}

/// The other way round; lanes between hold anything.
template <int Step, class Vector>
HWY_INLINE Vector Expanded(Vector v)
{
  if (Step == 2)
  {
    return __builtin_shuffle(v, Vector{ 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5, 5, 6, 6, 7, 7 });
  }
  if (Step == 4)
  {
    return __builtin_shuffle(v, Vector{ 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2, 2, 3, 3, 3, 3 });
  }
  return v;
}

/// About 2 log2(1 + |r|): sums of these say how rough the neighbourhood is, over any scale. From 15
/// on it grows no more. Lanes behind the last symbol hold anything, also what has no opposite.
HWY_INLINE ByteVector MagnitudesOf(SignedByteVector residuals)
{
  const SignedByteVector opposite =
    reinterpret_cast<SignedByteVector>(-reinterpret_cast<ByteVector>(residuals));
  const SignedByteVector size = residuals < 0 ? opposite : residuals;
  const SignedByteVector most = SignedByteVector{} + std::int8_t{ 15 };
  const SignedByteVector index = size < most ? size : most;
  return __builtin_shuffle(ByteVector{ 0, 2, 3, 4, 5, 5, 6, 6, 6, 7, 7, 7, 7, 8, 8, 8 },
    reinterpret_cast<ByteVector>(index));
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
