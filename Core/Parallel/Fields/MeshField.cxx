// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/MeshField.h"

#include "Base/Digest.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Fields/MeshGathering.h"
#include "Parallel/Fields/MeshZones.h"

#include <algorithm>
#include <utility>

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

} // namespace

void MeshField::Take(
  Communicator& communicator, Piece piece, double tolerance, LoadBalancing balancing)
{
  this->Bricks.reset();
  if (piece.Mesh.CellCount == 0)
  {
    piece.Mesh.PointCount = 0;
  }
  const ValuesOn where = AgreedPlace(communicator, piece.Where, piece.Mesh.CellCount > 0);
  const bool sameMesh = this->SameMesh(communicator, piece.Mesh);
  if (!sameMesh || tolerance != this->Tolerance)
  {
    this->Mesh.reset();
    this->Tolerance = tolerance;
    this->Mesh = std::make_unique<SharedMesh>(communicator, piece.Mesh, MeshBrickCells, tolerance);
    this->Describe(communicator, piece.OtherCells);
  }
  this->Bricks = this->Mesh->Field(communicator, piece.Values,
    where == ValuesOn::Cells ? piece.Mesh.CellCount : piece.Mesh.PointCount, where);
  const Box domain = this->Mesh->Tree().Domain();
  this->Balancer.Start(
    balancing, MeshZones(*this->Bricks, domain, communicator.Size()), communicator.Size());
  this->ZoneCells = ZonesInside(this->Balancer.Zones(), domain);
}

FieldPlace MeshField::Place() const
{
  const ElementOctree& tree = this->Mesh->Tree();
  FieldPlace place;
  place.Cells = tree.Domain();
  place.IndexToPhysical = tree.LatticeToWorld();
  place.CellSize = std::min({ tree.Edge().x, tree.Edge().y, tree.Edge().z });
  for (int axis = 0; axis < 3; ++axis)
  {
    place.Bounds[2 * axis] = tree.Origin()[axis] + place.Cells.Lo[axis] * tree.Edge()[axis];
    place.Bounds[2 * axis + 1] = tree.Origin()[axis] + place.Cells.Hi[axis] * tree.Edge()[axis];
  }
  return place;
}

void MeshField::BeginFrame(Communicator&, RayScene& scene)
{
  if (this->Bricks)
  {
    this->Balancer.BeginFrame(scene, *this->Bricks);
    this->ZoneCells = ZonesInside(this->Balancer.Zones(), this->Mesh->Tree().Domain());
  }
}

void MeshField::BringLevels(Communicator& communicator, const RayScene&, int coarsest)
{
  if (this->Mesh)
  {
    this->Mesh->BringLevels(communicator, coarsest);
  }
}

std::vector<Hash128> MeshField::VisibleContent(const RayScene&)
{
  if (!this->Bricks)
  {
    return {};
  }
  Digest all;
  for (std::int64_t brick = 0; brick < this->Bricks->Bricks().x; ++brick)
  {
    all.Add(*this->Bricks->ContentOf(brick));
  }
  return { all.Get() };
}

MeshBytes MeshField::Bytes() const
{
  MeshBytes bytes = this->Mesh ? this->Mesh->Bytes() : MeshBytes{};
  bytes.Own += this->Bricks ? this->Bricks->LevelBytes() : 0;
  return bytes;
}

void MeshField::Describe(Communicator& communicator, const std::string& otherCells)
{
  std::string note;
  if (!otherCells.empty())
  {
    note = "Not drawn: " + otherCells + ". ";
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
