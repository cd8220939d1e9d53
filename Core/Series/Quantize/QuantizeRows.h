// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_QuantizeRows_h
#define banyan_Series_Quantize_QuantizeRows_h

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// A lattice of values as they are, without a transform: which values it holds, and their numbers.
struct LatticeScale
{
  double Origin = 0, Step = 1;
  double Nearest = 0, Furthest = 0; ///< values outside are not put on the lattice
  std::int32_t Least = 0, Greatest = 0;
};

/// Where the values of a box and their numbers lie: rows of values one after the other, or with
/// gaps between them, in slices. All distances in elements.
template <class T, class Number>
struct QuantizedRows
{
  const T* Values = nullptr;
  std::int64_t Gap = 1, ValueRow = 0, ValueSlice = 0;
  Number* Numbers = nullptr;
  std::int64_t NumberRow = 0, NumberSlice = 0;
  int Count = 0; ///< of a row, at most 64
  int Rows = 0, Slices = 0;
  std::int64_t Next = 0; ///< distance of the values that will be asked for next: they are fetched
};

/// Lattice numbers of values: the nearest ones, within the lattice's limits. The same bits on every
/// processor.
/// @param T float or double, and @param Number std::int16_t or std::int32_t
/// @return whether all are held (NaN is not); if not, numbers are anything
template <class T, class Number>
bool QuantizeRows(const QuantizedRows<T, Number>& rows, const LatticeScale& scale);

/// Says by how much values and what their numbers decode to differ. Sums are taken over every
/// eighth value of rows, so that they are the same bits on every processor.
struct RowErrors
{
  static constexpr int Lanes = 8;
  double Greatest[Lanes] = {};
  double Squares[Lanes] = {};
  std::int32_t Low = INT32_MAX, High = INT32_MIN; ///< of the numbers
};

/// The differences of a box from what its numbers decode to: (T) (origin + number * step).
/// @return whether all are at most `bound`; if not (a NaN, for one), errors are anything
template <class T, class Number>
bool ErrorsOnLattice(const QuantizedRows<T, const Number>& rows, const LatticeScale& scale,
  double bound, RowErrors& errors);

} // namespace banyan

#endif
