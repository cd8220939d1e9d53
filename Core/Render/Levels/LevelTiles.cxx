// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/LevelTiles.h"

#include "Render/Levels/PictureWatcher.h"

#include <algorithm>

namespace banyan
{
namespace
{

static_assert(TileSamplings::Edge == RayTile::Edge, "a tile has one sampling");
/// Probes have so few pixels that threads would wait for each other: they are cut into smaller
/// tiles until there are so many for each thread, and no further than SmallestEdge.
constexpr std::size_t TilesPerThread = 4;
constexpr int SmallestEdge = 8;

TileGrid GridFor(const PixelRect& rect, bool probe, std::size_t workers)
{
  TileGrid grid(rect);
  for (int edge = RayTile::Edge / 2;
       probe && workers > 1 && edge >= SmallestEdge && grid.Count() < TilesPerThread * workers;
       edge /= 2)
  {
    grid = TileGrid(rect, edge);
  }
  return grid;
}

} // namespace

LevelTiles::LevelTiles(const LevelScene& level, const std::vector<PlannedBrick>& bricks,
  FloatImage& picture, PictureWatcher* watcher, std::size_t workers)
  : Level(level)
  , Pixels(picture)
  , Watcher(watcher)
  , Grid(GridFor(picture.Rect, level.Scene.Probe, workers))
  , Tiles(Grid.Count())
{
  const TileSamplings* const samplings = level.Scene.Samplings.get();
  for (std::size_t i = 0; i < this->Tiles.size(); ++i)
  {
    LevelTile& tile = this->Tiles[i];
    const auto number =
      static_cast<std::size_t>(samplings ? samplings->NumberAt(this->Grid.PositionOf(i)) : 0);
    tile.Sampling = level.Samplings.at(number).get();
    tile.PixelStride = samplings ? samplings->Samplings()[number].PixelStride : 1;
    tile.Cast =
      level.Scene.Reused ? level.Scene.Reused->At(this->Grid.PositionOf(i)) : ReusedRays::All;
    tile.Done = tile.Sampling == nullptr || tile.Cast == 0;
  }
  for (std::size_t i = 0; i < bricks.size(); ++i)
  {
    this->ForOpenUnder(
      bricks[i].Footprint, [&](std::size_t tile) { this->Tiles[tile].End = i + 1; });
  }
}

bool LevelTiles::AnyRayOpen(const PlannedBrick& brick) const
{
  const float limit = this->Level.TransmittanceLimit();
  const ProjectionTable* const projection = this->Level.Projection();
  const bool ranked = projection && !projection->Averages();
  const auto isOpen = [&](const glm::vec4& pixel)
  { return ranked ? pixel.r < brick.HighestRank : pixel.a > limit; };
  bool open = false;
  this->ForOpenUnder(brick.Footprint,
    [&](std::size_t number)
    {
      const LevelTile& tile = this->Tiles[number];
      const PixelRect part = Intersection(brick.Footprint, this->RectOf(number));
      const int stride = tile.PixelStride;
      const glm::ivec2 first = (part.Lo + (stride - 1)) / stride * stride;
      open = open || !tile.Begun;
      for (int y = first.y; y < part.Hi.y && !open; y += stride)
      {
        for (int x = first.x; x < part.Hi.x && !open; x += stride)
        {
          open = isOpen(this->Pixels.At(x, y));
        }
      }
    });
  return open;
}

void LevelTiles::Clear(const PixelRect& rect) const
{
  for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
  {
    std::fill_n(&this->Pixels.At(rect.Lo.x, y), rect.Size().x, glm::vec4(0.0f));
  }
}

void LevelTiles::Finish(std::size_t number, std::size_t taken)
{
  LevelTile& tile = this->Tiles[number];
  if (!tile.Sampling || tile.Final || !(tile.Done || tile.End <= taken))
  {
    return;
  }
  const PixelRect rect = this->RectOf(number);
  if (!tile.Begun)
  {
    this->Clear(rect);
  }
  const int stride = tile.PixelStride;
  const glm::ivec2 first = (rect.Lo + (stride - 1)) / stride * stride;
  for (int y = first.y; y < rect.Hi.y && tile.Begun; y += stride)
  {
    glm::vec4* const row = &this->Pixels.At(rect.Lo.x, y) - rect.Lo.x;
    for (int x = first.x; x < rect.Hi.x; x += stride)
    {
      // Those that are not cast stay as RayTile::Open has made them: nothing.
      row[x].a = (tile.Cast & ReusedRays::BitOf(x, y)) != 0 ? 1.0f - row[x].a : 0.0f;
    }
  }
  tile.Final = true;
  if (this->Watcher)
  {
    this->Watcher->TileIsFinal(number);
  }
}

} // namespace banyan
