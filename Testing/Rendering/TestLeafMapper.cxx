// SPDX-License-Identifier: BSD-3-Clause
// Cell data of hexahedra, hyper tree grids and AMR in a real window: the pictures of meshes that
// were made of the same cells in another way, and sentences for what has no octree.
#include "LeafParts.h"
#include "LeafPictures.h"

#include "vtkAMRBox.h"
#include "vtkBitArray.h"
#include "vtkCellData.h"
#include "vtkCellDataToPointData.h"
#include "vtkCellType.h"
#include "vtkDataSetAttributes.h"
#include "vtkDoubleArray.h"
#include "vtkHyperTree.h"
#include "vtkHyperTreeGrid.h"
#include "vtkHyperTreeGridNonOrientedCursor.h"
#include "vtkHyperTreeGridToUnstructuredGrid.h"
#include "vtkOverlappingAMR.h"
#include "vtkPoints.h"
#include "vtkStructuredData.h"
#include "vtkUniformGrid.h"
#include "vtkUnstructuredGrid.h"

#include <array>

namespace
{

using namespace leaf_pictures;
using namespace banyan;

void CellsOfOneSizeAreAsCellDataToPointDataHasThem()
{
  constexpr int n = 12;
  vtkNew<vtkImageData> image;
  image->SetDimensions(n + 1, n + 1, n + 1);
  image->SetSpacing(1.0 / n, 1.0 / n, 1.0 / n);
  vtkNew<vtkDoubleArray> values;
  values->SetName("field");
  Voxels voxels;
  const double edge[3] = { 1.0 / n, 1.0 / n, 1.0 / n };
  for (int i = 0; i < n * n * n; ++i)
  {
    const double low[3] = { i % n / double(n), i / n % n / double(n), i / (n * n) / double(n) };
    values->InsertNextValue(Wavy(low[0], low[1], low[2]));
    voxels.Add(low, edge, values->GetValue(i));
  }
  image->GetCellData()->AddArray(values);
  vtkNew<vtkCellDataToPointData> filter;
  filter->SetInputData(image);
  filter->Update();
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputDataObject(filter->GetOutput());
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectScalarArray("field");
  mapper->SetSampleDistanceVoxels(0.5);
  Stage stage(mapper);
  const double bounds[6] = { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  stage.LookAt(bounds);
  const auto expected = stage.Draw();
  Check(Covered(expected) > 3000, "cell data are seen");
  Check(Difference(expected, PictureOf(voxels.Done())) <= 1, "cell data are drawn as point data");

  // A ghost cell, that has another value, is none of them.
  vtkUnstructuredGrid* const grid = voxels.Done();
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  ghosts->SetNumberOfTuples(grid->GetNumberOfCells());
  ghosts->Fill(0);
  const auto with = vtkSmartPointer<vtkUnstructuredGrid>::New();
  with->DeepCopy(grid);
  vtkNew<vtkIdList> first;
  grid->GetCellPoints(0, first);
  with->InsertNextCell(VTK_VOXEL, first);
  with->GetCellData()->GetArray("field")->InsertNextTuple1(1000.0);
  ghosts->InsertNextValue(vtkDataSetAttributes::DUPLICATECELL);
  with->GetCellData()->AddArray(ghosts);
  Check(Difference(expected, PictureOf(with)) <= 1, "cell data are drawn without ghosts");
}

/// Trees of up to `depth` refinements; some cells are masked.
vtkSmartPointer<vtkHyperTreeGrid> Trees(
  unsigned int factor = 2, unsigned int flat = 3, bool masked = true, int depth = 3)
{
  const auto trees = vtkSmartPointer<vtkHyperTreeGrid>::New();
  trees->Initialize();
  trees->SetDimensions(3u, 4u, flat);
  trees->SetBranchFactor(factor);
  const auto planes = [](int count, double edge)
  {
    const auto made = vtkSmartPointer<vtkDoubleArray>::New();
    for (int i = 0; i < count; ++i)
    {
      made->InsertNextValue(i * edge);
    }
    return made;
  };
  trees->SetXCoordinates(planes(3, 0.5));
  trees->SetYCoordinates(planes(4, 1.0 / 3.0));
  trees->SetZCoordinates(planes(static_cast<int>(flat), 0.5));
  vtkNew<vtkDoubleArray> values;
  values->SetName("field");
  vtkNew<vtkBitArray> mask;
  vtkNew<vtkHyperTreeGridNonOrientedCursor> cursor;
  vtkIdType next = 0;
  const std::function<void(int)> visit = [&](int level)
  {
    const vtkIdType id = cursor->GetGlobalNodeIndex();
    values->InsertTuple1(id, 0.3 + 0.5 * ((id * 7919) % 101) / 101.0);
    const bool hidden = masked && level > 0 && id % 23 == 5;
    mask->InsertValue(id, hidden ? 1 : 0);
    if (hidden || level >= depth || id % 3 == 2)
    {
      return;
    }
    cursor->SubdivideLeaf();
    for (unsigned int child = 0; child < trees->GetNumberOfChildren(); ++child)
    {
      cursor->ToChild(static_cast<unsigned char>(child));
      visit(level + 1);
      cursor->ToParent();
    }
  };
  for (vtkIdType tree = 0; tree < trees->GetMaxNumberOfTrees(); ++tree)
  {
    trees->InitializeNonOrientedCursor(cursor, tree, true);
    cursor->SetGlobalIndexStart(next);
    visit(0);
    next += cursor->GetTree()->GetNumberOfVertices();
  }
  trees->GetCellData()->AddArray(values);
  if (masked)
  {
    trees->SetMask(mask);
  }
  return trees;
}

void HyperTreesAreTheirLeaves()
{
  for (const bool masked : { false, true })
  {
    const auto trees = Trees(2, 3, masked);
    vtkNew<vtkHyperTreeGridToUnstructuredGrid> filter;
    filter->SetInputDataObject(trees);
    filter->Update();
    auto* const leaves = vtkUnstructuredGrid::SafeDownCast(filter->GetOutputDataObject(0));
    Check(leaves && leaves->GetNumberOfCells() > 500, "there are leaves");
    ExpectSame(trees, leaves, masked ? "a masked hyper tree grid" : "a hyper tree grid");
  }
  ExpectSays(Trees(3, 3, false, 2), "cut into 3");
  ExpectSays(Trees(2, 1, false), "2 dimensions");
  ExpectSays(Trees(), "has no array 'other'", "other");
}

/// A block of an AMR with a value in each cell that differs from level to level.
void AddBlock(vtkOverlappingAMR* amr, unsigned int level, unsigned int index,
  const std::array<int, 3>& lo, const std::array<int, 3>& hi)
{
  const vtkAMRBox box(lo.data(), hi.data());
  double spacing[3], origin[3];
  amr->GetSpacing(level, spacing);
  vtkNew<vtkUniformGrid> block;
  for (int axis = 0; axis < 3; ++axis)
  {
    origin[axis] = amr->GetOrigin()[axis] + lo[axis] * spacing[axis];
  }
  block->SetOrigin(origin);
  block->SetSpacing(spacing);
  block->SetDimensions(hi[0] - lo[0] + 2, hi[1] - lo[1] + 2, hi[2] - lo[2] + 2);
  vtkNew<vtkDoubleArray> values;
  values->SetName("field");
  for (vtkIdType cell = 0; cell < block->GetNumberOfCells(); ++cell)
  {
    values->InsertNextValue(0.3 + 0.3 * level + 0.25 * ((cell * 31 + index) % 7) / 7.0);
  }
  block->GetCellData()->AddArray(values);
  vtkNew<vtkDoubleArray> nodes;
  nodes->SetName("nodes");
  for (vtkIdType point = 0; point < block->GetNumberOfPoints(); ++point)
  {
    double at[3];
    block->GetPoint(point, at);
    nodes->InsertNextValue(Wavy(at[0], at[1], at[2]));
  }
  block->GetPointData()->AddArray(nodes);
  amr->SetAMRBox(level, index, box);
  amr->SetDataSet(level, index, block);
}

/// Three levels, with ratios of 2 and `ratio`; cells are not yet flagged.
/// @param finest whether the data of level 2 are there, or only its box
vtkSmartPointer<vtkOverlappingAMR> Blocks(int ratio = 4, bool aligned = true, bool finest = true)
{
  const auto amr = vtkSmartPointer<vtkOverlappingAMR>::New();
  const int counts[3] = { 2, 2, 1 };
  amr->Initialize(3, counts);
  amr->SetGridDescription(VTK_XYZ_GRID);
  const double origin[3] = { 0.0, 0.0, 0.0 };
  amr->SetOrigin(origin);
  const double edges[3] = { 0.125, 0.0625, 0.0625 / ratio };
  for (unsigned int level = 0; level < 3; ++level)
  {
    const double spacing[3] = { edges[level], edges[level], edges[level] };
    amr->SetSpacing(level, spacing);
  }
  AddBlock(amr, 0, 0, { 0, 0, 0 }, { 3, 7, 7 });
  AddBlock(amr, 0, 1, { 4, 0, 0 }, { 7, 7, 7 });
  // Two that meet in the middle of a coarse cell, on both sides of the border of the coarse blocks.
  AddBlock(amr, 1, 0, { 4, 4, 4 }, { aligned ? 6 : 4, 9, 9 });
  AddBlock(amr, 1, 1, { 7, 4, 4 }, { 11, 9, 9 });
  const int lo = 8 * ratio, hi = 10 * ratio - 1;
  if (finest)
  {
    AddBlock(amr, 2, 0, { lo, 5 * ratio, 5 * ratio }, { hi, 7 * ratio - 1, 7 * ratio - 1 });
  }
  else
  {
    amr->SetAMRBox(2, 0, vtkAMRBox(lo, 5 * ratio, 5 * ratio, hi, 7 * ratio - 1, 7 * ratio - 1));
  }
  return amr;
}

/// Every cell whose centre no cell of the next level contains.
vtkUnstructuredGrid* VisibleCells(vtkOverlappingAMR* amr, Voxels& voxels)
{
  for (unsigned int level = 0; level < amr->GetNumberOfLevels(); ++level)
  {
    for (unsigned int index = 0; index < amr->GetNumberOfDataSets(level); ++index)
    {
      vtkUniformGrid* const block = amr->GetDataSet(level, index);
      for (vtkIdType cell = 0; block && cell < block->GetNumberOfCells(); ++cell)
      {
        double bounds[6];
        block->GetCellBounds(cell, bounds);
        bool visible = true;
        for (unsigned int i = 0;
             level + 1 < amr->GetNumberOfLevels() && i < amr->GetNumberOfDataSets(level + 1) &&
             amr->GetDataSet(level + 1, i);
             ++i)
        {
          double finer[6];
          amr->GetBounds(level + 1, i, finer);
          bool inside = true;
          for (int axis = 0; axis < 3; ++axis)
          {
            // A little beside the centre, where blocks may meet.
            const double at = 0.51 * bounds[2 * axis] + 0.49 * bounds[2 * axis + 1];
            inside = inside && at > finer[2 * axis] && at < finer[2 * axis + 1];
          }
          visible = visible && !inside;
        }
        if (visible)
        {
          const double low[3] = { bounds[0], bounds[2], bounds[4] };
          voxels.Add(
            low, block->GetSpacing(), block->GetCellData()->GetArray("field")->GetTuple1(cell));
        }
      }
    }
  }
  return voxels.Done();
}

void AmrIsItsVisibleCells()
{
  for (const int ratio : { 2, 4 })
  {
    const auto amr = Blocks(ratio);
    Voxels voxels;
    ExpectSame(amr, VisibleCells(amr, voxels), "AMR with a ratio of " + std::to_string(ratio));
  }
  // A block whose data nobody has hides nothing.
  const auto without = Blocks(4, true, false);
  Voxels seen;
  ExpectSame(without, VisibleCells(without, seen), "AMR whose finest data are not there");
  const auto two = Blocks();
  Check(Difference(PictureOf(without), PictureOf(two)) > 1, "level 2 is seen");
  const auto flagged = Blocks();
  vtkNew<vtkUnsignedCharArray> ghosts;
  ghosts->SetName(vtkDataSetAttributes::GhostArrayName());
  vtkUniformGrid* const first = flagged->GetDataSet(0, 0);
  ghosts->SetNumberOfTuples(first->GetNumberOfCells());
  ghosts->Fill(vtkDataSetAttributes::HIDDENCELL);
  first->GetCellData()->AddArray(ghosts);
  Check(Covered(PictureOf(flagged)) < Covered(PictureOf(two)), "hidden cells are not drawn");

  ExpectSays(Blocks(3), "one power of two");
  ExpectSays(Blocks(4, false), "covered in part");
  ExpectSays(Blocks(), "has no array 'other'", "other");
  const auto shifted = Blocks();
  shifted->SetAMRBox(2, 0, vtkAMRBox(0, 0, 0, 7, 7, 7));
  ExpectSays(shifted, "and its box");
  const auto partly = Blocks();
  partly->GetDataSet(1, 1)->GetCellData()->Initialize();
  ExpectSays(partly, "Not all blocks have the array 'field'");
}

/// Values of the steps before and after, made of those of now.
void AddNeighbours(vtkDataSetAttributes* values)
{
  vtkDataArray* const now = values->GetArray("field");
  for (const bool after : { false, true })
  {
    vtkNew<vtkDoubleArray> other;
    other->SetName(after ? "banyan: step after" : "banyan: step before");
    for (vtkIdType i = 0; i < now->GetNumberOfTuples(); ++i)
    {
      const double value = now->GetTuple1(i);
      other->InsertNextValue(after ? value * value : 0.9 * value + 0.02);
    }
    values->AddArray(other);
  }
}

void MotionInLeavesIsThatOfTheirCells()
{
  const auto trees = Trees();
  AddNeighbours(trees->GetCellData());
  vtkNew<vtkHyperTreeGridToUnstructuredGrid> filter;
  filter->SetInputDataObject(trees);
  filter->Update();
  ExpectSame(trees, filter->GetOutputDataObject(0), "motion in hyper trees", 0.7);
  Check(Difference(PictureOf(trees), PictureOf(trees, 0.7)) > 20, "motion in trees is seen");

  const auto amr = Blocks(2);
  Voxels voxels;
  vtkUnstructuredGrid* const cells = VisibleCells(amr, voxels);
  AddNeighbours(cells->GetCellData());
  const auto copy = CopyOfLeaves(amr);
  for (vtkDataSetAttributes* const block : PartsOfLeaves(copy, vtkDataObject::CELL))
  {
    AddNeighbours(block);
  }
  ExpectSame(copy, cells, "motion in AMR", 0.7);
  Check(Difference(PictureOf(amr), PictureOf(copy, 0.7)) > 20, "motion in AMR is seen");
  Check(amr->GetDataSet(1, 1)->GetCellData()->GetNumberOfArrays() == 1, "blocks stay as they were");

  Check(HaveSameLeaves(trees, Trees()), "the same trees");
  Check(!HaveSameLeaves(trees, Trees(2, 3, false)), "trees without masks are others");
  Check(HaveSameLeaves(copy, Blocks(2)), "the same blocks");
  Check(!HaveSameLeaves(copy, Blocks(2, true, false)), "a block that is missing");
}

void PointsOfAmrAreTheirs()
{
  // A linear field at points is the same on all levels: the picture of one mesh.
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetScalarModeToUsePointFieldData();
  mapper->SelectScalarArray("nodes");
  mapper->SetSampleDistanceVoxels(0.25);
  const auto amr = Blocks(2);
  vtkNew<vtkImageData> image;
  image->SetDimensions(9, 9, 9);
  image->SetSpacing(0.125, 0.125, 0.125);
  const auto linear = [](vtkDataSet* data)
  {
    vtkNew<vtkDoubleArray> nodes;
    nodes->SetName("nodes");
    for (vtkIdType point = 0; point < data->GetNumberOfPoints(); ++point)
    {
      double at[3];
      data->GetPoint(point, at);
      nodes->InsertNextValue(0.1 + 0.3 * at[0] + 0.2 * at[1] + 0.3 * at[2]);
    }
    data->GetPointData()->AddArray(nodes);
  };
  linear(image);
  for (unsigned int level = 0; level < 3; ++level)
  {
    for (unsigned int i = 0; i < amr->GetNumberOfDataSets(level); ++i)
    {
      linear(amr->GetDataSet(level, i));
    }
  }
  const double bounds[6] = { 0.0, 1.0, 0.0, 1.0, 0.0, 1.0 };
  std::vector<unsigned char> pictures[2];
  for (int i = 0; i < 2; ++i)
  {
    mapper->SetInputDataObject(i == 0 ? static_cast<vtkDataObject*>(image) : amr);
    // Edges of the finest cells: the same distance in both.
    mapper->SetSampleDistanceVoxels(i == 0 ? 0.0625 : 0.25);
    Stage stage(mapper);
    stage.LookAt(bounds);
    pictures[i] = stage.Draw();
  }
  Check(Covered(pictures[0]) > 3000, "points are seen");
  Check(Difference(pictures[0], pictures[1]) <= 1, "point data of AMR are drawn as image data");
}

} // namespace

int main()
{
  CellsOfOneSizeAreAsCellDataToPointDataHasThem();
  HyperTreesAreTheirLeaves();
  AmrIsItsVisibleCells();
  MotionInLeavesIsThatOfTheirCells();
  PointsOfAmrAreTheirs();
  return Failures();
}
