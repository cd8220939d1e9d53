#ifndef banyan_Series_LatticeValues_h
#define banyan_Series_LatticeValues_h

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// values[i] = (T) (origin + numbers[i] * step), in double precision: the same bits on every machine.
/// @param T float or double
/// @param Number std::int16_t or std::int32_t
template <class Number, class T>
void ValuesOnLattice(
  const Number* numbers, std::size_t count, double origin, double step, T* values);

} // namespace banyan

#endif
