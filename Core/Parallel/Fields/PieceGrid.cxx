// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/PieceGrid.h"

#include "Base/Error.h"
#include "Parallel/Composite/GatherPlan.h"

#include <algorithm>
#include <set>
#include <string>

namespace banyan
{
namespace
{

/// Returns the rest of boxes without another one.
std::vector<Box> Without(const std::vector<Box>& boxes, const Box& taken)
{
  std::vector<Box> rest;
  for (const Box& box : boxes)
  {
    const std::vector<Box> left = Subtract(box, taken);
    rest.insert(rest.end(), left.begin(), left.end());
  }
  return rest;
}

Box CellsBetween(const Box& samples)
{
  const Box cells{ samples.Lo, samples.Hi - 1 };
  return cells.Empty() ? Box{} : cells;
}

} // namespace

PieceGrid::PieceGrid(std::vector<Box> samples, int brickCells)
  : Pieces(std::move(samples))
{
  if (brickCells < 1)
  {
    throw Error("A brick needs at least one cell per axis");
  }
  for (std::size_t rank = 0; rank < this->Pieces.size(); ++rank)
  {
    Box& piece = this->Pieces[rank];
    piece = piece.Empty() ? Box{} : piece;
    if (glm::any(glm::lessThan(piece.Lo, glm::ivec3(0))))
    {
      throw Error("The piece of rank " + std::to_string(rank) + " starts before the grid");
    }
  }
  this->AddHoldings();
  this->CutIntoBricks(brickCells);
}

void PieceGrid::AddHoldings()
{
  for (int rank = 0; rank < this->Ranks(); ++rank)
  {
    std::vector<Box> left{ CellsBetween(this->SamplesOf(rank)) };
    for (int lower = 0; lower < rank; ++lower)
    {
      left = Without(left, CellsBetween(this->SamplesOf(lower)));
    }
    for (const Box& box : left)
    {
      if (!box.Empty())
      {
        this->Held.push_back({ rank, box });
        this->Domain = Union(this->Domain, box);
      }
    }
  }
}

void PieceGrid::CutIntoBricks(int brickCells)
{
  if (this->Held.empty())
  {
    return;
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    std::set<int> borders;
    for (const Holding& holding : this->Held)
    {
      borders.insert(holding.Cells.Lo[axis]);
      borders.insert(holding.Cells.Hi[axis]);
    }
    std::vector<int>& planes = this->Planes[axis];
    planes.push_back(*borders.begin());
    for (auto border = std::next(borders.begin()); border != borders.end(); ++border)
    {
      const int from = planes.back();
      const int length = *border - from;
      const int parts = (length + brickCells - 1) / brickCells;
      for (int part = 1; part <= parts; ++part)
      {
        planes.push_back(from + static_cast<int>(static_cast<std::int64_t>(length) * part / parts));
      }
    }
  }
  const glm::ivec3 counts = this->Bricks();
  this->Holders.assign(static_cast<std::size_t>(Box{ glm::ivec3(0), counts }.Count()), -1);
  for (const Holding& holding : this->Held)
  {
    Box bricks;
    for (int axis = 0; axis < 3; ++axis)
    {
      const std::vector<int>& planes = this->Planes[axis];
      const auto numberOf = [&planes](int plane)
      {
        return static_cast<int>(
          std::lower_bound(planes.begin(), planes.end(), plane) - planes.begin());
      };
      bricks.Lo[axis] = numberOf(holding.Cells.Lo[axis]);
      bricks.Hi[axis] = numberOf(holding.Cells.Hi[axis]);
    }
    for (int z = bricks.Lo.z; z < bricks.Hi.z; ++z)
    {
      for (int y = bricks.Lo.y; y < bricks.Hi.y; ++y)
      {
        const std::size_t row =
          static_cast<std::size_t>(counts.x) * (y + static_cast<std::size_t>(counts.y) * z);
        std::fill_n(this->Holders.begin() + static_cast<std::ptrdiff_t>(row) + bricks.Lo.x,
          bricks.Size().x, holding.Rank);
      }
    }
  }
}

glm::ivec3 PieceGrid::Bricks() const
{
  glm::ivec3 counts(0);
  for (int axis = 0; axis < 3; ++axis)
  {
    counts[axis] = std::max(static_cast<int>(this->Planes[axis].size()) - 1, 0);
  }
  return counts;
}

Box PieceGrid::CellsOf(std::int64_t brick) const
{
  const glm::ivec3 counts = this->Bricks();
  const std::int64_t at[3] = { brick % counts.x, brick / counts.x % counts.y,
    brick / counts.x / counts.y };
  Box cells;
  for (int axis = 0; axis < 3; ++axis)
  {
    cells.Lo[axis] = this->Planes[axis][static_cast<std::size_t>(at[axis])];
    cells.Hi[axis] = this->Planes[axis][static_cast<std::size_t>(at[axis]) + 1];
  }
  return cells;
}

Box PieceGrid::BrickSamples(std::int64_t brick, bool around) const
{
  const Box cells = this->CellsOf(brick);
  const int layer = around ? 1 : 0;
  return Intersection(
    { cells.Lo - layer, cells.Hi + 1 + layer }, { this->Domain.Lo, this->Domain.Hi + 1 });
}

bool PieceGrid::IsKnown(const Box& samples) const
{
  return PlanGathering(samples, this->Pieces).Missing.empty();
}

std::vector<PieceGrid::ShellPart> PieceGrid::ShellOf(int rank) const
{
  const Box whole{ this->Domain.Lo, this->Domain.Hi + 1 };
  std::vector<Box> wanted;
  std::vector<ShellPart> parts;
  for (const Holding& holding : this->Held)
  {
    if (holding.Rank != rank)
    {
      continue;
    }
    std::vector<Box> layer{ Intersection({ holding.Cells.Lo - 1, holding.Cells.Hi + 2 }, whole) };
    layer = Without(layer, this->SamplesOf(rank));
    // Several boxes of one rank may have layers in common.
    for (const Box& known : wanted)
    {
      layer = Without(layer, known);
    }
    wanted.insert(wanted.end(), layer.begin(), layer.end());
    for (const Box& box : layer)
    {
      for (const GatherPlan::Part& part : PlanGathering(box, this->Pieces).Parts)
      {
        parts.push_back({ part.Rank, part.Samples });
      }
    }
  }
  return parts;
}

} // namespace banyan
