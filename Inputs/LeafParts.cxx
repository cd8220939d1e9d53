// SPDX-License-Identifier: BSD-3-Clause
#include "LeafParts.h"

#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCompositeDataIterator.h"
#include "vtkDataArray.h"
#include "vtkFieldData.h"
#include "vtkHyperTree.h"
#include "vtkHyperTreeGrid.h"
#include "vtkHyperTreeGridNonOrientedCursor.h"
#include "vtkNew.h"
#include "vtkOverlappingAMR.h"
#include "vtkUniformGrid.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cstring>

namespace banyan
{
namespace
{

std::vector<vtkUniformGrid*> BlocksOf(vtkOverlappingAMR* all)
{
  std::vector<vtkUniformGrid*> blocks;
  const auto visit = vtkSmartPointer<vtkCompositeDataIterator>::Take(all->NewIterator());
  for (visit->InitTraversal(); !visit->IsDoneWithTraversal(); visit->GoToNextItem())
  {
    if (auto* const block = vtkUniformGrid::SafeDownCast(visit->GetCurrentDataObject()))
    {
      blocks.push_back(block);
    }
  }
  return blocks;
}

bool AreSame(vtkUniformGrid* one, vtkUniformGrid* other)
{
  return std::equal(one->GetExtent(), one->GetExtent() + 6, other->GetExtent()) &&
         std::equal(one->GetOrigin(), one->GetOrigin() + 3, other->GetOrigin()) &&
         std::equal(one->GetSpacing(), one->GetSpacing() + 3, other->GetSpacing());
}

bool AreSame(vtkDataArray* one, vtkDataArray* other)
{
  if (one->GetNumberOfTuples() != other->GetNumberOfTuples())
  {
    return false;
  }
  for (vtkIdType i = 0; i < one->GetNumberOfTuples(); ++i)
  {
    if (one->GetTuple1(i) != other->GetTuple1(i))
    {
      return false;
    }
  }
  return true;
}

/// To the bit; those of one type only.
bool HaveSameBits(vtkDataArray* one, vtkDataArray* other)
{
  return one == other ||
         (one->GetDataType() == other->GetDataType() &&
           one->GetNumberOfValues() == other->GetNumberOfValues() &&
           (one->GetVoidPointer(0) == other->GetVoidPointer(0) ||
             std::memcmp(one->GetVoidPointer(0), other->GetVoidPointer(0),
               static_cast<std::size_t>(one->GetNumberOfValues()) * one->GetDataTypeSize()) == 0));
}

bool AreSame(vtkDataSet* one, vtkDataSet* other)
{
  if (one->GetNumberOfPoints() != other->GetNumberOfPoints() ||
      one->GetNumberOfCells() != other->GetNumberOfCells())
  {
    return false;
  }
  vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::SafeDownCast(one);
  vtkUnstructuredGrid* const otherGrid = vtkUnstructuredGrid::SafeDownCast(other);
  return !grid || !otherGrid || grid->GetNumberOfCells() == 0 ||
         HaveSameBits(
           grid->GetCells()->GetConnectivityArray(), otherGrid->GetCells()->GetConnectivityArray());
}

/// Compares the cells that two cursors point to, and all below them.
bool AreSame(vtkHyperTreeGridNonOrientedCursor* one, vtkHyperTreeGridNonOrientedCursor* other)
{
  if (one->IsMasked() != other->IsMasked() || one->IsLeaf() != other->IsLeaf() ||
      one->GetGlobalNodeIndex() != other->GetGlobalNodeIndex())
  {
    return false;
  }
  bool same = true;
  const int children = one->IsLeaf() || one->IsMasked() ? 0 : one->GetNumberOfChildren();
  for (int child = 0; child < children && same; ++child)
  {
    one->ToChild(static_cast<unsigned char>(child));
    other->ToChild(static_cast<unsigned char>(child));
    same = AreSame(one, other);
    one->ToParent();
    other->ToParent();
  }
  return same;
}

bool AreSame(vtkHyperTreeGrid* one, vtkHyperTreeGrid* other)
{
  if (one->GetNumberOfCells() != other->GetNumberOfCells() ||
      one->GetBranchFactor() != other->GetBranchFactor() ||
      !AreSame(one->GetXCoordinates(), other->GetXCoordinates()) ||
      !AreSame(one->GetYCoordinates(), other->GetYCoordinates()) ||
      !AreSame(one->GetZCoordinates(), other->GetZCoordinates()))
  {
    return false;
  }
  vtkHyperTreeGrid::vtkHyperTreeGridIterator first, second;
  first.Initialize(one);
  second.Initialize(other);
  vtkNew<vtkHyperTreeGridNonOrientedCursor> a, b;
  while (true)
  {
    vtkIdType numbers[2] = { -1, -1 };
    const bool more = first.GetNextTree(numbers[0]) != nullptr;
    if (more != (second.GetNextTree(numbers[1]) != nullptr) || (more && numbers[0] != numbers[1]))
    {
      return false;
    }
    if (!more)
    {
      return true;
    }
    one->InitializeNonOrientedCursor(a, numbers[0]);
    other->InitializeNonOrientedCursor(b, numbers[0]);
    if (!AreSame(a, b))
    {
      return false;
    }
  }
}

} // namespace

vtkSmartPointer<vtkDataObject> CopyOfLeaves(vtkDataObject* leaves)
{
  const auto copy = vtkSmartPointer<vtkDataObject>::Take(leaves->NewInstance());
  vtkOverlappingAMR* const from = vtkOverlappingAMR::SafeDownCast(leaves);
  vtkOverlappingAMR* const to = vtkOverlappingAMR::SafeDownCast(copy);
  if (!from)
  {
    copy->ShallowCopy(leaves);
    return copy;
  }
  to->CopyStructure(from);
  to->GetFieldData()->ShallowCopy(from->GetFieldData());
  for (unsigned int level = 0; level < from->GetNumberOfLevels(); ++level)
  {
    for (unsigned int block = 0; block < from->GetNumberOfDataSets(level); ++block)
    {
      vtkUniformGrid* const grid = from->GetDataSet(level, block);
      if (grid)
      {
        const auto own = vtkSmartPointer<vtkUniformGrid>::Take(grid->NewInstance());
        own->ShallowCopy(grid);
        to->SetDataSet(level, block, own);
      }
    }
  }
  return copy;
}

std::vector<vtkDataSetAttributes*> PartsOfLeaves(vtkDataObject* leaves, int where)
{
  std::vector<vtkDataSetAttributes*> parts;
  if (vtkHyperTreeGrid* const trees = vtkHyperTreeGrid::SafeDownCast(leaves))
  {
    if (where == vtkDataObject::CELL)
    {
      parts.push_back(trees->GetCellData());
    }
  }
  else if (vtkOverlappingAMR* const blocks = vtkOverlappingAMR::SafeDownCast(leaves))
  {
    for (vtkUniformGrid* const block : BlocksOf(blocks))
    {
      parts.push_back(block->GetAttributes(where));
    }
  }
  return parts;
}

bool HaveSameLeaves(vtkDataObject* one, vtkDataObject* other)
{
  vtkHyperTreeGrid* const trees = vtkHyperTreeGrid::SafeDownCast(one);
  vtkHyperTreeGrid* const otherTrees = vtkHyperTreeGrid::SafeDownCast(other);
  if (trees && otherTrees)
  {
    return AreSame(trees, otherTrees);
  }
  vtkOverlappingAMR* const all = vtkOverlappingAMR::SafeDownCast(one);
  vtkOverlappingAMR* const otherAll = vtkOverlappingAMR::SafeDownCast(other);
  if (!all || !otherAll)
  {
    return false;
  }
  const std::vector<vtkUniformGrid*> blocks = BlocksOf(all);
  const std::vector<vtkUniformGrid*> others = BlocksOf(otherAll);
  return std::equal(blocks.begin(), blocks.end(), others.begin(), others.end(),
    [](vtkUniformGrid* a, vtkUniformGrid* b) { return AreSame(a, b); });
}

bool HaveSameCells(vtkDataObject* one, vtkDataObject* other)
{
  vtkDataSet* const set = vtkDataSet::SafeDownCast(one);
  vtkDataSet* const otherSet = vtkDataSet::SafeDownCast(other);
  if (set && otherSet)
  {
    return AreSame(set, otherSet);
  }
  vtkCompositeDataSet* const blocks = vtkCompositeDataSet::SafeDownCast(one);
  vtkCompositeDataSet* const others = vtkCompositeDataSet::SafeDownCast(other);
  if (!blocks || !others || vtkOverlappingAMR::SafeDownCast(one))
  {
    return HaveSameLeaves(one, other);
  }
  const auto a = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  const auto b = vtkSmartPointer<vtkCompositeDataIterator>::Take(others->NewIterator());
  b->InitTraversal();
  for (a->InitTraversal(); !a->IsDoneWithTraversal(); a->GoToNextItem(), b->GoToNextItem())
  {
    if (b->IsDoneWithTraversal() ||
        !HaveSameCells(a->GetCurrentDataObject(), b->GetCurrentDataObject()))
    {
      return false;
    }
  }
  return b->IsDoneWithTraversal() != 0;
}

} // namespace banyan
