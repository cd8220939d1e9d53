// SPDX-License-Identifier: BSD-3-Clause
#include "MeshField.h"

#include "vtkDataArray.h"
#include "vtkSetGet.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Cells per axis of the bricks that meshes are cut into.
constexpr int MeshBrickCells = 32;

Hash128 HashOfMesh(const HexMesh& mesh)
{
  const auto points = static_cast<std::size_t>(3 * mesh.PointCount) * SizeOf(mesh.PointType);
  const auto ids = static_cast<std::size_t>(8 * mesh.CellCount) * SizeOf(mesh.IdType);
  const Hash128 first = HashOf(mesh.Points, points, static_cast<std::uint64_t>(mesh.PointType));
  return HashOf(mesh.Connectivity, ids, first.Low ^ first.High);
}

/// Throws Error on all ranks when one has failed: those that have not say nothing.
void StopTogether(Communicator& communicator, const std::string& failure)
{
  if (!AgreeOnError(communicator, failure).empty())
  {
    throw Error(failure);
  }
}

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

/// Collective: what the ranks that have cells say values belong to.
ValuesOn Agreed(Communicator& communicator, ValuesOn where, bool cells)
{
  const double mine = static_cast<double>(where);
  const double high = AllMax(communicator, cells ? mine : -1.0);
  const double low = -AllMax(communicator, cells ? -mine : -3.0);
  if (low < high)
  {
    throw Error("The array to draw lies on points on one rank, and on cells on another one.");
  }
  return static_cast<ValuesOn>(static_cast<int>(std::max(high, 0.0)));
}

} // namespace

void MeshField::Update(Communicator& communicator, vtkUnstructuredGrid* grid, vtkDataArray* values,
  ValuesOn where, int component, const MeshOptions& options)
{
  HexMesh piece;
  NodeArray nodes;
  OtherCells others;
  vtkSmartPointer<vtkDataArray> kept;
  std::string failure;
  try
  {
    piece = HexMeshOf(grid, &others);
    if (piece.CellCount > 0)
    {
      kept = where == ValuesOn::Cells ? ValuesOfCells(grid, values).GetPointer() : values;
      nodes = NodesOf(kept, component);
    }
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  StopTogether(communicator, failure);
  if (AllMax(communicator, static_cast<double>(piece.CellCount)) == 0.0)
  {
    StopTogether(communicator,
      others.Count == 0 ? failure
                        : "The mesh has no hexahedra or voxels, but " + others.Text() + ".");
  }
  if (piece.CellCount == 0)
  {
    piece.PointCount = 0;
  }
  where = Agreed(communicator, where, piece.CellCount > 0);
  this->Source.reset();
  const bool sameMesh = this->SameMesh(communicator, piece);
  if (!sameMesh || !(options == this->Options))
  {
    this->Mesh.reset();
    this->Options = options;
    this->Mesh = std::make_unique<SharedMesh>(communicator, piece, where, MeshBrickCells, options);
    this->Describe(communicator, others);
  }
  this->Source = this->Mesh->Field(
    communicator, nodes, where == ValuesOn::Cells ? piece.CellCount : piece.PointCount, where);
}

void MeshField::Describe(Communicator& communicator, const OtherCells& others)
{
  const SharedMesh::Facts& facts = this->Mesh->About();
  std::string note;
  if (others.Count > 0)
  {
    note = "Only hexahedra and voxels are drawn, without " + others.Text() + ". ";
  }
  if (facts.TangledCells > 0)
  {
    note += std::to_string(facts.TangledCells) +
            " hexahedra are turned inside out at a corner, cell " +
            std::to_string(facts.FirstTangledCell) + " first: what is drawn in them means little. ";
  }
  if (facts.KeptCoarse > 0)
  {
    note += "The mesh is no octree and is drawn from " + std::to_string(facts.Boxes) + " boxes; " +
            std::to_string(facts.KeptCoarse) +
            " places are coarser than they should be: allow more boxes, 'Mesh Sampling Boxes' "
            "(MeshSamplingBoxes). ";
  }
  if (!this->Mesh->WhyNotShared().empty())
  {
    note += "Each rank holds the whole mesh for itself: " + this->Mesh->WhyNotShared() + ". ";
  }
  this->NoteText = AgreeOnError(communicator, note);
}

/// Collective: whether the mesh on all ranks is that of the octree.
bool MeshField::SameMesh(Communicator& communicator, const HexMesh& piece)
{
  const Hash128 hash = HashOfMesh(piece);
  const bool same = this->Mesh && hash == this->PieceHash;
  this->PieceHash = hash;
  return AllMax(communicator, same ? 0.0 : 1.0) == 0.0;
}

} // namespace banyan
