// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_CellNodes_h
#define banyan_Mesh_Octree_CellNodes_h

#include "Mesh/Octree/NodalField.h"

#include <vector>

namespace banyan
{

/// Says what the values of a mesh belong to.
enum class ValuesOn
{
  Points,
  Cells,
  /// Points of which each cell has its own, or shares with some: at one place they may differ.
  CellCorners
};

/// Values at the points of a mesh, made of those of its cells: at a place where no point hangs, the
/// mean of the cells around it, each with the weight 1 / edge. On a lattice of one size that is
/// what "Cell Data to Point Data" does. Between cells of different sizes these weights keep every
/// linear field: the centre of a cell of edge h lies h / 2 away from its corner along each axis, so
/// that the weighted centres of eight cells around a place have this place as their mean. At the
/// border of the mesh, where fewer than eight cells meet, the mean is that of those that are there.
///
/// Points that hang get whatever: NodalField replaces them. A cell whose value is not finite makes
/// its eight corners so; points of no cell are 0.
///
/// Does not depend on the order of cells and points, nor on threads: sums are made octant by
/// octant.
class CellNodes
{
public:
  /// @param values one tuple per cell of the mesh (of ElementOctree::CellOfLeaf) for
  /// ValuesOn::Cells; one per point for CellCorners: the mean of what the cells around a place have
  /// there, weighted in the same way. Vectors are replaced by their lengths first. Throws Error
  /// when the array has no such component, or no values.
  CellNodes(const ElementOctree& tree, const NodeArray& values, ValuesOn where, ThreadPool& pool);

  /// One component at each point of the mesh; lives as long as this. Float32, or Float64 where
  /// float32 cannot hold the values of the cells.
  NodeArray Nodes() const;

private:
  std::vector<float> Floats;
  std::vector<double> Doubles;
};

} // namespace banyan

#endif
