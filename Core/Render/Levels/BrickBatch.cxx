// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/BrickBatch.h"

#include "Base/ThreadPool.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Bricks loaded before the rays that have become opaque are looked at again.
constexpr std::size_t BricksPerBatch = 512;
/// Kept bricks that a thread looks for in one go.
constexpr std::size_t FoundTogether = 64;

/// Makes the lists of the tiles.
/// @param tiles under the first brick of the batch, under the second, and so on
/// @param ends of each brick's tiles in these
/// @param count of all tiles
void EnterInTiles(BrickBatch& batch, const std::vector<std::size_t>& tiles,
  const std::vector<std::size_t>& ends, std::size_t count)
{
  batch.FirstOver.assign(count + 1, 0);
  for (const std::size_t tile : tiles)
  {
    ++batch.FirstOver[tile + 1];
  }
  for (std::size_t tile = 0; tile < count; ++tile)
  {
    batch.FirstOver[tile + 1] += batch.FirstOver[tile];
  }
  std::vector<std::size_t> next(batch.FirstOver.begin(), batch.FirstOver.end() - 1);
  batch.OverTiles.resize(tiles.size());
  std::size_t i = 0;
  for (std::size_t brick = 0; brick < ends.size(); ++brick)
  {
    for (; i < ends[brick]; ++i)
    {
      batch.OverTiles[next[tiles[i]]++] = static_cast<int>(brick);
    }
  }
}

} // namespace

BatchQueue::BatchQueue(const LevelScene& level, const std::vector<PlannedBrick>& bricks,
  std::uint64_t budgetBytes, ThreadPool& pool)
  : Level(level)
  , Bricks(bricks)
  , BudgetBytes(budgetBytes)
  , Kept(bricks.size())
{
  this->FindKept(pool);
}

void BatchQueue::FindKept(ThreadPool& pool)
{
  const BrickSource& source = this->Level.Source;
  const std::size_t count = this->Bricks.size();
  pool.ParallelFor(static_cast<std::int64_t>((count + FoundTogether - 1) / FoundTogether),
    [&](std::int64_t part)
    {
      const std::size_t first = static_cast<std::size_t>(part) * FoundTogether;
      const std::size_t some = std::min(FoundTogether, count - first);
      PackedBrickCache::Wanted wanted[FoundTogether];
      for (std::size_t i = 0; i < some; ++i)
      {
        const PlannedBrick& brick = this->Bricks[first + i];
        wanted[i] = { brick.Entry ? -1 : brick.KeptNumber(source), brick.Cells, this->Level.Low(),
          this->Level.IsShaded() };
      }
      source.Kept().Find(wanted, some, this->Level.Visible->Number(), &this->Kept[first]);
    });
}

/// Bytes that the budget leaves beside the bricks that are kept.
std::uint64_t BatchQueue::BytesLeft() const
{
  return this->BudgetBytes - std::min(this->BudgetBytes, this->Level.Source.Kept().Bytes());
}

std::int64_t BatchQueue::Take(const LevelTiles& tiles, BrickBatch& batch)
{
  const BrickSource& source = this->Level.Source;
  batch.Bricks.clear();
  std::vector<std::size_t> under; // the tiles under the bricks of the batch
  std::vector<std::size_t> ends;  // of each brick's
  const std::uint64_t left = this->BytesLeft();
  std::uint64_t bytes = 0;
  std::size_t unkept = 0;
  std::int64_t skipped = 0;
  for (; this->Taken < this->Bricks.size(); ++this->Taken)
  {
    const PlannedBrick& brick = this->Bricks[this->Taken];
    PackedBrickCache::Found& kept = this->Kept[this->Taken];
    const bool isThere = kept.Packed || brick.Entry;
    const std::uint64_t brickBytes =
      isThere ? 0 : brick.BytesToDraw(source, this->Level.IsShaded());
    const bool full = bytes + brickBytes > left || (!isThere && unkept >= BricksPerBatch);
    if (full && !batch.Bricks.empty())
    {
      break;
    }
    const std::size_t before = under.size();
    tiles.ForOpenUnder(brick.Footprint, [&](std::size_t tile) { under.push_back(tile); });
    // A brick that is in memory anyway costs less to draw than to look for open pixels.
    const bool look = !isThere && brick.LoadBytes(source) > 0;
    if (under.size() == before || (look && !tiles.AnyRayOpen(brick)))
    {
      under.resize(before);
      skipped += brick.Count();
      continue;
    }
    ends.push_back(under.size());
    batch.Bricks.emplace_back();
    LoadedBrick& taken = batch.Bricks.back();
    taken.Planned = &brick;
    taken.Packed = std::move(kept.Packed);
    taken.Known = std::move(kept.Visibility);
    unkept += isThere ? 0 : 1;
    bytes += brickBytes;
  }
  batch.End = this->Taken;
  EnterInTiles(batch, under, ends, tiles.Count());
  return skipped;
}

} // namespace banyan
