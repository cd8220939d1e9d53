// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/CellsField.h"

#include "Base/Digest.h"
#include "Base/ThreadPool.h"
#include "Parallel/Cells/CellPieces.h"
#include "Parallel/Cells/PieceMeans.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Fields/MeshGathering.h"
#include "Render/Cells/PointMeans.h"

#include <algorithm>
#include <array>
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

void CellsField::Take(Communicator& communicator, Piece piece, bool has)
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
  field.Values = std::move(array.Values);
  if (field.OfCells && AllMax(communicator, piece.KeepsCellValues ? 1.0 : 0.0) == 0.0)
  {
    this->TakeMeans(communicator, field);
  }
  this->Content =
    this->HashOfAll(communicator, HashOf(field.Values.data(), field.Values.size() * sizeof(float)));
  Collective(
    communicator, [&] { this->Drawn = std::make_unique<CellSource>(std::move(field), pool); });
  // Any cell may lie anywhere.
  this->ZoneCells.assign(static_cast<std::size_t>(communicator.Size()), Box{});
  this->ZoneCells.front() = { glm::ivec3(0), this->Cells->Lattice.Size };
}

/// Collective: all that a new mesh takes.
void CellsField::TakeMesh(Communicator& communicator, const Piece& piece)
{
  const bool alone = communicator.Size() == 1;
  ThreadPool& pool = ThreadPool::Process();
  CellFacts facts;
  if (alone)
  {
    Collective(communicator, [&] { this->Cells = DrawnCells::Of(piece.Mesh, facts, pool); });
  }
  else
  {
    this->Cells = DrawnPiece(communicator, piece.Mesh, facts, pool);
  }
  const CellCounts counts = alone ? facts : CountsOfAll(communicator, facts);
  this->NoteText = AgreeOnError(
    communicator, piece.OtherCells.empty() ? "" : "Not drawn: " + piece.OtherCells + ". ");
  for (const std::string& remark : counts.Remarks())
  {
    this->NoteText += remark + ". ";
  }
}

/// Collective: makes means at points of values of cells.
void CellsField::TakeMeans(Communicator& communicator, CellField& field) const
{
  ThreadPool& pool = ThreadPool::Process();
  if (communicator.Size() == 1)
  {
    Collective(communicator, [&] { field.Values = PointMeans(*this->Cells, field.Values, pool); });
  }
  else
  {
    field.Values = PieceMeans(communicator, *this->Cells, field.Values, pool);
  }
  field.OfCells = false;
}

/// Collective: of the points, cells and values of all ranks.
/// @param values of this rank
Hash128 CellsField::HashOfAll(Communicator& communicator, const Hash128& values) const
{
  const std::array<Hash128, 2> mine{ this->PieceHash, values };
  std::vector<std::array<Hash128, 2>> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());
  return HashOf(all.data(), all.size() * sizeof(mine));
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
