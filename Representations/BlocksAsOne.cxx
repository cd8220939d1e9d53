// SPDX-License-Identifier: BSD-3-Clause
#include "BlocksAsOne.h"

#include "GridOfHyperTrees.h"
#include "LeafParts.h"
#include "MergedBlocks.h"
#include "MotionEnhancement.h"
#include "StepWindow.h"
#include "vtkBanyanDeferred.h"

#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkOverlappingAMR.h"
#include "vtkPointData.h"
#include "vtkUnstructuredGrid.h"

namespace banyan
{
namespace
{

/// Adds an array of another step by reference, under another name.
void AddRenamed(vtkDataArray* there, const char* name, vtkDataSetAttributes* to)
{
  if (there)
  {
    const auto renamed = vtkSmartPointer<vtkDataArray>::Take(there->NewInstance());
    renamed->ShallowCopy(there);
    renamed->SetName(name);
    to->AddArray(renamed);
  }
}

} // namespace

vtkSmartPointer<vtkDataObject> BlocksAsOne(vtkDataObject* data, MergedBlocks& merged)
{
  vtkCompositeDataSet* const blocks = vtkCompositeDataSet::SafeDownCast(data);
  if (!blocks || vtkOverlappingAMR::SafeDownCast(data))
  {
    return data;
  }
  std::vector<vtkSmartPointer<vtkDataSet>> sets;
  const auto visit = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (visit->InitTraversal(); !visit->IsDoneWithTraversal(); visit->GoToNextItem())
  {
    vtkSmartPointer<vtkDataSet> block = vtkDataSet::SafeDownCast(visit->GetCurrentDataObject());
    if (auto* const trees = vtkHyperTreeGrid::SafeDownCast(visit->GetCurrentDataObject()))
    {
      block = GridOfHyperTrees(trees).GetPointer();
    }
    if (block && block->GetNumberOfPoints() > 0)
    {
      sets.push_back(block);
    }
  }
  const bool image = sets.size() == 1 && vtkImageData::SafeDownCast(sets.front());
  return sets.empty() ? nullptr
         : image      ? vtkSmartPointer<vtkDataObject>(merged.Of(sets))
                      : vtkSmartPointer<vtkDataObject>(merged.AsOne(sets));
}

void BoundsOf(vtkDataObject* data, double bounds[6])
{
  vtkMath::UninitializeBounds(bounds);
  if (!data || data->GetNumberOfElements(vtkDataObject::CELL) == 0)
  {
    return;
  }
  if (auto* const set = vtkDataSet::SafeDownCast(data))
  {
    set->GetBounds(bounds);
  }
  else if (auto* const trees = vtkHyperTreeGrid::SafeDownCast(data))
  {
    trees->GetBounds(bounds);
  }
  else if (auto* const blocks = vtkOverlappingAMR::SafeDownCast(data))
  {
    blocks->GetBounds(bounds);
  }
}

int AddNeighbours(
  vtkDataArray* array, const StepWindow& steps, vtkDataSet* piece, MergedBlocks& merged)
{
  vtkImageData* const image = vtkImageData::SafeDownCast(piece);
  const vtkBanyanDeferred::Handle* const handle = array ? vtkBanyanDeferred::From(array) : nullptr;
  const bool fromSeries = handle && image && vtkBanyanDeferred::LiesOnSeries(image, *handle);
  if (!array || !array->GetName() || fromSeries)
  {
    return 0;
  }
  int others = 0;
  const int where = piece->GetPointData()->GetArray(array->GetName()) == array
                      ? vtkDataObject::POINT
                      : vtkDataObject::CELL;
  const auto add = [&](vtkDataObject* step, const char* name)
  {
    if (!step)
    {
      return;
    }
    vtkSmartPointer<vtkDataObject> data;
    try
    {
      data = steps.Now() && HaveSameCells(steps.Now(), step) ? BlocksAsOne(step, merged) : nullptr;
    }
    catch (const std::exception&)
    {
      data = nullptr;
    }
    others += data ? 0 : 1;
    vtkDataSetAttributes* const values = data ? data->GetAttributes(where) : nullptr;
    AddRenamed(
      values ? values->GetArray(array->GetName()) : nullptr, name, piece->GetAttributes(where));
  };
  add(steps.Previous(), MotionEnhancement::PreviousName());
  add(steps.Next(), MotionEnhancement::NextName());
  return others;
}

int AddNeighboursToLeaves(vtkDataArray* array, const StepWindow& steps, vtkDataObject* leaves)
{
  int others = 0;
  const auto add = [&](vtkDataObject* step, const char* name)
  {
    if (!step)
    {
      return;
    }
    if (!HaveSameLeaves(leaves, step))
    {
      ++others;
      return;
    }
    for (const int where : { vtkDataObject::POINT, vtkDataObject::CELL })
    {
      const std::vector<vtkDataSetAttributes*> there = PartsOfLeaves(step, where);
      const std::vector<vtkDataSetAttributes*> here = PartsOfLeaves(leaves, where);
      for (std::size_t part = 0; part < here.size(); ++part)
      {
        AddRenamed(there[part]->GetArray(array->GetName()), name, here[part]);
      }
    }
  };
  if (array && array->GetName())
  {
    add(steps.Previous(), MotionEnhancement::PreviousName());
    add(steps.Next(), MotionEnhancement::NextName());
  }
  return others;
}

} // namespace banyan
