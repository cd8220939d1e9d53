// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target.
#if defined(banyan_Codec_Passes_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_Passes_inl_h
#undef banyan_Codec_Passes_inl_h
#else
#define banyan_Codec_Passes_inl_h
#endif

#include "Codec/BlockModes.h"
#include "Codec/BlockScratch.h"
#include "Codec/Simd/Pack-inl.h"

#include <algorithm>
#include <type_traits>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

using block::Interpolation;

/// Lanes of a row that are worked on together: those of a row of 16, or half of one of 32.
constexpr int Width = 16;
template <class Number>
using Samples = Pack<Number, Width>;

/// Calls body(integral constant) for each lane where a part of N lanes of a row begins.
/// @param B edge of the block
template <int B, int N = Width, class Body>
HWY_INLINE void ForEachPart(const Body& body)
{
  if constexpr (N < B)
  {
    ForEachPart<B - N, N>(body);
  }
  body(std::integral_constant < int, N<B ? B - N : 0>());
}

/// Predictions. The formulas are the usual ones, rounded, in an order that needs no more bits than
/// samples have; where numbers wrap, as in files made with ill intent, nothing is undefined.
///
/// (9 (b + c) - a - d + 8) / 16, rounded down.
template <class V>
HWY_INLINE V Cubic(const V& a, const V& b, const V& c, const V& d)
{
  const V middle = b + c;
  return ShiftRight<1>(middle + V::Set(1) + ShiftRight<3>(middle - (a + d)));
}
/// (3 near + 6 other - far + 4) / 8, rounded down.
template <class V>
HWY_INLINE V Quadratic(const V& near, const V& other, const V& far)
{
  return other + ShiftRight<2>((near - other) + ShiftRight<1>(near - far + V::Set(4)));
}
template <class V>
HWY_INLINE V Linear(const V& a, const V& b)
{
  return ShiftRight<1>(a + b + V::Set(1));
}

/// A pass: which samples it predicts, along which axis, from how far away.
template <int D_, int Axis_, int S_>
struct Pass
{
  static constexpr int D = D_;
  static constexpr int Axis = Axis_;
  static constexpr int S = S_;
  static constexpr int Band = D == 1   ? 2 - S
                              : D == 2 ? (S == 2 ? 2 : 3 + Axis)
                                       : (S == 2 ? 5 : 8) + Axis;
  /// Lanes of a row: First, First + Step, ... below the edge.
  static constexpr int First = S;
  static constexpr int Step = Axis > 0 ? S : 2 * S;

  /// Rows are coded in slices: those of one z of an interior, those of one y of the three faces,
  /// all three edges.
  static constexpr int FirstSlice = D == 1 ? 0 : D - 1 <= Axis ? S : 2 * S;
  static constexpr int SliceStep = 2 * S;
  static constexpr int EndOfSlices(int edge) { return D == 1 ? 1 : edge; }
  /// The rows of a slice: y of an interior, or the numbers of faces or edges.
  static constexpr int FirstRow = D < 3 ? 0 : 1 <= Axis ? S : 2 * S;
  static constexpr int RowStep = D < 3 ? 1 : 1 < Axis ? S : 2 * S;
  static constexpr int EndOfRows(int edge) { return D < 3 ? 3 : edge; }
  static constexpr int LanesOf(int edge) { return (edge - First + Step - 1) / Step; }
};

/// Where a row of a slice lies.
struct RowPlace
{
  std::ptrdiff_t Sample, Magnitude; ///< its lane 0
  int Y, Z;                         ///< positions of an interior; Y of faces
  int Row;                          ///< its number: Y of an interior, or that of the face or edge
  int Coded;                        ///< lanes of the pass (from its first) that carry a residual
};

/// Units as the passes see them.
template <class Number, int D>
struct Unit
{
  Number* Samples;
  std::uint8_t* Magnitudes;
  std::int8_t* Residuals; ///< from -15 to 15; same places
  std::uint16_t* RowSums; ///< sums of the magnitudes of rows
  /// Greatest position per axis that carries residuals; of each face and edge.
  glm::ivec3 Limit[3];
  bool Any = false; ///< whether some magnitude may be other than 0
};

template <class P, int B, class Number>
HWY_INLINE RowPlace PlaceOf(const Unit<Number, P::D>& unit, int slice, int row)
{
  constexpr block::Shape<P::D> shape{ B };
  RowPlace place;
  place.Y = P::D == 3 ? row : slice;
  place.Z = slice;
  place.Row = row;
  place.Sample = (P::D == 3    ? slice * shape.Z()
                   : P::D == 2 ? slice * shape.Y()
                               : 0) +
                 row * shape.Pitch();
  place.Magnitude = (P::D == 3    ? slice * shape.MagnitudeZ()
                      : P::D == 2 ? slice * shape.Y()
                                  : 0) +
                    row * shape.Pitch();
  const glm::ivec3& limit = unit.Limit[P::D < 3 ? row : 0];
  const bool inside =
    (P::D < 2 || place.Y <= limit.y) && (P::D < 3 || place.Z <= limit.z) && P::First <= limit.x;
  place.Coded = inside ? (std::min(limit.x, B - 1) - P::First) / P::Step + 1 : 0;
  return place;
}

