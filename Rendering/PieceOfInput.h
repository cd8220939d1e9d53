// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_PieceOfInput_h
#define banyan_Rendering_PieceOfInput_h

#include "FieldPiece.h"

class vtkBanyanVolumeMapper;
class vtkVolumeProperty;

namespace banyan
{

/// The array that a mapper draws.
struct DrawnArray
{
  vtkDataArray* Array = nullptr; ///< null if there is none; of blocks: the first one's
  ValuesOn Where = ValuesOn::Points;
};

/// The array that the scalar mode of a mapper selects; with the default mode the active scalars, or
/// the first array of numbers: that of points before that of cells.
/// @param data vtkDataSet, vtkHyperTreeGrid or vtkOverlappingAMR; may be null
DrawnArray ArrayToDraw(vtkBanyanVolumeMapper* mapper, vtkDataObject* data);

/// What the input of a mapper gives this rank to draw, as it is: nothing is converted or decoded.
FieldPiece PieceOfInput(vtkBanyanVolumeMapper* mapper, vtkVolumeProperty* property);

/// Of a hyper tree grid or AMR, as it is: `bounds` itself.
double* BoundsOfLeaves(vtkDataObject* data, double* bounds);

} // namespace banyan

#endif
