// SPDX-License-Identifier: BSD-3-Clause
#include "GridOfHyperTrees.h"

#include "GhostCells.h"
#include "VoxelCells.h"

#include "Base/Error.h"
#include "Base/Morton.h"

#include "vtkCellData.h"
#include "vtkDataArray.h"
#include "vtkDataSetAttributes.h"
#include "vtkHyperTree.h"
#include "vtkHyperTreeGrid.h"
#include "vtkHyperTreeGridNonOrientedCursor.h"
#include "vtkIdList.h"
#include "vtkNew.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <unordered_map>

namespace banyan
{
namespace
{

class LeafCollector
{
public:
  explicit LeafCollector(vtkHyperTreeGrid* trees)
    : Trees(trees)
    , Ghosts(trees->GetGhostCells())
  {
    vtkHyperTreeGrid::vtkHyperTreeGridIterator each;
    each.Initialize(trees);
    vtkIdType number = 0;
    while (vtkHyperTree* const tree = each.GetNextTree(number))
    {
      this->Depth = std::max(this->Depth, static_cast<int>(tree->GetNumberOfLevels()) - 1);
    }
    this->Points->SetDataTypeToDouble();
  }

  void CheckSize() const
  {
    int cells[3];
    this->Trees->GetCellDims(cells);
    for (int axis = 0; axis < 3; ++axis)
    {
      if (this->Depth > MortonBits ||
          static_cast<std::int64_t>(cells[axis]) << this->Depth > MortonEdge)
      {
        throw Error("The hyper tree grid has " + std::to_string(cells[axis]) + " trees of up to " +
                    std::to_string(this->Depth) + " refinements along axis " +
                    std::to_string(axis) + ": more than " + std::to_string(MortonEdge) +
                    " finest cells. Limit its depth with 'HyperTreeGrid - Depth Limiter'.");
      }
    }
  }

  void Collect()
  {
    vtkHyperTreeGrid::vtkHyperTreeGridIterator each;
    each.Initialize(this->Trees);
    vtkIdType number = 0;
    vtkNew<vtkHyperTreeGridNonOrientedCursor> cursor;
    while (each.GetNextTree(number))
    {
      unsigned int root[3];
      this->Trees->GetLevelZeroCoordinatesFromIndex(number, root[0], root[1], root[2]);
      this->Trees->InitializeNonOrientedCursor(cursor, number);
      const std::array<std::int64_t, 3> corner{ { std::int64_t{ root[0] } << this->Depth,
        std::int64_t{ root[1] } << this->Depth, std::int64_t{ root[2] } << this->Depth } };
      this->Visit(cursor, corner, this->Depth);
    }
  }

  vtkNew<vtkPoints> Points;
  VoxelCells Voxels;
  vtkNew<vtkIdList> Numbers; ///< of the leaves, in the cell data of the trees
  vtkIdType Last = -1;       ///< the largest of them

private:
  /// @param corner in finest cells; the cell has 2^level of them along each axis
  void Visit(
    vtkHyperTreeGridNonOrientedCursor* cursor, const std::array<std::int64_t, 3>& corner, int level)
  {
    if (cursor->IsMasked())
    {
      return;
    }
    if (cursor->IsLeaf())
    {
      this->Take(cursor->GetGlobalNodeIndex(), corner, level);
      return;
    }
    for (unsigned char child = 0; child < 8; ++child)
    {
      const std::int64_t half = std::int64_t{ 1 } << (level - 1);
      cursor->ToChild(child);
      this->Visit(cursor,
        { { corner[0] + half * (child & 1), corner[1] + half * (child >> 1 & 1),
          corner[2] + half * (child >> 2) } },
        level - 1);
      cursor->ToParent();
    }
  }

