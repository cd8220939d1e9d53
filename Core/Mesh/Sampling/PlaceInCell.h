// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Sampling_PlaceInCell_h
#define banyan_Mesh_Sampling_PlaceInCell_h

#include "Mesh/Sampling/CellShapes.h"

#include <cstdint>

namespace banyan
{

/// Where a point of space lies in a mesh.
struct PlaceInCell
{
  std::int64_t Cell = -1;
  glm::dvec3 Part{ 0.0 }; ///< from 0 to 1 along the cell's own axes
  bool Inside = false;    ///< otherwise the place is the nearest one that was found
};

/// Some cells of a mesh, in ascending order.
struct CellList
{
  const std::uint32_t* Begin = nullptr;
  const std::uint32_t* End = nullptr;
};

/// The cell that a point lies in, if there is one: the first part of FindPlace.
PlaceInCell FindInside(const CellShapes& shapes, const CellList& cells, const glm::dvec3& point);

/// An estimate of the nearest place in the nearest cell: the other part.
PlaceInCell FindNearest(const CellShapes& shapes, const CellList& cells, const glm::dvec3& point);

/// Where a point lies: of several cells in the first one, which at faces is the same for all lists
/// that have these cells. Outside of all, an estimate of the nearest place in the nearest cell.
/// @param point on the lattice of the shapes
PlaceInCell FindPlace(const CellShapes& shapes, const CellList& cells, const glm::dvec3& point);

} // namespace banyan

#endif
