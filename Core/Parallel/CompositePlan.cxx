#include "Parallel/CompositePlan.h"

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

/// Calls `action(cell)` for all cells of a rank.
template <typename Action>
void ForEachCell(const CompositePlan& plan, int rank, const Action& action)
{
  for (int y = 0; y < plan.CellCounts.y; ++y)
  {
    const Footprint::Interval row = plan.Covered[rank][y];
    for (int x = row.Lo; x < row.Hi; ++x)
    {
      action(x, y);
    }
  }
}

/// Whether some of rank's cells of this tile have an owner, and how many.
struct Share
{
  int Rank = 0;
  int Cells = 0;
};

/// Per tile, the ranks that may draw in cells that several ranks other than the root may draw in.
std::vector<std::vector<Share>> SharesOf(CompositePlan& plan)
{
  std::vector<std::vector<Share>> shares(plan.Tiles.size());
  const int perTile = plan.TilePixels / CellPixels;
  for (int rank = 0; rank < plan.Ranks; ++rank)
  {
    int last = -1;
    std::vector<int>& tiles = plan.TilesOfRank[rank];
    ForEachCell(plan, rank,
      [&](int x, int y)
      {
        const int tile = (y / perTile) * plan.TileCounts.x + x / perTile;
        if (tile != last)
        {
          tiles.push_back(last = tile);
        }
        if (rank == 0 || plan.Cells[static_cast<std::size_t>(y) * plan.CellCounts.x + x].Others < 2)
        {
          return;
        }
        std::vector<Share>& ranks = shares[tile];
        if (ranks.empty() || ranks.back().Rank != rank)
        {
          ranks.push_back({ rank, 0 });
        }
        ++ranks.back().Cells;
      });
    std::sort(tiles.begin(), tiles.end());
    tiles.erase(std::unique(tiles.begin(), tiles.end()), tiles.end());
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
    const std::size_t owner = static_cast<std::size_t>(tile.Owner + 1);
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
  if (rank != 0)
  {
    this->Collect(
      tile, [=](const Cell& cell) { return cell.Others == 1 && cell.How == kind; }, rank, region);
  }
}

void CompositePlan::SharedRegion(int rank, int tile, Kind kind, Region& region) const
{
  region.clear();
  if (rank != 0)
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
  const PixelRect& behind, bool ordered)
{
  CompositePlan plan;
  plan.Ranks = static_cast<int>(footprints.size());
  plan.Viewport = viewport;
  plan.TilePixels = TilePixelsFor(viewport);
  plan.CellCounts = (viewport.Size() + (CellPixels - 1)) / CellPixels;
  plan.TileCounts = (viewport.Size() + (plan.TilePixels - 1)) / plan.TilePixels;
  plan.Cells.resize(static_cast<std::size_t>(plan.CellCounts.x) * plan.CellCounts.y);
  plan.Tiles.resize(static_cast<std::size_t>(plan.TileCounts.x) * plan.TileCounts.y);
  plan.TilesOfRank.resize(footprints.size());
  const auto cellAt = [&](int x, int y) -> CompositePlan::Cell&
  { return plan.Cells[static_cast<std::size_t>(y) * plan.CellCounts.x + x]; };
  for (int rank = 0; rank < plan.Ranks; ++rank)
  {
    plan.Covered.push_back(CoveredCells(footprints[rank], viewport, plan.CellCounts));
    ForEachCell(plan, rank,
      [&](int x, int y)
      {
        CompositePlan::Cell& cell = cellAt(x, y);
        if (rank == 0)
        {
          cell.How = ordered ? CompositePlan::Kind::Split : CompositePlan::Kind::Behind;
          return;
        }
        ++cell.Others;
        cell.Sole = static_cast<std::uint16_t>(rank);
      });
  }
  const Footprint covered = FootprintOf(behind, viewport);
  const auto rows = CoveredCells(covered, viewport, plan.CellCounts);
  for (int y = 0; y < plan.CellCounts.y; ++y)
  {
    for (int x = rows[y].Lo; x < rows[y].Hi; ++x)
    {
      CompositePlan::Cell& cell = cellAt(x, y);
      cell.How = cell.How == CompositePlan::Kind::Final ? CompositePlan::Kind::Behind : cell.How;
    }
  }
  ChooseOwners(plan, SharesOf(plan));
  DescribeTiles(plan);
  ChooseChunks(plan);
  return plan;
}

} // namespace banyan
