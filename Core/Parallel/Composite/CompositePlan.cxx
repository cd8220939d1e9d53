// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/CompositePlan.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace banyan
{
namespace
{

constexpr int CellPixels = CompositePlan::CellPixels;

/// Rows of cells that a rank may draw in, from its rows of pixels.
std::vector<Footprint::Interval> CoveredCells(
  const Footprint& footprint, const PixelRect& viewport, const glm::ivec2& counts)
{
  std::vector<Footprint::Interval> rows(static_cast<std::size_t>(counts.y));
  for (int y = footprint.Rect.Lo.y; y < footprint.Rect.Hi.y; ++y)
  {
    const Footprint::Interval pixels = footprint.Row(y);
    if (pixels.Lo >= pixels.Hi)
    {
      continue;
    }
    const int lo = (pixels.Lo - viewport.Lo.x) / CellPixels;
    const int hi = (pixels.Hi - 1 - viewport.Lo.x) / CellPixels + 1;
    Footprint::Interval& row = rows[static_cast<std::size_t>((y - viewport.Lo.y) / CellPixels)];
    row = row.Lo < row.Hi ? Footprint::Interval{ std::min(row.Lo, lo), std::max(row.Hi, hi) }
                          : Footprint::Interval{ lo, hi };
  }
  return rows;
}

/// Counts for all cells the ranks other than the root that may draw there, from where the intervals
/// of ranks begin and end: what a rank takes does not depend on how many cells it covers.
void CountOthers(CompositePlan& plan)
{
  // One more than cells: where the last interval ends.
  std::vector<int> change(static_cast<std::size_t>(plan.CellCounts.x) + 1);
  for (int y = 0; y < plan.CellCounts.y; ++y)
  {
    std::fill(change.begin(), change.end(), 0);
    for (int rank = 0; rank < plan.Ranks; ++rank)
    {
      const Footprint::Interval row = plan.Covered[rank][y];
      if (rank != plan.Root && row.Lo < row.Hi)
      {
        ++change[row.Lo];
        --change[row.Hi];
      }
    }
    CompositePlan::Cell* cells =
      plan.Cells.data() + static_cast<std::size_t>(y) * plan.CellCounts.x;
    for (int x = 0, count = 0; x < plan.CellCounts.x; ++x)
    {
      count += change[x];
      cells[x].Others = static_cast<std::uint16_t>(count);
    }
  }
}

/// How many cells that several ranks other than the root may draw in lie before each cell of a row,
/// and in all of it: `[y][x]`, one more per row than cells.
std::vector<int> SharedBefore(const CompositePlan& plan)
{
  std::vector<int> before;
  before.reserve(plan.Cells.size() + static_cast<std::size_t>(plan.CellCounts.y));
  for (int y = 0; y < plan.CellCounts.y; ++y)
  {
    const CompositePlan::Cell* cells =
      plan.Cells.data() + static_cast<std::size_t>(y) * plan.CellCounts.x;
    int shared = 0;
    before.push_back(shared);
    for (int x = 0; x < plan.CellCounts.x; ++x)
    {
      shared += cells[x].Others > 1 ? 1 : 0;
      before.push_back(shared);
    }
  }
  return before;
}

/// How many of a rank's cells in a tile have an owner.
struct Share
{
  int Rank = 0;
  int Cells = 0;
};

/// Per tile, the ranks that may draw in cells that several ranks other than the root may draw in.
/// Lists the tiles of each rank too.
std::vector<std::vector<Share>> SharesOf(CompositePlan& plan)
{
  std::vector<std::vector<Share>> shares(plan.Tiles.size());
  const std::vector<int> sharedBefore = SharedBefore(plan);
  const int perTile = plan.TilePixels / CellPixels;
  constexpr int outside = -1;
  std::vector<int> shared(static_cast<std::size_t>(plan.TileCounts.x));
  for (int rank = 0; rank < plan.Ranks; ++rank)
  {
    for (int tileY = 0; tileY < plan.TileCounts.y; ++tileY)
    {
      std::fill(shared.begin(), shared.end(), outside);
      const int end = std::min((tileY + 1) * perTile, plan.CellCounts.y);
      for (int y = tileY * perTile; y < end; ++y)
      {
        const Footprint::Interval row = plan.Covered[rank][y];
        const int* before =
          sharedBefore.data() + static_cast<std::size_t>(y) * (plan.CellCounts.x + 1);
        for (int lo = row.Lo; lo < row.Hi;)
        {
          const int tileX = lo / perTile;
          const int hi = std::min(row.Hi, (tileX + 1) * perTile);
          shared[tileX] = std::max(shared[tileX], 0) + before[hi] - before[lo];
          lo = hi;
        }
      }
      for (int tileX = 0; tileX < plan.TileCounts.x; ++tileX)
      {
        const int tile = tileY * plan.TileCounts.x + tileX;
        if (shared[tileX] != outside)
        {
          plan.TilesOfRank[rank].push_back(tile);
        }
        if (rank != plan.Root && shared[tileX] > 0)
        {
          shares[tile].push_back({ rank, shared[tileX] });
        }
      }
    }
  }
  return shares;
}

/// The heaviest tile first, each to the rank that then has the least coming in; of equal ones to
/// that with the most pixels of its own, which need not be sent.
void ChooseOwners(CompositePlan& plan, const std::vector<std::vector<Share>>& shares)
{
  std::vector<long long> weight(plan.Tiles.size(), 0);
  std::vector<int> order(plan.Tiles.size());
  std::iota(order.begin(), order.end(), 0);
  for (std::size_t tile = 0; tile < shares.size(); ++tile)
  {
    for (const Share& share : shares[tile])
    {
      weight[tile] += share.Cells;
    }
  }
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) { return weight[a] > weight[b]; });
  std::vector<long long> incoming(static_cast<std::size_t>(plan.Ranks), 0);
  for (const int tile : order)
  {
    long long least = 0;
    int own = 0;
    for (const Share& share : shares[tile])
    {
      const long long after = incoming[share.Rank] + weight[tile] - share.Cells;
      if (plan.Tiles[tile].Owner < 0 || after < least || (after == least && share.Cells > own))
      {
        plan.Tiles[tile].Owner = share.Rank;
        least = after;
        own = share.Cells;
      }
    }
    if (plan.Tiles[tile].Owner >= 0)
    {
      incoming[plan.Tiles[tile].Owner] = least;
    }
  }
}

