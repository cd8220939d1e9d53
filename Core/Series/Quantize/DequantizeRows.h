// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_DequantizeRows_h
#define banyan_Series_Quantize_DequantizeRows_h

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// values = (T) (origin + number * step) of a box of numbers, in double precision: the same bits on
/// every machine.
/// @param size along x, y, z; rows of numbers, and of values, lie side by side
/// @param pitch of the numbers along y and z (x is 1), and @param to of the values
/// @param T float or double
/// @param Number std::int16_t or std::int32_t
template <class Number, class T>
void DequantizeRows(const Number* numbers, const glm::i64vec3& pitch, const glm::ivec3& size,
  double origin, double step, T* values, const glm::i64vec3& to);

/// A box of numbers whose rows lie side by side.
template <class Number>
struct LatticePart
{
  const Number* Numbers = nullptr;
  std::int64_t Y = 0, Z = 0; ///< distances of numbers along these axes
  int Width = 0;             ///< numbers of a row
};

/// The same of boxes that lie side by side along x, row by row of all of them.
/// @param y,z how many rows along these axes; each box has as many
template <class Number, class T>
void DequantizeParts(const LatticePart<Number>* parts, int count, int y, int z, double origin,
  double step, T* values, const glm::i64vec3& to);

/// Numbers of a box in the order of other axes: x fastest, without gaps.
/// @param stride of the numbers along x, y, z: one of them is 1, and not that of x
/// @param Number std::int16_t or std::int32_t
template <class Number>
void TransposeBox(
  const Number* numbers, const glm::i64vec3& stride, const glm::ivec3& size, Number* ordered);

} // namespace banyan

#endif
