// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_PlaceInShape_h
#define banyan_Cells_PlaceInShape_h

#include "Cells/CellShape.h"

#include <glm/vec3.hpp>

#include <array>

namespace banyan
{

/// Corners of a cell in space, in the order of its shape; those that it does not have are not read.
using CellCorners = std::array<glm::dvec3, 8>;

/// The weights of a cell's corners at a place: VTK's shape functions. They add up to 1, also
/// outside of the cell.
/// @param place in VTK's parametric coordinates, from 0 to 1 inside
std::array<double, 8> WeightsAt(CellShape shape, const glm::dvec3& place);

/// Where a place of a cell lies in space.
glm::dvec3 PositionAt(CellShape shape, const CellCorners& corners, const glm::dvec3& place);

/// How far outside of each face of a cell a point still counts as inside, by the numbers of
/// FacesOf.
using FaceTolerances = std::array<double, 6>;

/// Where in a cell a point lies: by Newton's method from the middle, in double. The cell may be
/// mirrored; one without volume holds nothing. Slow and obvious: what faster code is held to.
///
/// For pyramids the unknowns are h, which is 1 at the base and 0 at the apex, u = h r and v = h s
/// with r and s from -1 to 1 over the base: so the map has no singularity at the apex.
/// @param tolerances of places from -1 to 1 for hexahedra and along the prism of wedges; of
///   barycentric coordinates for tetrahedra and the triangles of wedges; of u, v and h for pyramids
/// @param place is set when the result is true
/// @return whether the point is inside
bool FindPlace(CellShape shape, const CellCorners& corners, const glm::dvec3& point,
  const FaceTolerances& tolerances, glm::dvec3& place);

/// The same with one tolerance for all faces.
bool FindPlace(CellShape shape, const CellCorners& corners, const glm::dvec3& point,
  double tolerance, glm::dvec3& place);

} // namespace banyan

#endif