void DescribeTiles(CompositePlan& plan)
{
  const int perTile = plan.TilePixels / CellPixels;
  for (int y = 0; y < plan.CellCounts.y; ++y)
  {
    for (int x = 0; x < plan.CellCounts.x; ++x)
    {
      CompositePlan::Tile& tile = plan.Tiles[(y / perTile) * plan.TileCounts.x + x / perTile];
      const CompositePlan::Cell& cell =
        plan.Cells[static_cast<std::size_t>(y) * plan.CellCounts.x + x];
      const int others = cell.Others;
      tile.Kinds |= static_cast<std::uint8_t>(1u << static_cast<unsigned>(cell.How));
      if (others > 1)
      {
        tile.Meeting = std::max(tile.Meeting, others - (plan.Covers(tile.Owner, x, y) ? 1 : 0));
      }
    }
  }
}

/// Few ranks have much to send each: in parts, so that the first ones are blended while the next
/// ones travel. Many ranks have little each, and messages would only become more.
int ChunksFor(const CompositePlan& plan)
{
  int chunks = plan.Ranks <= 4 ? 16 : (plan.Ranks <= 32 ? 4 : 1);
  // Parts below this many pixels cost more than they gain.
  constexpr long long fewest = 16384;
  const long long pixels = plan.Viewport.Count();
  chunks = static_cast<int>(std::min<long long>(chunks, std::max(1LL, pixels / fewest)));
  // No message may reach 2^31 bytes: even of floats, twice.
  constexpr long long most = 1LL << 25;
  return std::max(chunks, static_cast<int>((pixels + most - 1) / most));
}

void ChooseChunks(CompositePlan& plan)
{
  plan.Chunks = ChunksFor(plan);
  plan.TilesOfChunk.resize(static_cast<std::size_t>(plan.Chunks));
  std::vector<int> owned(static_cast<std::size_t>(plan.Ranks) + 1, 0);
  for (const CompositePlan::Tile& tile : plan.Tiles)
  {
    ++owned[tile.Owner + 1];
  }
  std::vector<int> before(owned.size(), 0);
  for (std::size_t index = 0; index < plan.Tiles.size(); ++index)
  {
    CompositePlan::Tile& tile = plan.Tiles[index];
    const int owner = tile.Owner + 1;
    tile.Chunk =
      static_cast<int>(static_cast<long long>(before[owner]++) * plan.Chunks / owned[owner]);
    plan.TilesOfChunk[tile.Chunk].push_back(static_cast<int>(index));
  }
}

int TilePixelsFor(const PixelRect& viewport)
{
  const int longest = std::max(viewport.Size().x, viewport.Size().y);
  const int cells = std::clamp((longest / 8 + CellPixels - 1) / CellPixels, 2, 32);
  return cells * CellPixels;
}

} // namespace

bool PackingPays(const CompositeCosts& costs)
{
  const double plain = 1.0 / costs.BytesPerSecond;
  const double packed = std::max(plain / costs.PackingRatio, 1.0 / costs.PackedBytesPerSecond);
  return packed < plain;
}

