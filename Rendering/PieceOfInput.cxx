// SPDX-License-Identifier: BSD-3-Clause
#include "PieceOfInput.h"

#include "vtkBanyanVolumeMapper.h"

#include "vtkAbstractMapper.h"
#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
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
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVolumeProperty.h"

#include <cstring>

namespace banyan
{
namespace
{

vtkDataArray* FirstOf(vtkDataSetAttributes* attributes)
{
  if (vtkDataArray* const scalars = attributes->GetScalars())
  {
    return scalars;
  }
  for (int i = 0; i < attributes->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* const array = attributes->GetArray(i);
    if (array && (!array->GetName() ||
                   std::strcmp(array->GetName(), vtkDataSetAttributes::GhostArrayName()) != 0))
    {
      return array;
    }
  }
  return nullptr;
}

/// Of a hyper tree grid, which has cells only.
DrawnArray ArrayOf(vtkBanyanVolumeMapper* mapper, vtkHyperTreeGrid* trees)
{
  const int mode = mapper->GetScalarMode();
  const bool named =
    mode == VTK_SCALAR_MODE_USE_CELL_FIELD_DATA || mode == VTK_SCALAR_MODE_USE_POINT_FIELD_DATA;
  DrawnArray found;
  found.Where = ValuesOn::Cells;
  if (named)
  {
    found.Array = mode == VTK_SCALAR_MODE_USE_CELL_FIELD_DATA
                    ? trees->GetCellData()->GetArray(mapper->GetArrayName())
                    : nullptr;
  }
  else
  {
    found.Array = FirstOf(trees->GetCellData());
  }
  return found;
}

DrawnArray ArrayOf(vtkBanyanVolumeMapper* mapper, vtkDataSet* data)
{
  int onCells = 0;
  DrawnArray found;
  found.Array = vtkAbstractMapper::GetScalars(data, mapper->GetScalarMode(),
    mapper->GetArrayAccessMode(), mapper->GetArrayId(), mapper->GetArrayName(), onCells);
  if (!found.Array && mapper->GetScalarMode() == VTK_SCALAR_MODE_DEFAULT)
  {
    found.Array = data->GetPointData()->GetArray(0);
    onCells = 0;
    if (!found.Array && !vtkImageData::SafeDownCast(data))
    {
      found.Array = FirstOf(data->GetCellData());
      onCells = 1;
    }
  }
  found.Where = onCells ? ValuesOn::Cells : ValuesOn::Points;
  return found;
}

/// Blocks of one kind have the same arrays: the first one says what they are.
DrawnArray ArrayOf(vtkBanyanVolumeMapper* mapper, vtkOverlappingAMR* blocks)
{
  const auto visit = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (visit->InitTraversal(); !visit->IsDoneWithTraversal(); visit->GoToNextItem())
  {
    vtkDataSet* const block = vtkDataSet::SafeDownCast(visit->GetCurrentDataObject());
    if (!block || block->GetNumberOfCells() == 0)
    {
      continue;
    }
    DrawnArray found = ArrayOf(mapper, block);
    if (!found.Array && mapper->GetScalarMode() == VTK_SCALAR_MODE_DEFAULT)
    {
      found = { FirstOf(block->GetCellData()), ValuesOn::Cells };
    }
    if (found.Array)
    {
      found.Where = found.Where == ValuesOn::Cells ? ValuesOn::Cells : ValuesOn::CellCorners;
      return found;
    }
  }
  return {};
}

bool HasCells(vtkDataObject* data)
{
  if (vtkDataSet* const set = vtkDataSet::SafeDownCast(data))
  {
    // Points alone are nothing that a ray meets.
    return vtkUnstructuredGrid::SafeDownCast(set) ? set->GetNumberOfCells() > 0
                                                  : set->GetNumberOfPoints() > 0;
  }
  return data && data->GetNumberOfElements(vtkDataObject::CELL) > 0;
}

std::string MissingArray(vtkVolumeMapper* mapper)
{
  const char* const name = mapper->GetArrayName();
  if (!name || !*name)
  {
    return "The data has no array to draw: select one in 'Coloring'.";
  }
  const int mode = mapper->GetScalarMode();
  const char* const where = mode == VTK_SCALAR_MODE_USE_POINT_FIELD_DATA  ? " on points"
                            : mode == VTK_SCALAR_MODE_USE_CELL_FIELD_DATA ? " on cells"
                                                                          : "";
  return "The data has no array '" + std::string(name) + "' of numbers" + where + " to draw.";
}

/// What is no error of VTK's own, such as blocks that come from an object instead of a filter.
std::string WrongType(vtkDataObject* data)
{
  if (vtkImageData::SafeDownCast(data) || vtkUnstructuredGrid::SafeDownCast(data) ||
      vtkHyperTreeGrid::SafeDownCast(data) || vtkOverlappingAMR::SafeDownCast(data))
  {
    return {};
  }
  return std::string("Data of the type ") + data->GetClassName() + " cannot be drawn: " +
         (vtkCompositeDataSet::SafeDownCast(data)
             ? "make one unstructured grid of its blocks ('Merge Blocks', vtkAppendFilter)."
             : "use 'Resample To Image'.");
}

std::string WrongPlace(const DrawnArray& drawn, vtkDataObject* data)
{
  const std::string array =
    "The array '" + std::string(drawn.Array->GetName() ? drawn.Array->GetName() : "") + "' ";
  if (vtkImageData::SafeDownCast(data) && drawn.Where == ValuesOn::Cells)
  {
    return array + "lies on cells, and image data are drawn from point data: apply 'Cell Data to "
                   "Point Data'.";
  }
  vtkDataSet* const set = vtkDataSet::SafeDownCast(data);
  const vtkIdType expected = !set                              ? drawn.Array->GetNumberOfTuples()
                             : drawn.Where == ValuesOn::Points ? set->GetNumberOfPoints()
                                                               : set->GetNumberOfCells();
  if (drawn.Array->GetNumberOfTuples() != expected)
  {
    return array + "has " + std::to_string(drawn.Array->GetNumberOfTuples()) + " values for " +
           std::to_string(expected) + " points or cells.";
  }
  return {};
}

int ComponentOf(vtkDataArray* array, vtkVolumeProperty* property)
{
  const int components = array->GetNumberOfComponents();
  vtkColorTransferFunction* const color = property->GetRGBTransferFunction(0);
  const bool magnitude = color->GetVectorMode() == vtkScalarsToColors::MAGNITUDE;
  const int component = components == 1 ? 0 : magnitude ? -1 : color->GetVectorComponent();
  return component >= components ? -1 : component;
}

} // namespace

DrawnArray ArrayToDraw(vtkBanyanVolumeMapper* mapper, vtkDataObject* data)
{
  if (vtkHyperTreeGrid* const trees = vtkHyperTreeGrid::SafeDownCast(data))
  {
    return ArrayOf(mapper, trees);
  }
  if (vtkOverlappingAMR* const blocks = vtkOverlappingAMR::SafeDownCast(data))
  {
    return ArrayOf(mapper, blocks);
  }
  vtkDataSet* const set = vtkDataSet::SafeDownCast(data);
  return set ? ArrayOf(mapper, set) : DrawnArray{};
}

FieldPiece PieceOfInput(vtkBanyanVolumeMapper* mapper, vtkVolumeProperty* property)
{
  FieldPiece piece;
  piece.Mesh.Tolerance = mapper->GetMeshTolerance();
  piece.Mesh.Sampling.Tolerance = mapper->GetMeshSamplingTolerance();
  piece.Mesh.Sampling.MostCubes = mapper->GetMeshSamplingBoxes();
  piece.Mesh.Sampling.Watch = [mapper](double part)
  {
    mapper->UpdateProgress(part);
    return mapper->GetAbortExecute() == 0;
  };
  vtkDataObject* const data = mapper->GetDataObjectInput();
  if (!HasCells(data))
  {
    return piece;
  }
  piece.Image = vtkImageData::SafeDownCast(data);
  piece.Grid = vtkUnstructuredGrid::SafeDownCast(data);
  piece.Leaves = piece.Image || piece.Grid ? nullptr : data;
  piece.Problem = WrongType(data);
  if (!piece.Problem.empty())
  {
    piece.Leaves = nullptr;
    return piece;
  }
  const DrawnArray drawn = ArrayToDraw(mapper, data);
  if (!drawn.Array)
  {
    piece.Problem = MissingArray(mapper);
    return piece;
  }
  piece.Array = drawn.Array;
  piece.Where = drawn.Where;
  piece.ArrayName = drawn.Array->GetName() ? drawn.Array->GetName() : "";
  piece.Problem = WrongPlace(drawn, data);
  if (piece.Leaves && piece.ArrayName.empty())
  {
    piece.Problem = "The array to draw has no name: blocks and trees need one. Give it a name.";
  }
  piece.Component = ComponentOf(drawn.Array, property);
  return piece;
}

double* BoundsOfLeaves(vtkDataObject* data, double* bounds)
{
  vtkMath::UninitializeBounds(bounds);
  if (vtkHyperTreeGrid* const trees = vtkHyperTreeGrid::SafeDownCast(data))
  {
    trees->GetBounds(bounds);
  }
  else if (vtkOverlappingAMR* const blocks = vtkOverlappingAMR::SafeDownCast(data))
  {
    if (blocks->GetAMRInfo()) // none before Initialize()
    {
      blocks->GetBounds(bounds);
    }
  }
  return bounds;
}

} // namespace banyan