static_assert(block::Interpolations == 3, "PredictAt lacks an interpolation");

/// Predicts some lanes of a row; those that the pass does not have hold anything.
/// @param At lane, counted from the first one, where they begin
/// @param from the sample there
/// @param gap distance of samples that are a stride apart along the axis of the pass
/// @param position of the row along that axis; any along the first
template <class P, int B, int At, int N, class Number>
HWY_INLINE Pack<Number, N> PredictAt(
  const Number* from, std::ptrdiff_t gap, int position, Interpolation by)
{
  using V = Pack<Number, N>;
  if (by == Interpolation::None)
  {
    return V::Set(0);
  }
  const V before = V::Load(from - gap);
  const V after = V::Load(from + gap);
  if (by == Interpolation::Linear)
  {
    return Linear(before, after);
  }
  if constexpr (P::Axis > 0)
  {
    if (position == P::S)
    {
      return Quadratic(before, after, V::Load(from + 3 * gap));
    }
    if (position == B - P::S)
    {
      return Quadratic(after, before, V::Load(from - 3 * gap));
    }
    return Cubic(V::Load(from - 3 * gap), before, after, V::Load(from + 3 * gap));
  }
  else
  {
    const V first = V::Load(from - 3 * gap);
    const V last = V::Load(from + 3 * gap);
    V result = Cubic(first, before, after, last);
    if constexpr (At == 0)
    {
      const V mask = ConstantLanes<Number, N, OnlyLane<0>>::Get();
      result = Select(mask, Quadratic(before, after, last), result);
    }
    constexpr int end = B - 2 * P::S - At; // the last lane, from here
    if constexpr (end < N)
    {
      const V mask = ConstantLanes<Number, N, OnlyLane<end>>::Get();
      result = Select(mask, Quadratic(after, before, first), result);
    }
    return result;
  }
}

/// The same of a unit, as its memory is laid out.
template <class P, int B, int At, class Number>
HWY_INLINE Samples<Number> Predict(const Number* samples, const RowPlace& place, Interpolation by)
{
  constexpr block::Shape<P::D> shape{ B };
  constexpr std::ptrdiff_t gap =
    P::Axis == 0 ? P::S : P::S * (P::Axis == 1 ? shape.Y() : shape.Z());
  return PredictAt<P, B, At, Width>(
    samples + place.Sample + P::First + At, gap, P::Axis == 1 ? place.Y : place.Z, by);
}

/// All bits of the lanes, from First + At on, that a pass has.
template <class P, int B, int At, class T, int N = Width>
HWY_INLINE Pack<T, N> LanesOfPass()
{
  return ConstantLanes<T, N, EveryOf<P::Step, B - P::First - At>>::Get();
}

/// All bits of the lanes of a pass that are among the next few.
template <class P, class T>
HWY_INLINE Pack<T, Width> LanesOfPassBelow(int end)
{
  static_assert(std::is_signed_v<T>, "as they are compared");
  return (Pack<T, Width>::Set(static_cast<T>(end)) > LaneNumbers<T, Width>()) &
         ConstantLanes<T, Width, EveryOf<P::Step, Width>>::Get();
}

/// Sets the lanes of a pass.
/// @param to lane First + At of a row
template <class P, int B, int At, class T, int N, bool One>
HWY_INLINE void SetLanes(const PackOf<T, N, One>& value, T* to)
{
  Select(LanesOfPass<P, B, At, T, N>(), value, PackOf<T, N, One>::Load(to)).Store(to);
}

/// Calls body(pass) for each pass of units of D dimensions: stride 2 and then stride 1, and in each
/// the axes in order.
template <int D, class Body>
HWY_INLINE void ForEachPass(const Body& body)
{
  body(Pass<D, 0, 2>{});
  if constexpr (D > 1)
  {
    body(Pass<D, 1, 2>{});
  }
  if constexpr (D > 2)
  {
    body(Pass<D, 2, 2>{});
  }
  body(Pass<D, 0, 1>{});
  if constexpr (D > 1)
  {
    body(Pass<D, 1, 1>{});
  }
  if constexpr (D > 2)
  {
    body(Pass<D, 2, 1>{});
  }
}

} // namespace banyan::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
