// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CheckMesh.h"

#include "Base/FirstFailure.h"
#include "Base/ThreadPool.h"
#include "Cells/CellCorners.h"
#include "Cells/CellJacobian.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>

namespace banyan
{
namespace
{

void Note(CellCounts::Some& some, std::int64_t cell)
{
  some.First = some.Count == 0 ? cell : std::min(some.First, cell);
  ++some.Count;
}

/// @return whether the first of all is one of these
bool Add(CellCounts::Some& to, const CellCounts::Some& from)
{
  const bool first = from.Count > 0 && (to.Count == 0 || std::tie(from.Rank, from.First) <
                                                           std::tie(to.Rank, to.First));
  to.First = first ? from.First : to.First;
  to.Rank = first ? from.Rank : to.Rank;
  to.Count += from.Count;
  return first;
}

void Add(CellCounts& to, const CellCounts& from)
{
  for (std::size_t shape = 0; shape < to.PerShape.size(); ++shape)
  {
    to.PerShape[shape] += from.PerShape[shape];
  }
  Add(to.NotFinite, from.NotFinite);
  Add(to.WithoutVolume, from.WithoutVolume);
  Add(to.Folded, from.Folded);
  if (Add(to.OtherTypes, from.OtherTypes))
  {
    to.FirstOtherType = from.FirstOtherType;
  }
  if (Add(to.OtherCounts, from.OtherCounts))
  {
    to.FirstCount = from.FirstCount;
    to.FirstCorners = from.FirstCorners;
  }
  to.Repeated += from.Repeated;
}

/// Whether all coordinates can be computed with.
bool AreUsable(const CellPlaces& places, int corners)
{
  return std::all_of(places.begin(), places.begin() + corners,
    [](const glm::dvec3& p)
    {
      // False for what is no number.
      return std::abs(p.x) <= CellFacts::MostCoordinate &&
             std::abs(p.y) <= CellFacts::MostCoordinate &&
             std::abs(p.z) <= CellFacts::MostCoordinate;
    });
}

/// Looks at cells one after the other.
template <class Real>
class Checker
{
public:
  Checker(const CellMesh& mesh, const CornerReader<Real>& reader, FirstFailure& failure)
    : Mesh(mesh)
    , Reader(reader)
    , Failure(failure)
  {
  }

  /// @return whether the cell is drawn
  bool Draws(std::int64_t cell, CellFacts& facts) const
  {
    if (this->Mesh.Hidden && this->Mesh.Hidden[cell] != 0)
    {
      return false;
    }
    if (!this->IsListed(cell))
    {
      return false;
    }
    const MeshCell is = this->Mesh.Cell(cell);
    const int corners = CornersOf(is.Shape);
    if (corners == 0)
    {
      this->NoteUndrawn(cell, facts);
      return false;
    }
    if (!this->AreInRange(cell, is, corners))
    {
      return false;
    }
    const CellPlaces places = this->Reader.At(cell, is);
    if (!AreUsable(places, corners))
    {
      Note(facts.NotFinite, cell);
      return false;
    }
    const JacobianSigns signs = SignsOfJacobian(is.Shape, places);
    if (!signs.Positive && !signs.Negative)
    {
      Note(facts.WithoutVolume, cell);
      return false;
    }
    if (signs.Positive && signs.Negative)
    {
      Note(facts.Folded, cell);
    }
    ++facts.PerShape[static_cast<std::size_t>(is.Shape)];
    return true;
  }

private:
  /// Cells come in the order of their numbers: the first one of a kind is the first of all.
  void NoteUndrawn(std::int64_t cell, CellFacts& facts) const
  {
    const std::uint8_t type = this->Mesh.Types[cell];
    const int corners = CornersOf(CellMesh::ShapeOf(type));
    CellCounts::Some& some = corners == 0 ? facts.OtherTypes : facts.OtherCounts;
    Note(some, cell);
    if (some.Count > 1)
    {
      return;
    }
    if (corners == 0)
    {
      facts.FirstOtherType = type;
      return;
    }
    const CellMesh::Listed list = this->Mesh.ListOf(cell);
    facts.FirstCount = list.End - list.Begin;
    facts.FirstCorners = corners;
  }

  /// Whether the mesh has as many numbers of points as a cell needs: before any is read.
  bool IsListed(std::int64_t cell) const
  {
    if (this->Mesh.Is != CellMesh::Kind::Cells)
    {
      return true;
    }
    const CellMesh::Listed list = this->Mesh.ListOf(cell);
    if (list.Begin < 0 || list.End < list.Begin || list.End > this->Mesh.ConnectivityCount)
    {
      this->Failure.Report(cell, "Cell " + std::to_string(cell) + " has its points from number " +
                                   std::to_string(list.Begin) + " to " + std::to_string(list.End) +
                                   " of the connectivity, which has " +
                                   std::to_string(this->Mesh.ConnectivityCount));
      return false;
    }
    return true;
  }

