#ifndef banyan_Series_LatticeRows_h
#define banyan_Series_LatticeRows_h

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

/// Lattice numbers of values: the nearest ones, within the lattice's limits. The same bits on every
/// processor.
/// @param T float or double, and @param Number std::int16_t or std::int32_t
/// @return whether all are held (NaN is not); if not, numbers are anything
template <class T, class Number>
bool NumbersOnLattice(
  const T* values, std::size_t count, const LatticeScale& scale, Number* numbers);

/// What values and their decoded numbers differ by, over many rows. Sums are taken over every eighth
/// value of a row, so that they are the same bits on every processor.
struct RowErrors
{
  static constexpr int Lanes = 8;
  double Greatest[Lanes] = {};
  double Squares[Lanes] = {};
  std::int32_t Low = INT32_MAX, High = INT32_MIN; ///< of the numbers
};

/// Adds the differences of a row from what its numbers decode to: (T) (origin + number * step).
/// @return whether all are at most `bound`; if not (a NaN, for one), errors are anything
template <class T, class Number>
bool AddRowErrors(const T* values, const Number* numbers, std::size_t count,
  const LatticeScale& scale, double bound, RowErrors& errors);

} // namespace banyan

#endif
