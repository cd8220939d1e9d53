// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_CellSeries_ImageOrder_h
#define banyan_Mesh_CellSeries_ImageOrder_h

#include "Mesh/CellSeries/StoredCells.h"

namespace banyan
{

/// The samples of points or cells in the order of the file: x fastest in the box.
/// @param image samples of the image that the box is the first corner of
std::vector<std::uint32_t> OrderOfFile(
  std::size_t count, const glm::ivec3& box, const glm::ivec3& image);

/// Boxes that hold a number of things in the order of the file, with rows and slabs as generators
/// of lattices have them, where differences of numbers in cells tell.
std::vector<glm::ivec3> BoxesOfFile(
  const StoredCells& mesh, std::size_t count, const glm::ivec3& boxOfPlaces);

/// How many bits values are going to take about, each, if they lie at these samples: what their
/// neighbours on both sides, along each axis, leave of them. Less is better.
double BitsInOrder(const std::vector<std::uint32_t>& samples, const glm::ivec3& box,
  const std::vector<ValuesToKeep>& arrays);

} // namespace banyan

#endif
