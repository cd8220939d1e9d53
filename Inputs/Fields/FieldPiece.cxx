// SPDX-License-Identifier: BSD-3-Clause
#include "Fields/FieldPiece.h"

#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkDataSetAttributes.h"
#include "vtkExplicitStructuredGrid.h"
#include "vtkHyperTreeGrid.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkOverlappingAMR.h"
#include "vtkRectilinearGrid.h"
#include "vtkStructuredGrid.h"
#include "vtkUnstructuredGrid.h"

#include <cstring>

namespace banyan
{
namespace
{

bool HasCells(vtkDataObject* data)
{
  if (vtkDataSet* const set = vtkDataSet::SafeDownCast(data))
  {
    // Points alone are nothing that a ray meets.
    return vtkImageData::SafeDownCast(set) ? set->GetNumberOfPoints() > 0
                                           : set->GetNumberOfCells() > 0;
  }
  return data && data->GetNumberOfElements(vtkDataObject::CELL) > 0;
}

/// Grids of cells in three dimensions that are neither images nor lists of cells.
vtkDataSet* CurvedGrid(vtkDataObject* data)
{
  const bool is = vtkStructuredGrid::SafeDownCast(data) || vtkRectilinearGrid::SafeDownCast(data) ||
                  vtkExplicitStructuredGrid::SafeDownCast(data);
  return is ? vtkDataSet::SafeDownCast(data) : nullptr;
}

/// What is no error of VTK's own, such as blocks that come from an object instead of a filter.
std::string WrongType(vtkDataObject* data)
{
  if (vtkImageData::SafeDownCast(data) || vtkUnstructuredGrid::SafeDownCast(data) ||
      CurvedGrid(data) || vtkHyperTreeGrid::SafeDownCast(data) ||
      vtkOverlappingAMR::SafeDownCast(data))
  {
    return {};
  }
  return std::string("Data of the type ") + data->GetClassName() + " cannot be drawn: " +
         (vtkCompositeDataSet::SafeDownCast(data)
             ? "make one unstructured grid of its blocks ('Merge Blocks', vtkAppendFilter)."
             : "use 'Resample To Image'.");
}

std::string WrongPlace(const FieldPiece& piece)
{
  const std::string array = "The array '" + piece.ArrayName + "' ";
  if (piece.Image && piece.Where == ValuesOn::Cells)
  {
    return array + "lies on cells, and image data are drawn from point data: apply 'Cell Data to "
                   "Point Data'.";
  }
  const vtkIdType values = piece.Array->GetNumberOfTuples();
  vtkDataSet* const set = piece.Image ? static_cast<vtkDataSet*>(piece.Image) : piece.Cells();
  const vtkIdType expected = !set                              ? values
                             : piece.Where == ValuesOn::Points ? set->GetNumberOfPoints()
                                                               : set->GetNumberOfCells();
  return values == expected ? std::string()
                            : array + "has " + std::to_string(values) + " values for " +
                                std::to_string(expected) + " points or cells.";
}

} // namespace

vtkDataSet* FieldPiece::Cells() const
{
  return this->Grid ? this->Grid : this->Curved;
}

vtkDataArray* FirstDrawable(vtkDataSetAttributes* attributes)
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

FieldPiece PieceOfData(vtkDataObject* data)
{
  FieldPiece piece;
  if (!HasCells(data))
  {
    return piece;
  }
  piece.Problem = WrongType(data);
  piece.Image = vtkImageData::SafeDownCast(data);
  piece.Grid = vtkUnstructuredGrid::SafeDownCast(data);
  piece.Curved = CurvedGrid(data);
  piece.Leaves =
    piece.Image || piece.Grid || piece.Curved || !piece.Problem.empty() ? nullptr : data;
  return piece;
}

void SetArray(FieldPiece& piece, const DrawnArray& drawn)
{
  piece.Array = drawn.Array;
  piece.Where = drawn.Where;
  piece.ArrayName = drawn.Array->GetName() ? drawn.Array->GetName() : "";
  piece.Problem = WrongPlace(piece);
  if (piece.Leaves && piece.ArrayName.empty())
  {
    piece.Problem = "The array to draw has no name: blocks and trees need one. Give it a name.";
  }
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