  bool AreInRange(std::int64_t cell, const MeshCell& is, int corners) const
  {
    for (std::size_t i = 0; i < static_cast<std::size_t>(corners); ++i)
    {
      if (is.Points[i] < 0 || is.Points[i] >= this->Mesh.PointCount)
      {
        this->Failure.Report(cell, "Cell " + std::to_string(cell) + " refers to point " +
                                     std::to_string(is.Points[i]) + ", and the mesh has " +
                                     std::to_string(this->Mesh.PointCount) + " points");
        return false;
      }
    }
    return true;
  }

  const CellMesh& Mesh;
  const CornerReader<Real>& Reader;
  FirstFailure& Failure;
};

void CheckSize(const CellMesh& mesh)
{
  if (mesh.Is == CellMesh::Kind::Cells)
  {
    return;
  }
  const std::array<std::int64_t, 3> size{ mesh.Size.x, mesh.Size.y, mesh.Size.z };
  if (*std::min_element(size.begin(), size.end()) < 2)
  {
    throw Error("A grid whose cells are drawn needs two points along each axis, and this one has " +
                std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " +
                std::to_string(size[2]));
  }
  const std::int64_t points = size[0] * size[1] * size[2];
  const std::int64_t cells = (size[0] - 1) * (size[1] - 1) * (size[2] - 1);
  if (mesh.PointCount != points || mesh.CellCount != cells)
  {
    throw Error("A grid of this size has " + std::to_string(points) + " points and " +
                std::to_string(cells) + " cells, and not " + std::to_string(mesh.PointCount) +
                " and " + std::to_string(mesh.CellCount));
  }
}

std::string Sentence(const CellCounts::Some& some, const std::string& have)
{
  const std::string cell =
    std::to_string(some.First) + (some.Rank < 0 ? "" : " of rank " + std::to_string(some.Rank));
  return some.Count == 1
           ? "Cell " + cell + ' ' + have
           : std::to_string(some.Count) + " cells, the first of which is " + cell + ", " + have;
}

} // namespace

std::int64_t CellCounts::Drawn() const
{
  return std::accumulate(this->PerShape.begin(), this->PerShape.end(), std::int64_t{ 0 });
}

void CellCounts::Count(CellCounts other, int rank)
{
  for (Some* const some : { &other.NotFinite, &other.WithoutVolume, &other.OtherTypes,
         &other.OtherCounts, &other.Folded })
  {
    some->Rank = rank;
  }
  Add(*this, other);
}

std::vector<std::string> CellCounts::Remarks() const
{
  std::vector<std::string> remarks;
  const auto say = [&remarks](const Some& some, const std::string& one, const std::string& many)
  {
    if (some.Count > 0)
    {
      remarks.push_back(Sentence(some, some.Count == 1 ? one : many));
    }
  };
  const std::string points = "left out: coordinates are not finite, or beyond 1e150";
  say(this->NotFinite, "is " + points, "are " + points);
  const std::string flat = "left out: all corners lie in a plane";
  say(this->WithoutVolume, "is " + flat, "are " + flat);
  const std::string type = std::to_string(this->FirstOtherType) + " of VTK is not drawn";
  say(this->OtherTypes, "is left out: type " + type, "are left out: type " + type);
  if (this->Repeated > 0)
  {
    remarks.push_back(std::to_string(this->Repeated) +
                      (this->Repeated == 1 ? " cell has" : " cells have") +
                      " the corners of another one, and one of both is drawn");
  }
  const std::string count =
    std::to_string(this->FirstCount) + " points in place of " + std::to_string(this->FirstCorners);
  say(this->OtherCounts, "is left out: it has " + count, "are left out: that one has " + count);
  say(this->Folded, "is folded over at a corner, and may have a hole there",
    "are folded over at a corner, and may have holes there");
  return remarks;
}

CellFacts CheckCells(const CellMesh& mesh, ThreadPool& pool)
{
  CheckSize(mesh);
  CellFacts facts;
  facts.LeftOut.resize(static_cast<std::size_t>(mesh.CellCount));
  std::vector<CellFacts> parts(static_cast<std::size_t>(pool.Width()));
  FirstFailure failure;
  WithCorners(mesh,
    [&](const auto& reader)
    {
      const Checker checker(mesh, reader, failure);
      ForRuns(mesh.CellCount, pool, failure,
        [&](std::int64_t begin, std::int64_t end, int worker)
        {
          CellFacts part;
          for (std::int64_t cell = begin; cell < end; ++cell)
          {
            facts.LeftOut[static_cast<std::size_t>(cell)] = checker.Draws(cell, part) ? 0 : 1;
          }
          Add(parts[static_cast<std::size_t>(worker)], part);
        });
    });
  for (const CellFacts& part : parts)
  {
    Add(facts, part);
  }
  if (facts.Drawn() == mesh.CellCount)
  {
    facts.LeftOut = {};
  }
  return facts;
}

} // namespace banyan
