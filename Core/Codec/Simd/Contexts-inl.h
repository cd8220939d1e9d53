// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_Contexts_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_Contexts_inl_h
#undef banyan_Codec_Contexts_inl_h
#else
#define banyan_Codec_Contexts_inl_h
#endif

#include "Codec/Residual.h"
#include "Codec/Simd/Passes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

/// Sum of the magnitudes of residuals around that are known when a slice is coded: those at and
/// beside both ends of the interpolation, and those of the slice that the same pass coded before,
/// which count most. At most 26 times 8.
/// @param m lane First + at of a row
template <class P, int B>
HWY_INLINE Bytes LocalActivity(const std::uint8_t* m, const RowPlace& place)
{
  constexpr block::Shape<P::D> shape{ B };
  constexpr int s = P::S;
  const auto load = [m](std::ptrdiff_t offset) { return Bytes::Load(m + offset); };
  const auto sides = [&](std::ptrdiff_t offset, std::ptrdiff_t distance)
  { return load(offset - distance) + load(offset + distance); };
  // Beyond the last row nothing of this block is known: the other side stands for it.
  const auto ahead = [&](int position, int step, std::ptrdiff_t gap)
  { return position + step < B ? gap : -gap; };
  constexpr std::ptrdiff_t y = shape.Y();
  constexpr std::ptrdiff_t z = shape.MagnitudeZ();
  Bytes sum;
  if constexpr (P::Axis == 0)
  {
    const Bytes ends = sides(0, s);
    sum = ends + ends;
    if constexpr (P::D > 1)
    {
      constexpr std::ptrdiff_t gap = 2 * s * y;
      sum += sides(-gap, s) + sides(ahead(place.Y, 2 * s, gap), s);
    }
    if constexpr (P::D > 2)
    {
      constexpr std::ptrdiff_t gap = 2 * s * z;
      sum += sides(-gap, s) + sides(ahead(place.Z, 2 * s, gap), s);
    }
  }
  else
  {
    constexpr std::ptrdiff_t gap = s * (P::Axis == 1 ? y : z);
    const std::ptrdiff_t next = ahead(P::Axis == 1 ? place.Y : place.Z, s, gap);
    const Bytes ends = load(-gap) + load(next);
    sum = ends + ends + sides(-gap, s) + sides(next, s);
    if constexpr (P::D > 2)
    {
      constexpr std::ptrdiff_t across = P::Axis == 1 ? 2 * s * z : s * y;
      const std::ptrdiff_t beside =
        P::Axis == 1 ? ahead(place.Z, 2 * s, across) : ahead(place.Y, s, across);
      sum += load(-gap - across) + load(next - across) + load(-gap + beside) + load(next + beside);
    }
  }
  if constexpr (P::D > 1)
  {
    if ((P::D == 2 ? place.Y : place.Z) < 2 * s)
    {
      return sum + sum; // the pass has coded none before
    }
    constexpr std::ptrdiff_t before = 2 * s * (P::D == 2 ? y : z);
    Bytes near = sides(-before, P::Step);
    if constexpr (P::D > 2)
    {
      constexpr int step = P::RowStep;
      constexpr std::ptrdiff_t gap = step * y;
      const std::ptrdiff_t up = ahead(place.Y, step, gap);
      near += load(-before + (place.Y >= step ? -gap : up)) + load(-before + up);
    }
    const Bytes same = load(-before);
    const Bytes twice = same + near;
    return sum + twice + twice + (same + same) + (same + same);
  }
  return sum;
}

/// What the residuals at the same place in the two slices before, of the same pass, hint at: its
/// sign is likely that of the residual. 0 where there are none, or the place is not active.
/// @param r lane First + at of a row
template <class P, int B>
HWY_INLINE SignedBytes HintOf(const std::int8_t* r, const RowPlace& place, const Bytes& activity)
{
  const int slice = P::D == 2 ? place.Y : place.Z;
  if (P::D == 1 || slice < 2 * P::S)
  {
    return SignedBytes::Set(0);
  }
  constexpr block::Shape<P::D> shape{ B };
  constexpr std::ptrdiff_t before = 2 * P::S * (P::D == 2 ? shape.Y() : shape.MagnitudeZ());
  const SignedBytes near = SignedBytes::Load(r - before);
  SignedBytes hint = near + near;
  if (slice >= 4 * P::S)
  {
    hint += SignedBytes::Load(r - 2 * before);
  }
  return hint & BitsAs<std::int8_t>(activity != Bytes::Set(0));
}

/// Residuals as they are kept for hints.
template <class V, class Number>
HWY_INLINE V Limited(const V& residuals, Number most)
{
  return Max(Min(residuals, V::Set(most)), V::Set(static_cast<Number>(-most)));
}

/// Classes of activity, 0 to 7.
template <int N, bool One>
HWY_INLINE PackOf<std::uint8_t, N, One> ActivityClasses(const PackOf<std::uint8_t, N, One>& sum)
{
  using V = PackOf<std::uint8_t, N, One>;
  // As signed numbers, which all targets compare.
  const auto biased = BitsAs<std::int8_t>(sum ^ V::Set(128));
  const auto above = [&](int limit)
  { return biased > decltype(biased)::Set(static_cast<std::int8_t>(limit - 128)); };
  const auto all =
    above(0) + above(5) + (above(12) + above(22)) + (above(36) + above(56)) + above(90);
  return BitsAs<std::uint8_t>(-all); // each is -1 where it holds
}