PixelRect CompositePlan::RectOfTile(int tile) const
{
  const glm::ivec2 at(tile % this->TileCounts.x, tile / this->TileCounts.x);
  PixelRect rect;
  rect.Lo = this->Viewport.Lo + at * this->TilePixels;
  rect.Hi = glm::min(rect.Lo + this->TilePixels, this->Viewport.Hi);
  return rect;
}

/// Runs of the cells of a tile that are wanted; only those that `rank` covers unless it is
/// negative.
template <typename Wanted>
void CompositePlan::Collect(int tile, const Wanted& wanted, int rank, Region& region) const
{
  const int perTile = this->TilePixels / CellPixels;
  const glm::ivec2 first(
    (tile % this->TileCounts.x) * perTile, (tile / this->TileCounts.x) * perTile);
  const glm::ivec2 last = glm::min(first + perTile, this->CellCounts);
  for (int y = first.y; y < last.y; ++y)
  {
    int lo = first.x;
    int hi = last.x;
    if (rank >= 0)
    {
      lo = std::max(lo, this->Covered[rank][y].Lo);
      hi = std::min(hi, this->Covered[rank][y].Hi);
    }
    const Cell* row = this->Cells.data() + static_cast<std::size_t>(y) * this->CellCounts.x;
    for (int x = lo; x < hi;)
    {
      if (!wanted(row[x]))
      {
        ++x;
        continue;
      }
      const int begin = x;
      while (x < hi && wanted(row[x]))
      {
        ++x;
      }
      const int left = this->Viewport.Lo.x + begin * CellPixels;
      const int right = std::min(this->Viewport.Lo.x + x * CellPixels, this->Viewport.Hi.x);
      const int bottom = this->Viewport.Lo.y + y * CellPixels;
      const int top = std::min(bottom + CellPixels, this->Viewport.Hi.y);
      for (int pixelY = bottom; pixelY < top; ++pixelY)
      {
        region.push_back({ pixelY, left, right, (pixelY - bottom) % 2 == 1 });
      }
    }
  }
}

void CompositePlan::DirectRegion(int rank, int tile, Kind kind, Region& region) const
{
  region.clear();
  if (rank != this->Root)
  {
    this->Collect(
      tile, [=](const Cell& cell) { return cell.Others == 1 && cell.How == kind; }, rank, region);
  }
}

void CompositePlan::SharedRegion(int rank, int tile, Kind kind, Region& region) const
{
  region.clear();
  if (rank != this->Root)
  {
    this->Collect(
      tile, [=](const Cell& cell) { return cell.Others > 1 && cell.How == kind; }, rank, region);
  }
}

void CompositePlan::ResultRegion(int tile, Kind kind, Region& region) const
{
  region.clear();
  this->Collect(
    tile, [=](const Cell& cell) { return cell.Others > 1 && cell.How == kind; }, -1, region);
}

CompositePlan PlanCompositing(const std::vector<Footprint>& footprints, const PixelRect& viewport,
  const PixelRect& behind, bool ordered, int root)
{
  CompositePlan plan;
  plan.Root = root;
  plan.Ranks = static_cast<int>(footprints.size());
  plan.Viewport = viewport;
  plan.TilePixels = TilePixelsFor(viewport);
  plan.CellCounts = (viewport.Size() + (CellPixels - 1)) / CellPixels;
  plan.TileCounts = (viewport.Size() + (plan.TilePixels - 1)) / plan.TilePixels;
  plan.Cells.resize(static_cast<std::size_t>(plan.CellCounts.x) * plan.CellCounts.y);
  plan.Tiles.resize(static_cast<std::size_t>(plan.TileCounts.x) * plan.TileCounts.y);
  plan.TilesOfRank.resize(footprints.size());
  for (const Footprint& footprint : footprints)
  {
    plan.Covered.push_back(CoveredCells(footprint, viewport, plan.CellCounts));
  }
  CountOthers(plan);
  const auto set = [&](const std::vector<Footprint::Interval>& rows, CompositePlan::Kind how)
  {
    for (int y = 0; y < plan.CellCounts.y; ++y)
    {
      const auto row = plan.Cells.begin() + static_cast<std::ptrdiff_t>(y) * plan.CellCounts.x;
      for (int x = rows[y].Lo; x < rows[y].Hi; ++x)
      {
        row[x].How = how;
      }
    }
  };
  // Pixels that the root has drawn count before pixels that it will blend over something.
  const Footprint covered = FootprintOf(behind, viewport);
  set(CoveredCells(covered, viewport, plan.CellCounts), CompositePlan::Kind::Behind);
  set(plan.Covered[static_cast<std::size_t>(root)],
    ordered ? CompositePlan::Kind::Split : CompositePlan::Kind::Behind);
  ChooseOwners(plan, SharesOf(plan));
  DescribeTiles(plan);
  ChooseChunks(plan);
  return plan;
}

} // namespace banyan
