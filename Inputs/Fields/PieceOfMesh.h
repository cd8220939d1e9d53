// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_Fields_PieceOfMesh_h
#define banyan_Inputs_Fields_PieceOfMesh_h

#include "Fields/FieldPiece.h"

#include "Parallel/Fields/MeshField.h"

#include "vtkSmartPointer.h"

namespace banyan
{

/// An array as Core takes it; no values where it is null.
/// Throws Error when the type is none of numbers.
NodeArray NodesOf(vtkDataArray* values, int component);

/// The hexahedra of this rank, and their values.
/// @param piece its Grid is null on ranks without cells; its Array, of the points or cells of the
/// grid as Where says, may be anything there
/// @param kept gets what owns the values
/// Throws Error when it cannot be drawn.
MeshField::Piece PieceOfMesh(const FieldPiece& piece, vtkSmartPointer<vtkDataArray>& kept);

} // namespace banyan

#endif
