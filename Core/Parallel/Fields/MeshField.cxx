// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/MeshField.h"

#include "Base/Digest.h"
#include "Parallel/Communicate/Collective.h"
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

/// Collective: what the ranks that have cells say values belong to.
ValuesOn Agreed(Communicator& communicator, ValuesOn where, bool cells)
{
  const double mine = static_cast<double>(where);
  const double high = AllMax(communicator, cells ? mine : -1.0);
  const double low = -AllMax(communicator, cells ? -mine : -3.0);
  if (low < high)
  {
    throw CollectiveError(
      "The array to draw is a point array on one rank and a cell array on another: rename one "
      "of them.");
  }
  return static_cast<ValuesOn>(static_cast<int>(std::max(high, 0.0)));
}

} // namespace

void MeshField::Take(Communicator& communicator, Piece piece, const MeshOptions& options,
  LoadBalancing balancing, std::string failure)
{
  this->Bricks.reset();
  ThrowTogether(communicator, failure);
  if (AllMax(communicator, static_cast<double>(piece.Mesh.CellCount)) == 0.0)
  {
    ThrowTogether(
      communicator, piece.OtherCells.empty()
                      ? failure
                      : "The mesh has no hexahedra or voxels, but " + piece.OtherCells + ".");
  }
  if (piece.Mesh.CellCount == 0)
  {
    piece.Mesh.PointCount = 0;
  }
  const ValuesOn where = Agreed(communicator, piece.Where, piece.Mesh.CellCount > 0);
  const bool sameMesh = this->SameMesh(communicator, piece.Mesh);
  if (!sameMesh || !(options == this->Options))
  {
    this->Mesh.reset();
    this->Options = options;
    this->Mesh =
      std::make_unique<SharedMesh>(communicator, piece.Mesh, where, MeshBrickCells, options);
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
  const SharedMesh::Facts& facts = this->Mesh->About();
  std::string note;
  if (!otherCells.empty())
  {
    note = "Only hexahedra and voxels are drawn, without " + otherCells + ". ";
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
