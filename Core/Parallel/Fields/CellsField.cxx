// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/CellsField.h"

#include "Base/Digest.h"
#include "Base/ThreadPool.h"
#include "Parallel/Cells/GatheredCells.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Fields/MeshGathering.h"
#include "Parallel/Fields/MeshZones.h"

#include <algorithm>
#include <cmath>
#include <type_traits>
#include <utility>

namespace banyan
{
namespace
{

/// Of all that places cells; their values do not count.
Hash128 HashOfMesh(const CellMesh& mesh)
{
  Digest all;
  const auto add = [&](const void* data, std::size_t bytes)
  {
    if (data)
    {
      all.Add(HashOf(data, bytes));
    }
  };
  const auto cells = static_cast<std::size_t>(mesh.CellCount);
  const std::size_t coordinate = SizeOf(mesh.PointType);
  const std::size_t id = SizeOf(mesh.IdType);
  add(&mesh.Is, sizeof(mesh.Is));
  add(&mesh.Size, sizeof(mesh.Size));
  add(&mesh.CellCount, sizeof(mesh.CellCount));
  add(mesh.Points, 3 * static_cast<std::size_t>(mesh.PointCount) * coordinate);
  for (int axis = 0; axis < 3; ++axis)
  {
    add(mesh.Axes[static_cast<std::size_t>(axis)],
      static_cast<std::size_t>(std::max(mesh.Size[axis], 0)) * coordinate);
  }
  add(mesh.Types, cells);
  add(mesh.Hidden, cells);
  add(mesh.Offsets, mesh.Offsets ? (cells + 1) * id : 0);
  add(mesh.Connectivity, static_cast<std::size_t>(mesh.ConnectivityCount) * id);
  return all.Get();
}

/// Collective: the counts of all ranks.
CellCounts CountsOfAll(Communicator& communicator, const CellCounts& mine)
{
  static_assert(std::is_trivially_copyable_v<CellCounts>);
  std::vector<CellCounts> counts(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), counts.data());
  CellCounts all;
  for (std::size_t rank = 0; rank < counts.size(); ++rank)
  {
    all.Count(counts[rank], static_cast<int>(rank));
  }
  return all;
}

} // namespace

void CellsField::Take(Communicator& communicator, Piece piece, bool has, LoadBalancing balancing)
{
  this->Drawn.reset();
  if (AllMax(communicator, static_cast<double>(piece.Mesh.CellCount)) == 0.0)
  {
    ThrowTogether(communicator,
      piece.OtherCells.empty() ? ""
                               : "The mesh has no cells in three dimensions, but " +
                                   piece.OtherCells + ". Choose another representation for them.");
    ThrowTogether(communicator, "The mesh has no cells.");
  }
  const ValuesOn where = AgreedPlace(communicator, piece.Where, piece.Mesh.CellCount > 0);
  if (!has)
  {
    this->Cells.reset();
    this->TakeMesh(communicator, piece);
  }
  ThreadPool& pool = ThreadPool::Process();
  const std::int64_t count =
    where == ValuesOn::Cells ? piece.Mesh.CellCount : piece.Mesh.PointCount;
  CellArray array;
  double lowest = 0.0;
  Collective(communicator, [&] { lowest = LowestOf(piece.Values, count, pool); });
  const double base = -AllMax(communicator, -lowest);
  Collective(communicator, [&]
    { array = CellArrayOf(piece.Values, count, where, pool, std::isfinite(base) ? base : 0.0); });
  CellField field;
  field.Cells = this->Cells;
  field.Base = AllMax(communicator, std::abs(array.Base)) > 0.0 ? base : 0.0;
  field.OfCells = where == ValuesOn::Cells;
  field.Values = GatherFloats(communicator, std::move(array.Values));
  this->Content =
    HashOf(field.Values.data(), field.Values.size() * sizeof(float), this->HashOfAll(communicator));
  Collective(
    communicator, [&] { this->Drawn = std::make_unique<CellSource>(std::move(field), pool); });
  const Box domain{ glm::ivec3(0), this->Cells->Lattice.Size };
  this->Balancer.Start(
    balancing, MeshZones(*this->Drawn, domain, communicator.Size()), communicator.Size());
  this->ZoneCells = ZonesInside(this->Balancer.Zones(), domain);
}

/// Collective: all that a new mesh takes.
void CellsField::TakeMesh(Communicator& communicator, const Piece& piece)
{
  const bool alone = communicator.Size() == 1;
  ThreadPool& pool = ThreadPool::Process();
  CellCounts counts;
  if (!alone)
  {
    // Before anybody reads points through numbers that may be wrong.
    Collective(communicator, [&] { counts = CheckCells(piece.Mesh, pool); });
    counts = CountsOfAll(communicator, counts);
  }
  const CellMesh all = GatherCells(communicator, piece.Mesh);
  CellFacts facts;
  Collective(communicator, [&] { this->Cells = DrawnCells::Of(all, facts, pool); });
  if (alone)
  {
    counts = facts;
  }
  counts.Repeated = facts.Repeated;
  this->NoteText = AgreeOnError(
    communicator, piece.OtherCells.empty() ? "" : "Not drawn: " + piece.OtherCells + ". ");
  for (const std::string& remark : counts.Remarks())
  {
    this->NoteText += remark + ". ";
  }
}

/// Collective: of the points and cells of all ranks.
std::uint64_t CellsField::HashOfAll(Communicator& communicator) const
{
  std::vector<Hash128> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&this->PieceHash, sizeof(Hash128), all.data());
  const Hash128 hash = HashOf(all.data(), all.size() * sizeof(Hash128));
  return hash.Low ^ hash.High;
}

FieldPlace CellsField::Place() const
{
  const CellLattice& lattice = this->Cells->Lattice;
  FieldPlace place;
  place.Cells = { glm::ivec3(0), lattice.Size };
  for (int axis = 0; axis < 3; ++axis)
  {
    place.IndexToPhysical[axis][axis] = lattice.Edge;
    place.IndexToPhysical[3][axis] = lattice.Origin[axis];
    const auto at = 2 * static_cast<std::size_t>(axis);
    place.Bounds[at] = this->Cells->Low[axis];
    place.Bounds[at + 1] = this->Cells->High[axis];
  }
  place.CellSize = lattice.Edge;
  return place;
}

void CellsField::BeginFrame(Communicator&, RayScene& scene)
{
  if (this->Drawn)
  {
    this->Balancer.BeginFrame(scene, *this->Drawn);
    this->ZoneCells =
      ZonesInside(this->Balancer.Zones(), { glm::ivec3(0), this->Cells->Lattice.Size });
  }
}

std::vector<Hash128> CellsField::VisibleContent(const RayScene&)
{
  return this->Drawn ? std::vector<Hash128>{ this->Content } : std::vector<Hash128>{};
}

MeshBytes CellsField::Bytes() const
{
  MeshBytes bytes;
  bytes.Own += this->Cells ? this->Cells->Bytes() : 0;
  if (this->Drawn)
  {
    bytes.Own += this->Drawn->Cells().Values.size() * sizeof(float) + this->Drawn->SeenBytes() +
                 this->Drawn->LatticeBytes();
  }
  return bytes;
}

bool CellsField::Has(Communicator& communicator, const CellMesh& piece)
{
  const Hash128 hash = piece.CellCount > 0 ? HashOfMesh(piece) : Hash128{};
  const bool same = this->Cells && hash == this->PieceHash;
  this->PieceHash = hash;
  return AllMax(communicator, same ? 0.0 : 1.0) == 0.0;
}

} // namespace banyan
