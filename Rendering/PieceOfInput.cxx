// SPDX-License-Identifier: BSD-3-Clause
#include "PieceOfInput.h"

#include "vtkBanyanVolumeMapper.h"

#include "Render/Bricks/ArraySamples.h"

#include "vtkAbstractMapper.h"
#include "vtkCellData.h"
#include "vtkColorTransferFunction.h"
#include "vtkCompositeDataIterator.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkOverlappingAMR.h"
#include "vtkPointData.h"
#include "vtkSmartPointer.h"
#include "vtkVolumeProperty.h"

namespace banyan
{
namespace
{

/// Of a hyper tree grid, which has cells only.
DrawnArray ArrayOf(vtkVolumeMapper* mapper, vtkHyperTreeGrid* trees)
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
    found.Array = FirstDrawable(trees->GetCellData());
  }
  return found;
}

DrawnArray ArrayOf(vtkVolumeMapper* mapper, vtkDataSet* data)
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
      found.Array = FirstDrawable(data->GetCellData());
      onCells = 1;
    }
  }
  found.Where = onCells ? ValuesOn::Cells : ValuesOn::Points;
  return found;
}

/// Blocks of one kind have the same arrays: the first one says what they are.
DrawnArray ArrayOf(vtkVolumeMapper* mapper, vtkOverlappingAMR* blocks)
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
      found = { FirstDrawable(block->GetCellData()), ValuesOn::Cells };
    }
    if (found.Array)
    {
      found.Where = found.Where == ValuesOn::Cells ? ValuesOn::Cells : ValuesOn::CellCorners;
      return found;
    }
  }
  return {};
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

int ComponentOf(vtkDataArray* array, vtkVolumeProperty* property)
{
  const int components = array->GetNumberOfComponents();
  vtkColorTransferFunction* const color = property->GetRGBTransferFunction(0);
  const bool magnitude = color->GetVectorMode() == vtkScalarsToColors::MAGNITUDE;
  const int component = components == 1 ? 0 : magnitude ? -1 : color->GetVectorComponent();
  return component >= components ? -1 : component;
}

} // namespace

DrawnArray ArrayToDraw(vtkVolumeMapper* mapper, vtkDataObject* data)
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

bool CanBeColours(vtkVolumeMapper* mapper, vtkDataObject* data, vtkDataArray* array)
{
  const int components = array ? array->GetNumberOfComponents() : 1;
  return (components == 3 || components == 4) && vtkImageData::SafeDownCast(data) &&
         mapper->GetBlendMode() == vtkVolumeMapper::COMPOSITE_BLEND;
}

FieldPiece PieceOfInput(vtkBanyanVolumeMapper* mapper, vtkVolumeProperty* property)
{
  vtkDataObject* const data = mapper->GetDataObjectInput();
  FieldPiece piece = PieceOfData(data);
  piece.MeshTolerance = mapper->GetMeshTolerance();
  piece.KeepsCellValues = mapper->GetCellValues() == 1;
  if (!piece.HasData() || !piece.Problem.empty())
  {
    return piece;
  }
  const DrawnArray drawn = ArrayToDraw(mapper, data);
  if (!drawn.Array)
  {
    piece.Problem = MissingArray(mapper);
    return piece;
  }
  SetArray(piece, drawn);
  const bool colours =
    property->GetIndependentComponents() == 0 && CanBeColours(mapper, data, drawn.Array);
  piece.Component = colours ? SampleArray::Colours : ComponentOf(drawn.Array, property);
  return piece;
}

} // namespace banyan
