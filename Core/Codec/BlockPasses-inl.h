// SPDX-License-Identifier: BSD-3-Clause
// Included once per SIMD target: see BlockDecoder.cxx and BlockEncoder.cxx.
#if defined(banyan_Codec_BlockPasses_inl_h) == defined(HWY_TARGET_TOGGLE)
#ifdef banyan_Codec_BlockPasses_inl_h
#undef banyan_Codec_BlockPasses_inl_h
#else
#define banyan_Codec_BlockPasses_inl_h
#endif

#include "Codec/BlockModes.h"
#include "Codec/BlockScratch.h"

#include <algorithm>
#include <cstring>
#include <type_traits>

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace banyan::HWY_NAMESPACE
{

using block::Interpolation;

/// The edge of blocks, known to the compiler or not.
template <int B>
struct EdgeIs
{
  static constexpr int Known = B;
  HWY_INLINE constexpr int operator()() const { return B; }
};
template <>
struct EdgeIs<0>
{
  static constexpr int Known = 0;
  int B;
  HWY_INLINE int operator()() const { return this->B; }
};

/// Calls body(edge) with one that is known for the blocks that the encoder takes by itself.
template <class Body>
HWY_INLINE void WithEdge(int edge, const Body& body)
{
  switch (edge)
  {
    case 16:
      return body(EdgeIs<16>{});
    case 32:
      return body(EdgeIs<32>{});
    default:
      return body(EdgeIs<0>{ edge });
  }
}

/// Lanes that are worked on together (vectors of the compiler: it splits them for every target).
constexpr int Width = 16;

template <class Number, int Lanes>
struct VectorsOf
{
  static constexpr int Bytes = Lanes * static_cast<int>(sizeof(Number));
  typedef Number Signed __attribute__((vector_size(Bytes)));
  typedef std::make_unsigned_t<Number> Unsigned __attribute__((vector_size(Bytes)));
};
typedef std::uint8_t ByteVector __attribute__((vector_size(16)));
typedef std::int8_t SignedByteVector __attribute__((vector_size(16)));

template <class Vector, class Element>
HWY_INLINE Vector LoadVector(const Element* from)
{
  Vector result;
  std::memcpy(&result, from, sizeof(result));
  return result;
}
template <class Vector, class Element>
HWY_INLINE void StoreVector(const Vector& value, Element* to)
{
  std::memcpy(to, &value, sizeof(value));
}

/// Predictions of whole vectors. Arithmetic wraps: files made with ill intent must not reach
/// undefined behaviour. The formulas are the usual ones, rounded, in an order that needs no more
/// bits than samples have.
template <class Number, int Lanes = Width>
struct Numbers
{
  using Signed = typename VectorsOf<Number, Lanes>::Signed;
  using Unsigned = typename VectorsOf<Number, Lanes>::Unsigned;

  static HWY_INLINE Unsigned Load(const Number* from) { return LoadVector<Unsigned>(from); }
  static HWY_INLINE Unsigned Shift(Unsigned value, int bits)
  {
    return reinterpret_cast<Unsigned>(reinterpret_cast<Signed>(value) >> static_cast<Number>(bits));
  }

  /// (9 (b + c) - a - d + 8) / 16, rounded down.
  static HWY_INLINE Unsigned Cubic(Unsigned a, Unsigned b, Unsigned c, Unsigned d)
  {
    const Unsigned middle = b + c;
    return Shift(middle + Number{ 1 } + Shift(middle - (a + d), 3), 1);
  }
  /// (3 near + 6 other - far + 4) / 8, rounded down.
  static HWY_INLINE Unsigned Quadratic(Unsigned near, Unsigned other, Unsigned far)
  {
    return other + Shift((near - other) + Shift(near - far + Number{ 4 }, 1), 2);
  }
  static HWY_INLINE Unsigned Linear(Unsigned a, Unsigned b)
  {
    return Shift(a + b + Number{ 1 }, 1);
  }
};

/// Lane numbers of a vector of 16 or 32.
template <class Vector>
HWY_INLINE Vector LaneNumbers()
{
  if constexpr (sizeof(Vector) == Width * sizeof(Vector{}[0]))
  {
    return Vector{ 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15 };
  }
  else
  {
    return Vector{ 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22,
      23, 24, 25, 26, 27, 28, 29, 30, 31 };
  }
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
  static int EndOfSlices(int edge) { return D == 1 ? 1 : edge; }
  /// The rows of a slice: y of an interior, or the numbers of faces or edges.
  static constexpr int FirstRow = D < 3 ? 0 : 1 <= Axis ? S : 2 * S;
  static constexpr int RowStep = D < 3 ? 1 : 1 < Axis ? S : 2 * S;
  static int EndOfRows(int edge) { return D < 3 ? 3 : edge; }
  static int LanesOf(int edge) { return (edge - First + Step - 1) / Step; }
};

/// -1 for the lanes of a vector that a pass predicts.
/// @param left lanes up to the edge
template <class P, class Vector>
HWY_INLINE Vector LaneMask(int left)
{
  using Element = std::remove_reference_t<decltype(Vector{}[0])>;
  const Vector lanes = LaneNumbers<Vector>();
  const auto below = lanes < static_cast<Element>(left);
  if (P::Step == 1)
  {
    return reinterpret_cast<Vector>(below);
  }
  return reinterpret_cast<Vector>(
    below & ((lanes & static_cast<Element>(P::Step - 1)) == Element{ 0 }));
}

/// Where a row of a slice lies.
struct RowPlace
{
  std::ptrdiff_t W, M; ///< its lane 0
  int Y, Z;            ///< positions of an interior; Y of faces
  int Row;             ///< its number: Y of an interior, or that of the face or edge
  int Coded;           ///< lanes of the pass (from its first) that carry a residual
};

/// Units as the passes see them.
template <class Number, int D>
struct Unit
{
  Number* W;
  std::uint8_t* M;
  std::int8_t* R;   ///< residuals, from -15 to 15; same places
  std::uint16_t* S; ///< sums of the magnitudes of rows
  /// Greatest position per axis that carries residuals; of each face and edge.
  glm::ivec3 Limit[3];
  bool Any = false; ///< whether some magnitude may be other than 0
};

template <class P, class Edge, class Number>
HWY_INLINE RowPlace PlaceOf(const Unit<Number, P::D>& unit, const Edge& edge, int slice, int row)
{
  const block::Shape<P::D> shape{ edge() };
  RowPlace place;
  place.Y = P::D == 3 ? row : slice;
  place.Z = slice;
  place.Row = row;
  place.W = (P::D == 3    ? slice * shape.Z()
              : P::D == 2 ? slice * shape.Y()
                          : 0) +
            row * shape.Pitch();
  place.M = (P::D == 3    ? slice * shape.ZM()
              : P::D == 2 ? slice * shape.Y()
                          : 0) +
            row * shape.Pitch();
  const glm::ivec3& limit = unit.Limit[P::D < 3 ? row : 0];
  const bool inside =
    (P::D < 2 || place.Y <= limit.y) && (P::D < 3 || place.Z <= limit.z) && P::First <= limit.x;
  place.Coded = inside ? (std::min(limit.x, edge() - 1) - P::First) / P::Step + 1 : 0;
  return place;
}

/// Predicts some lanes of a row; those that the pass does not have hold anything.
/// @param from lane First + at of the row
/// @param gap distance of samples that are a stride apart along the axis of the pass
/// @param position of the row along that axis; any along the first
template <class P, int Lanes = Width, class Edge, class Number>
HWY_INLINE typename Numbers<Number, Lanes>::Unsigned PredictAt(
  const Number* from, std::ptrdiff_t gap, const Edge& edge, int position, int at, Interpolation by)
{
  using V = Numbers<Number, Lanes>;
  using Vector = typename V::Unsigned;
  if (by == Interpolation::None)
  {
    return Vector{};
  }
  const Vector before = V::Load(from - gap);
  const Vector after = V::Load(from + gap);
  if (by == Interpolation::Linear)
  {
    return V::Linear(before, after);
  }
  if (P::Axis > 0)
  {
    if (position == P::S)
    {
      return V::Quadratic(before, after, V::Load(from + 3 * gap));
    }
    if (position == edge() - P::S)
    {
      return V::Quadratic(after, before, V::Load(from - 3 * gap));
    }
    return V::Cubic(V::Load(from - 3 * gap), before, after, V::Load(from + 3 * gap));
  }
  const Vector first = V::Load(from - 3 * gap);
  const Vector last = V::Load(from + 3 * gap);
  Vector result = V::Cubic(first, before, after, last);
  const Vector lanes = LaneNumbers<Vector>();
  if (at == 0)
  {
    result = lanes == Number{ 0 } ? V::Quadratic(before, after, last) : result;
  }
  const int end = edge() - 2 * P::S - at; // the last lane, from here
  if (end < Lanes)
  {
    result = lanes == static_cast<Number>(end) ? V::Quadratic(after, before, first) : result;
  }
  return result;
}

/// The same of a unit, as its memory is laid out.
template <class P, class Edge, class Number>
HWY_INLINE typename Numbers<Number>::Unsigned Predict(
  const Number* w, const Edge& edge, const RowPlace& place, int at, Interpolation by)
{
  const block::Shape<P::D> shape{ edge() };
  const std::ptrdiff_t gap = P::Axis == 0 ? P::S : P::S * (P::Axis == 1 ? shape.Y() : shape.Z());
  return PredictAt<P>(
    w + place.W + P::First + at, gap, edge, P::Axis == 1 ? place.Y : place.Z, at, by);
}

/// Sets the lanes of a pass.
/// @param to lane First + at of a row, and @param left how many lanes there are up to the edge
template <class P, class Vector, class Number>
HWY_INLINE void SetLanes(Vector value, int left, Number* to)
{
  const Vector mask = LaneMask<P, Vector>(left);
  StoreVector((value & mask) | (LoadVector<Vector>(to) & ~mask), to);
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
