// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Points_PointsCode_h
#define banyan_Series_Points_PointsCode_h

#include "Base/Bytes.h"
#include "Base/ScalarType.h"

#include <glm/vec3.hpp>

namespace banyan
{

/// Codes a chunk of points, bit-exact: smooth grids get small differences. The same bytes on every
/// thread.
/// @param values `[z][y][x][components]` of `size`
Bytes PackPoints(
  ScalarType type, int components, const glm::ivec3& size, const std::uint8_t* values);

/// Inverse of PackPoints. Throws Error for bytes that it did not make.
/// @param values receives as many as `size` and `components` say
void UnpackPoints(ScalarType type, int components, const glm::ivec3& size,
  const std::uint8_t* stored, std::size_t bytes, std::uint8_t* values);

} // namespace banyan

#endif
