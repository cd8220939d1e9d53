// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_PieceOfInput_h
#define banyan_Rendering_PieceOfInput_h

#include "Fields/FieldPiece.h"

class vtkBanyanVolumeMapper;
class vtkDataArray;
class vtkDataObject;
class vtkVolumeMapper;
class vtkVolumeProperty;

namespace banyan
{

/// The array that the scalar mode of a mapper selects; with the default mode the active scalars, or
/// the first array of numbers: that of points before that of cells.
/// @param data vtkDataSet, vtkHyperTreeGrid or vtkOverlappingAMR; may be null
DrawnArray ArrayToDraw(vtkVolumeMapper* mapper, vtkDataObject* data);

/// Whether an array of some data can be drawn as the colours that it has: three or four components
/// on points of image data, composited.
/// @param array of the data; may be null
bool CanBeColours(vtkVolumeMapper* mapper, vtkDataObject* data, vtkDataArray* array);

/// What the input of a mapper gives this rank to draw: see PieceOfData.
FieldPiece PieceOfInput(vtkBanyanVolumeMapper* mapper, vtkVolumeProperty* property);

} // namespace banyan

#endif
