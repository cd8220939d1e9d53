// SPDX-License-Identifier: BSD-3-Clause
#include "HeldPiece.h"

#include "vtkImageData.h"
#include "vtkObjectFactory.h"

namespace banyan
{

vtkStandardNewMacro(HeldPiece);

vtkSmartPointer<HeldPiece> HeldPiece::Of(vtkDataObject* piece)
{
  auto held = vtkSmartPointer<HeldPiece>::New();
  held->Piece = piece;
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
