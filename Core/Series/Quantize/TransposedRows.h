// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_TransposedRows_h
#define banyan_Series_Quantize_TransposedRows_h

#include <cstddef>

namespace banyan
{

/// Copies a sheet of numbers whose rows lie along one axis to where they lie along the other:
/// to[j * toRow + i] = from[i * fromRow + j].
/// @param rows of `from`, i, and @param count numbers of each, j
/// @tparam Number std::int16_t or std::int32_t
template <class Number>
void CopyTransposed(const Number* from, std::ptrdiff_t fromRow, int rows, int count, Number* to,
  std::ptrdiff_t toRow);

} // namespace banyan

#endif