/// About 2 log2(1 + |r|): sums of these say how active the neighbourhood is, over any scale. From
/// 15 on it grows no more. Lanes behind the last symbol may hold anything.
template <int N, bool One>
HWY_INLINE Pack<std::uint8_t, N> MagnitudesOf(const PackOf<std::int8_t, N, One>& residuals)
{
  const auto size = BitsAs<std::uint8_t>(Abs(residuals));
  return LookUp<0, 2, 3, 4, 5, 5, 6, 6, 6, 7, 7, 7, 7, 8, 8, 8>(Min(size, decltype(size)::Set(15)));
}

using RowSums = Pack<std::uint16_t, Width>;

/// Sets the sums of rows to those of the magnitudes that a unit starts with: those of its first
/// slice, and of the first row and the first lane of others.
template <int D, int B>
HWY_INLINE void SumRows(const std::uint8_t* m, std::uint16_t* sums)
{
  constexpr block::Shape<D> shape{ B };
  const auto sum = [&](const std::uint8_t* row)
  {
    std::uint16_t result = 0;
    for (int x = 0; x < B; x += Width)
    {
      result = static_cast<std::uint16_t>(result + SumOfBytes(Bytes::Load(row + x)));
    }
    return result;
  };
  constexpr int rows = D > 2 ? B : 3;
  for (int slice = 0; slice < B; ++slice)
  {
    const std::uint8_t* first = m + slice * (D > 2 ? shape.MagnitudeZ() : shape.Y());
    std::uint16_t* to = sums + slice * shape.SumPitch();
    for (int row = 0; row < rows; ++row)
    {
      const std::uint8_t* from = first + row * shape.Pitch();
      to[row] = slice == 0 || (D > 2 && row == 0) ? sum(from) : from[0];
    }
  }
}

/// How likely rows of a slice have residuals: weighted sums of the magnitudes around, as in
/// LocalActivity.
/// @param FirstRow number of the first of these rows
/// @param s of that row of the slice
template <class P, int B, int FirstRow>
HWY_INLINE RowSums RowWeights(const std::uint16_t* s, int slice)
{
  constexpr block::Shape<P::D> shape{ B };
  constexpr int S = P::S;
  constexpr std::ptrdiff_t pitch = shape.SumPitch();
  const auto load = [s](std::ptrdiff_t offset) { return RowSums::Load(s + offset); };
  // Beyond the last row or slice the other side stands for it.
  const auto ahead = [&](std::ptrdiff_t offset, auto step)
  {
    constexpr int there = B - step() - FirstRow; // rows that have one
    const RowSums up = load(offset + step());
    if constexpr (there >= Width)
    {
      return up;
    }
    else
    {
      return Select(
        ConstantLanes<std::uint16_t, Width, EveryOf<1, there>>::Get(), up, load(offset - step()));
    }
  };
  const auto slices = [&](int step) { return (slice + step < B ? step : -step) * pitch; };
  constexpr std::integral_constant<int, S> one{};
  constexpr std::integral_constant<int, 2 * S> two{};
  if constexpr (P::D == 1)
  {
    return ShiftLeft<2>(load(0));
  }
  RowSums sum;
  if constexpr (P::Axis == 0)
  {
    sum = load(-2 * S * pitch) + load(slices(2 * S));
    if constexpr (P::D > 2)
    {
      sum += load(-2 * S) + ahead(0, two);
    }
    sum = ShiftLeft<1>(sum + load(0) + load(0));
  }
  else if constexpr (P::D == 2)
  {
    sum = ShiftLeft<2>(load(-S * pitch) + load(slices(S)));
  }
  else if constexpr (P::Axis == 1)
  {
    sum = ShiftLeft<2>(load(-S) + ahead(0, one));
    for (const std::ptrdiff_t beside : { -2 * S * pitch, slices(2 * S) })
    {
      sum += load(beside - S) + ahead(beside, one);
    }
  }
  else
  {
    sum = RowSums::Set(0);
    for (const std::ptrdiff_t end : { -S * pitch, slices(S) })
    {
      sum += ShiftLeft<2>(load(end)) + load(end - S) + ahead(end, one);
    }
  }
  if (slice < 2 * S)
  {
    return sum + sum;
  }
  constexpr std::ptrdiff_t before = -2 * S * pitch;
  sum += load(before) * RowSums::Set(10);
  if constexpr (P::D > 2)
  {
    constexpr std::integral_constant<int, P::RowStep> step{};
    const RowSums up = ahead(before, step);
    RowSums down = load(before - step());
    if constexpr (FirstRow < P::RowStep)
    {
      down = Select(
        ConstantLanes<std::uint16_t, Width, EveryOf<1, P::RowStep - FirstRow>>::Get(), up, down);
    }
    sum += ShiftLeft<1>(up + down);
  }
  return sum;
}

/// Classes of the rows of a slice, by what is around them: RowClasses and more where residuals are
/// so likely that rows have no flags.
/// @param to of all rows from 0 on, those included that the pass does not have
template <class P, int B, class Number>
HWY_INLINE void RowClasses(const Unit<Number, P::D>& unit, int slice, std::uint8_t* to)
{
  constexpr std::ptrdiff_t pitch = block::Shape<P::D>{ B }.SumPitch();
  ForEachPart<(P::D > 2 ? B : Width)>(
    [&](auto first)
    {
      const auto weights = BitsAs<std::int16_t>(
        RowWeights<P, B, first()>(unit.RowSums + (P::D > 1 ? slice * pitch : 0) + first(), slice));
      auto classes = decltype(weights)::Set(0);
      for (const std::uint16_t limit : residual::RowLimits)
      {
        // -1 where it holds; weights are below 2^15.
        classes = classes - (weights > decltype(weights)::Set(static_cast<std::int16_t>(limit)));
      }
      Narrow<std::uint8_t>(classes).Store(to + first());
    });
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
