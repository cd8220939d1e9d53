// SPDX-License-Identifier: BSD-3-Clause
// The part of DistributedField that is for hexahedral meshes.
#include "DistributedField.h"

#include "GridOfLeaves.h"
#include "MeshField.h"

#include "Parallel/Fields/MeshZones.h"
#include "Parallel/Fields/PieceField.h"
#include "Render/Bricks/TimeStepPrefetcher.h"

#include "vtkDataArray.h"
#include "vtkSmartPointer.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>

namespace banyan
{

/// Collective. @return false when no rank has a mesh
bool DistributedField::TakeMesh(Communicator& communicator, FieldPiece piece)
{
  const double mine = piece.Leaves ? 2.0 : piece.Grid ? 1.0 : 0.0;
  const double most = AllMax(communicator, mine);
  if (most == 0.0)
  {
    this->Mesh.reset();
    return false;
  }
  this->Bricks.reset();
  this->Pieces.reset();
  this->Series.reset();
  this->Domain = Box{};
  this->PhysicalBounds = { { 1, -1, 1, -1, 1, -1 } };
  this->ZoneCells.assign(static_cast<std::size_t>(communicator.Size()), Box{});
  if (this->ProblemText.empty() && piece.Image)
  {
    this->ProblemText = "One rank has image data and another one hexahedra.";
  }
  if (!this->Mesh)
  {
    this->Mesh = std::make_unique<MeshField>();
  }
  // Nobody waits for a rank that has nothing to give.
  if (!AgreeOnError(communicator, this->ProblemText).empty())
  {
    return true;
  }
  try
  {
    vtkSmartPointer<vtkUnstructuredGrid> leaves;
    if (most == 2.0)
    {
      TakeLeaves(communicator, piece, leaves);
    }
    this->Mesh->Update(
      communicator, piece.Grid, piece.Array, piece.Where, piece.Component, piece.Mesh);
    this->Bricks = this->Mesh->TakeSource();
    this->SetMesh();
    this->Balancer.Start(this->Balancing,
      MeshZones(*this->Bricks, this->Domain, communicator.Size()), communicator.Size());
    this->PlaceMeshZones();
  }
  catch (const std::exception& error)
  {
    this->Bricks.reset();
    this->Domain = Box{};
    this->ProblemText = error.what();
  }
  return true;
}

std::string DistributedField::MeshNote() const
{
  return this->Mesh ? this->Mesh->Note() : std::string();
}

double DistributedField::MeshDeviation() const
{
  return this->Mesh ? this->Mesh->Deviation() : 0.0;
}

MeshBytes DistributedField::BytesOfMesh() const
{
  MeshBytes bytes = this->Mesh ? this->Mesh->Bytes() : MeshBytes{};
  if (const auto* const source = dynamic_cast<const HexBrickSource*>(this->Bricks.get()))
  {
    bytes.Own += source->LevelBytes();
  }
  return bytes;
}

void DistributedField::PlaceMeshZones()
{
  this->ZoneCells = ZonesInside(this->Balancer.Zones(), this->Domain);
}

void DistributedField::SetMesh()
{
  const ElementOctree& tree = this->Mesh->Tree();
  this->Domain = tree.Domain();
  this->IndexToPhysicalMatrix = tree.LatticeToWorld();
  this->ShortestEdge = std::min({ tree.Edge().x, tree.Edge().y, tree.Edge().z });
  for (int axis = 0; axis < 3; ++axis)
  {
    this->PhysicalBounds[2 * axis] =
      tree.Origin()[axis] + this->Domain.Lo[axis] * tree.Edge()[axis];
    this->PhysicalBounds[2 * axis + 1] =
      tree.Origin()[axis] + this->Domain.Hi[axis] * tree.Edge()[axis];
  }
}

} // namespace banyan
