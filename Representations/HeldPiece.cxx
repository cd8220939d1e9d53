// SPDX-License-Identifier: BSD-3-Clause
#include "HeldPiece.h"

#include "vtkCellArray.h"
#include "vtkImageData.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPoints.h"

namespace banyan
{

vtkStandardNewMacro(HeldPiece);

vtkSmartPointer<HeldPiece> HeldPiece::Of(vtkDataObject* piece, const double* bounds)
{
  auto held = vtkSmartPointer<HeldPiece>::New();
  held->Piece = piece;
  if (bounds && vtkMath::AreBoundsInitialized(bounds))
  {
    vtkNew<vtkPoints> corners;
    corners->SetDataType(VTK_DOUBLE);
    corners->InsertNextPoint(bounds[0], bounds[2], bounds[4]);
    corners->InsertNextPoint(bounds[1], bounds[3], bounds[5]);
    vtkNew<vtkCellArray> vertices; // who puts meshes together may leave out points without cells
    const vtkIdType both[2] = { 0, 1 };
    vertices->InsertNextCell(2, both);
    held->SetPoints(corners);
    held->SetVerts(vertices);
  }
  return held;
}

vtkSmartPointer<vtkDataObject> HeldPiece::In(vtkDataObject* object)
{
  auto* const held = HeldPiece::SafeDownCast(object);
  return held && held->Piece ? held->Piece
                             : vtkSmartPointer<vtkDataObject>(vtkSmartPointer<vtkImageData>::New());
}

void HeldPiece::ShallowCopy(vtkDataObject* source)
{
  this->Superclass::ShallowCopy(source);
  auto* const held = HeldPiece::SafeDownCast(source);
  this->Piece = held ? held->Piece : nullptr;
}

} // namespace banyan
