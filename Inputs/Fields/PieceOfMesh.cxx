// SPDX-License-Identifier: BSD-3-Clause
#include "Fields/PieceOfMesh.h"

#include "HexMeshOfGrid.h"

#include "vtkDataArray.h"
#include "vtkSetGet.h"
#include "vtkUnstructuredGrid.h"

namespace banyan
{

NodeArray NodesOf(vtkDataArray* values, int component)
{
  NodeArray nodes;
  nodes.Component = component;
  if (!values)
  {
    return nodes;
  }
  nodes.Values = values->GetVoidPointer(0);
  nodes.Components = values->GetNumberOfComponents();
  switch (values->GetDataType())
  {
    vtkTemplateMacro(nodes.Type = ScalarTypeOf<VTK_TT>());
    default:
      throw Error(std::string("The array to draw has the type ") + values->GetDataTypeAsString() +
                  ", which cannot be drawn.");
  }
  return nodes;
}

MeshField::Piece PieceOfMesh(const FieldPiece& piece, vtkSmartPointer<vtkDataArray>& kept)
{
  MeshField::Piece mesh;
  OtherCells others;
  mesh.Mesh = HexMeshOf(piece.Grid, &others);
  mesh.Where = piece.Where;
  mesh.OtherCells = others.Count > 0 ? others.Text() : std::string();
  if (mesh.Mesh.CellCount > 0)
  {
    kept = piece.Where == ValuesOn::Cells ? ValuesOfCells(piece.Grid, piece.Array).GetPointer()
                                          : piece.Array;
    mesh.Values = NodesOf(kept, piece.Component);
  }
  return mesh;
}

} // namespace banyan
