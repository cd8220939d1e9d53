// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_GoldenCells_h
#define banyan_Testing_GoldenCells_h

#include "Base/Bytes.h"
#include "Mesh/CellSeries/StoredCells.h"

#include <glm/vec3.hpp>

#include <memory>
#include <string>
#include <vector>

namespace banyan
{
class SeriesFile;
}

namespace banyan::testing
{

/// The mesh of cells of any type of golden series: hexahedra, wedges, tetrahedra, a polyhedron, a
/// cell without points, and a point that no cell uses.
struct GoldenCells
{
  std::shared_ptr<const StoredCells> Mesh;
  std::vector<glm::ivec3> Points; ///< place of each point
  std::vector<glm::ivec3> Cells;  ///< lowest corner of each cell

  GoldenCells();

  /// The points of a step: those of the mesh until step 2, then others.
  Bytes PointsAt(int step) const;
};

/// Hashes of what a series of such a mesh has.
std::string CellsText(const SeriesFile& file);

} // namespace banyan::testing

#endif
