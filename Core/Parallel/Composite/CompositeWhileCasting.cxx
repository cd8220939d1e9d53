// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/CompositeWhileCasting.h"

#include "Render/Raycast/TileGrid.h"

#include <algorithm>

namespace banyan
{

CompositeWhileCasting::CompositeWhileCasting(Communicator& communicator,
  const std::vector<int>& frontToBack, const PixelRect& viewport, const CompositeOptions& options,
  CompositeStatistics& statistics)
  : Self(communicator.Rank())
  , Frame(communicator, frontToBack, viewport, options, statistics)
  , Added(static_cast<std::size_t>(this->Frame.GetPlan().Chunks), false)
{
  this->Frame.Begin();
}

void CompositeWhileCasting::Begins(const FloatImage& picture)
{
  const CompositePlan& plan = this->Frame.GetPlan();
  const TileGrid grid(picture.Rect);
  this->Picture = &picture;
  this->TilesLeft = std::make_unique<std::atomic<int>[]>(this->Added.size());
  for (std::size_t chunk = 0; chunk < this->Added.size(); ++chunk)
  {
    this->TilesLeft[chunk] = 0;
  }
  this->ChunksOfTile.assign(grid.Count(), {});
  for (const int tile : plan.TilesOfRank[static_cast<std::size_t>(this->Self)])
  {
    const PixelRect rect = Intersection(plan.RectOfTile(tile), picture.Rect);
    const int chunk = plan.Tiles[static_cast<std::size_t>(tile)].Chunk;
    if (rect.Empty())
    {
      continue;
    }
    grid.ForEachUnder(rect,
      [&](std::size_t under)
      {
        std::vector<int>& chunks = this->ChunksOfTile[under];
        if (std::find(chunks.begin(), chunks.end(), chunk) == chunks.end())
        {
          chunks.push_back(chunk);
          ++this->TilesLeft[static_cast<std::size_t>(chunk)];
        }
      });
  }
}

void CompositeWhileCasting::TileIsFinal(std::size_t tile)
{
  for (const int chunk : this->ChunksOfTile[tile])
  {
    // Whoever sees 0 sees the pixels.
    this->TilesLeft[static_cast<std::size_t>(chunk)].fetch_sub(1, std::memory_order_acq_rel);
  }
}

void CompositeWhileCasting::BetweenTiles()
{
  if (this->Failure)
  {
    return;
  }
  try
  {
    for (std::size_t chunk = 0; chunk < this->Added.size(); ++chunk)
    {
      if (!this->Added[chunk] && this->TilesLeft[chunk].load(std::memory_order_acquire) == 0)
      {
        this->Added[chunk] = true;
        ++this->Ahead;
        this->Frame.Add(static_cast<int>(chunk), this->Picture);
      }
    }
    this->Frame.Poll();
  }
  catch (...)
  {
    // Not an error of casting: it would be taken for one.
    this->Failure = std::current_exception();
  }
}

FloatImage CompositeWhileCasting::Finish(const FloatImage* mine)
{
  if (this->Failure)
  {
    std::rethrow_exception(this->Failure);
  }
  for (std::size_t chunk = 0; chunk < this->Added.size(); ++chunk)
  {
    if (!this->Added[chunk])
    {
      this->Frame.Add(static_cast<int>(chunk), mine);
    }
  }
  return this->Frame.Finish();
}

} // namespace banyan