  void Take(vtkIdType number, const std::array<std::int64_t, 3>& corner, int level)
  {
    if (this->Ghosts && number >= this->Ghosts->GetNumberOfTuples())
    {
      throw Error("The hyper tree grid has " + std::to_string(this->Ghosts->GetNumberOfTuples()) +
                  " ghost flags, but a cell " + std::to_string(number) + ": write the file again.");
    }
    if (this->Ghosts && (this->Ghosts->GetValue(number) & GhostBits) != 0)
    {
      return;
    }
    vtkIdType points[8];
    for (int i = 0; i < 8; ++i)
    {
      points[i] = this->PointAt({ { corner[0] + (std::int64_t{ i & 1 } << level),
        corner[1] + (std::int64_t{ i >> 1 & 1 } << level),
        corner[2] + (std::int64_t{ i >> 2 } << level) } });
    }
    this->Voxels.Add(points);
    this->Numbers->InsertNextId(number);
    this->Last = std::max(this->Last, number);
  }

  vtkIdType PointAt(const std::array<std::int64_t, 3>& place)
  {
    // Up to 2^21 along each axis, both ends included.
    const std::uint64_t key = static_cast<std::uint64_t>(place[0]) +
                              static_cast<std::uint64_t>(place[1]) * 2097153u +
                              static_cast<std::uint64_t>(place[2]) * (2097153ull * 2097153ull);
    const auto found = this->PointOf.emplace(key, this->Points->GetNumberOfPoints());
    if (found.second)
    {
      this->Points->InsertNextPoint(Coordinate(this->Trees->GetXCoordinates(), place[0]),
        Coordinate(this->Trees->GetYCoordinates(), place[1]),
        Coordinate(this->Trees->GetZCoordinates(), place[2]));
    }
    return found.first->second;
  }

  double Coordinate(vtkDataArray* planes, std::int64_t place) const
  {
    const std::int64_t root = place >> this->Depth;
    const std::int64_t in = place - (root << this->Depth);
    const double low = planes->GetTuple1(root);
    if (in == 0)
    {
      return low;
    }
    const double part =
      static_cast<double>(in) / static_cast<double>(std::int64_t{ 1 } << this->Depth);
    return low + part * (planes->GetTuple1(root + 1) - low);
  }

  vtkHyperTreeGrid* Trees;
  vtkUnsignedCharArray* Ghosts;
  int Depth = 0; ///< refinements of the deepest tree
  std::unordered_map<std::uint64_t, vtkIdType> PointOf;
};

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> GridOfHyperTrees(
  vtkHyperTreeGrid* trees, const std::string& array)
{
  auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  if (!trees || trees->GetNumberOfCells() == 0)
  {
    return grid;
  }
  if (trees->GetDimension() != 3)
  {
    throw Error("The hyper tree grid has " + std::to_string(trees->GetDimension()) +
                " dimensions, and a volume has 3: show it as 'Surface'.");
  }
  if (trees->GetBranchFactor() != 2)
  {
    throw Error("The cells of the hyper tree grid are cut into " +
                std::to_string(trees->GetBranchFactor()) +
                " along each axis, and those of an octree into 2: use 'Resample To Image'.");
  }
  LeafCollector leaves(trees);
  leaves.CheckSize();
  leaves.Collect();
  leaves.Voxels.Finish(grid, leaves.Points);
  for (int i = 0; i < trees->GetCellData()->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* const all = trees->GetCellData()->GetArray(i);
    const std::string name = all && all->GetName() ? all->GetName() : "";
    if (all && name != vtkDataSetAttributes::GhostArrayName() && (array.empty() || name == array))
    {
      if (leaves.Last >= all->GetNumberOfTuples())
      {
        throw Error("The cell array " + name + " of the hyper tree grid has " +
                    std::to_string(all->GetNumberOfTuples()) + " values, but a cell " +
                    std::to_string(leaves.Last) + ": write the file again.");
      }
      grid->GetCellData()->AddArray(Chosen(all, leaves.Numbers));
    }
  }
  return grid;
}

} // namespace banyan
