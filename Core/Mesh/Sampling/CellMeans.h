// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Sampling_CellMeans_h
#define banyan_Mesh_Sampling_CellMeans_h

#include "Mesh/Octree/HexMesh.h"
#include "Mesh/Octree/NodalField.h"

#include <vector>

namespace banyan
{

/// Values at the points of a mesh of general hexahedra, made of those of its cells: at each point
/// the mean of the cells that have it as a corner; 0 at points of no cell. Vectors are replaced by
/// their lengths first.
class CellMeans
{
public:
  /// @param values one tuple per cell
  /// Throws Error when the array has no such component, or no values.
  CellMeans(const HexMesh& mesh, const NodeArray& values);

  /// One component, float64, at each point; lives as long as this.
  NodeArray Nodes() const;

private:
  std::vector<double> Means;
};

} // namespace banyan

#endif
