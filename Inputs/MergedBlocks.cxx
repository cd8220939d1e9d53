// SPDX-License-Identifier: BSD-3-Clause
#include "MergedBlocks.h"

#include "CellArrays.h"

#include "vtkAppendFilter.h"
#include "vtkCellArray.h"
#include "vtkCellData.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDataArrayRange.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <string>

namespace banyan
{
namespace
{

using Blocks = std::vector<vtkSmartPointer<vtkDataSet>>;

Hash128 Continue(const Hash128& before, const void* bytes, std::size_t count)
{
  return HashOf(bytes, count, before.Low ^ before.High);
}

Hash128 Continue(const Hash128& before, vtkDataArray* array)
{
  const auto count = static_cast<std::size_t>(array->GetNumberOfValues());
  return Continue(
    before, array->GetVoidPointer(0), count * static_cast<std::size_t>(array->GetDataTypeSize()));
}

/// Which arrays there are, and what they are for.
std::string Names(vtkDataSetAttributes* attributes)
{
  std::string text;
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const array = attributes->GetAbstractArray(i);
    text += array->GetName() ? array->GetName() : "";
    for (const int fact :
      { array->GetDataType(), array->GetNumberOfComponents(), attributes->IsArrayAnAttribute(i) })
    {
      text += '\n' + std::to_string(fact);
    }
    text += '\n';
  }
  return text;
}

bool HasPolyhedra(vtkUnstructuredGrid* grid)
{
  const auto types = PlainCellTypesOf(grid);
  const auto values = vtk::DataArrayValueRange<1>(types.GetPointer());
  return std::find(values.begin(), values.end(), VTK_POLYHEDRON) != values.end();
}

/// Makes a key of the cells and of the names of arrays; false where something is no unstructured
/// grid, or has faces of polyhedra, which no key tells apart.
bool KeyOf(const Blocks& blocks, Hash128& key)
{
  key = {};
  for (const auto& block : blocks)
  {
    vtkUnstructuredGrid* const grid = vtkUnstructuredGrid::SafeDownCast(block);
    if (!grid || !grid->GetPoints() || grid->GetNumberOfCells() == 0 || HasPolyhedra(grid))
    {
      return false;
    }
    const std::string facts = std::to_string(grid->GetNumberOfPoints()) + '\n' +
                              std::to_string(grid->GetPoints()->GetDataType()) + '\n' +
                              std::to_string(grid->GetNumberOfCells()) + '\n' +
                              Names(grid->GetPointData()) + "cells\n" + Names(grid->GetCellData());
    key = Continue(key, facts.data(), facts.size());
    key = Continue(key, CellTypesOf(grid));
    key = Continue(key, grid->GetCells()->GetOffsetsArray());
    key = Continue(key, grid->GetCells()->GetConnectivityArray());
  }
  return true;
}

/// Copies the tuples of all blocks, one behind the other, into an array like `kept`.
template <class ArrayOf>
vtkSmartPointer<vtkAbstractArray> Joined(
  vtkAbstractArray* kept, const Blocks& blocks, const ArrayOf& arrayOf)
{
  auto joined = vtkSmartPointer<vtkAbstractArray>::Take(kept->NewInstance());
  joined->SetName(kept->GetName());
  joined->SetNumberOfComponents(kept->GetNumberOfComponents());
  joined->CopyComponentNames(kept);
  vtkIdType count = 0;
  for (const auto& block : blocks)
  {
    count += arrayOf(block)->GetNumberOfTuples();
  }
  joined->SetNumberOfTuples(count);
  vtkIdType next = 0;
  for (const auto& block : blocks)
  {
    vtkAbstractArray* const from = arrayOf(block);
    joined->InsertTuples(next, from->GetNumberOfTuples(), 0, from);
    next += from->GetNumberOfTuples();
  }
  return joined;
}

/// The arrays that merged blocks have, with the values of these; false where a block has not got
/// one.
bool JoinArrays(
  vtkDataSetAttributes* kept, const Blocks& blocks, int where, vtkDataSetAttributes* to)
{
  for (int i = 0; i < kept->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const array = kept->GetAbstractArray(i);
    for (const auto& block : blocks)
    {
      vtkAbstractArray* const from =
        array->GetName() ? block->GetAttributes(where)->GetAbstractArray(array->GetName())
                         : nullptr;
      if (!from || from->GetNumberOfTuples() != block->GetNumberOfElements(where))
      {
        return false;
      }
    }
    const int number = to->AddArray(Joined(array, blocks,
      [&](vtkDataSet* block)
      { return block->GetAttributes(where)->GetAbstractArray(array->GetName()); }));
    const int attribute = kept->IsArrayAnAttribute(i);
    if (attribute >= 0)
    {
      to->SetActiveAttribute(number, attribute);
    }
  }
  return true;
}

/// The kept cells with points and values of the blocks; null where they do not fit.
vtkSmartPointer<vtkUnstructuredGrid> WithValues(vtkUnstructuredGrid* kept, const Blocks& blocks)
{
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  grid->CopyStructure(kept);
  vtkNew<vtkPoints> points;
  const auto places = Joined(kept->GetPoints()->GetData(), blocks,
    [](vtkDataSet* block)
    { return vtkUnstructuredGrid::SafeDownCast(block)->GetPoints()->GetData(); });
  points->SetData(vtkDataArray::SafeDownCast(places));
  grid->SetPoints(points);
  const bool fit =
    JoinArrays(kept->GetPointData(), blocks, vtkDataObject::POINT, grid->GetPointData()) &&
    JoinArrays(kept->GetCellData(), blocks, vtkDataObject::CELL, grid->GetCellData());
  return fit ? grid : nullptr;
}

void KeepArrays(vtkDataSetAttributes* from, vtkDataSetAttributes* to)
{
  for (int i = 0; i < from->GetNumberOfArrays(); ++i)
  {
    vtkAbstractArray* const array = from->GetAbstractArray(i);
    const auto empty = vtkSmartPointer<vtkAbstractArray>::Take(array->NewInstance());
    empty->SetName(array->GetName());
    empty->SetNumberOfComponents(array->GetNumberOfComponents());
    empty->CopyComponentNames(array);
    const int number = to->AddArray(empty);
    if (from->IsArrayAnAttribute(i) >= 0)
    {
      to->SetActiveAttribute(number, from->IsArrayAnAttribute(i));
    }
  }
}

/// Copies what the next steps need, without values.
vtkSmartPointer<vtkUnstructuredGrid> CellsAndNames(vtkUnstructuredGrid* grid)
{
  auto kept = vtkSmartPointer<vtkUnstructuredGrid>::New();
  kept->CopyStructure(grid);
  vtkNew<vtkPoints> none;
  none->SetDataType(grid->GetPoints()->GetDataType());
  kept->SetPoints(none);
  KeepArrays(grid->GetPointData(), kept->GetPointData());
  KeepArrays(grid->GetCellData(), kept->GetCellData());
  return kept;
}

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> MergedBlocks::Of(const Blocks& blocks)
{
  Hash128 key;
  const bool keeps = blocks.size() > 1 && KeyOf(blocks, key);
  if (keeps && this->Kept && key == this->Key)
  {
    if (auto grid = WithValues(this->Kept, blocks))
    {
      return grid;
    }
  }
  vtkNew<vtkAppendFilter> append;
  for (const auto& block : blocks)
  {
    append->AddInputData(block);
  }
  append->Update();
  vtkSmartPointer<vtkUnstructuredGrid> grid = append->GetOutput();
  ++this->Merged;
  this->Kept = keeps ? CellsAndNames(grid) : nullptr;
  this->Key = key;
  return grid;
}

vtkSmartPointer<vtkDataSet> MergedBlocks::AsOne(const Blocks& blocks)
{
  return blocks.size() == 1 ? blocks[0] : vtkSmartPointer<vtkDataSet>(this->Of(blocks));
}

} // namespace banyan
