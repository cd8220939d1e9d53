// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/LevelCaster.h"

#include "Base/ThreadPool.h"
#include "Render/Scene/FunctionTables.h"

#include <glm/matrix.hpp>

#include <algorithm>

namespace banyan
{
namespace
{

static_assert(TileSamplings::Edge == RayTile::Edge, "a tile has one sampling");
/// Bricks loaded before the rays that have become opaque are looked at again.
constexpr std::size_t BricksPerBatch = 512;
/// Pilots have so few pixels that threads would wait for each other: they are cut into smaller
/// tiles until there are so many for each thread, and no further than this.
constexpr std::size_t TilesPerThread = 4;
constexpr int SmallestEdge = 8;
/// Kept bricks that a thread looks for in one go.
constexpr std::size_t FoundTogether = 64;

} // namespace

LevelCaster::Sampled::Sampled(const RayScene& scene, double distance, const BrickSource& source)
  : Lattice(scene, { source.CellLevel() + source.CoarsestBrickLevel(), distance },
      source.CoarsestBrickLevel())
  , Steps(FunctionTables::Process().StepsOf(scene.Transfer, distance))
  , Table(*Steps)
{
  if (scene.Blend.Mode != BlendMode::Composite)
  {
    this->Projection = std::make_unique<const ProjectionTable>(scene, this->Table);
  }
}

LevelCaster::LevelCaster(const RayScene& scene, BrickSource& source, const Box& cells,
  std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics)
  : Scene(scene)
  , Source(source)
  , Cells(cells)
  , BudgetBytes(budgetBytes)
  , Pool(pool)
  , Statistics(statistics)
  , VisibleOfFunction(FunctionTables::Process().VisibleOf(scene.Transfer))
  , Visible(*VisibleOfFunction)
  , IndexToWorld(IndexToWorldAt(scene, source.CellLevel()))
  , IndexCamera(scene.Camera.InSpace(IndexToWorld))
  , ClipPlanes(PlanesInIndexSpace(scene.ClipPlanes, IndexToWorld))
{
  if (scene.Shading.On && scene.Blend.Mode == BlendMode::Composite)
  {
    this->Shading = std::make_unique<const ShadingTable>(
      scene.Shading, glm::dmat3(glm::inverse(this->IndexToWorld)));
  }
  this->AddSamplings();
  this->Plan();
}

void LevelCaster::Draw(FloatImage& picture, PictureWatcher* watcher)
{
  this->Picture = &picture;
  this->Watcher = watcher;
  this->MakeTiles();
  this->FindKept();
  while (this->Taken < this->Bricks.size())
  {
    this->Taken = this->TakeBatch(this->Taken);
    if (!this->Batch.empty())
    {
      this->DrawBatch();
    }
  }
  for (std::size_t tile = 0; tile < this->Tiles.size(); ++tile)
  {
    this->FinishTile(tile);
  }
}

void LevelCaster::MakeTiles()
{
  const auto workers = static_cast<std::size_t>(this->Pool.Width());
  this->Grid = TileGrid(this->Picture->Rect);
  for (int edge = RayTile::Edge / 2; this->Scene.Pilot && workers > 1 && edge >= SmallestEdge &&
                                     this->Grid.Count() < TilesPerThread * workers;
       edge /= 2)
  {
    this->Grid = TileGrid(this->Picture->Rect, edge);
  }
  this->Tiles.resize(this->Grid.Count());
  for (std::size_t i = 0; i < this->Tiles.size(); ++i)
  {
    const int sampling =
      this->Scene.Samplings ? this->Scene.Samplings->NumberAt(this->Grid.PositionOf(i)) : 0;
    this->Tiles[i].Sampling = this->Samplings.at(static_cast<std::size_t>(sampling)).get();
    this->Tiles[i].PixelStride =
      this->Scene.Samplings
        ? this->Scene.Samplings->Samplings()[static_cast<std::size_t>(sampling)].PixelStride
        : 1;
    this->Tiles[i].Done = this->Tiles[i].Sampling == nullptr;
  }
  for (std::size_t i = 0; i < this->Bricks.size(); ++i)
  {
    this->ForTilesUnder(this->Bricks[i].Footprint,
      [&](std::size_t number, const PixelRect&) { this->Tiles[number].End = i + 1; });
  }
  // What a tile does not use of its slots need not be set.
  this->Scratch.reset(new RayTile[workers]);
  this->Meters.resize(workers);
}

/// Calls function(number, rect) for the tiles under a footprint that have rays left.
template <class Function>
void LevelCaster::ForTilesUnder(const PixelRect& footprint, Function&& function)
{
  this->Grid.ForEachUnder(footprint,
    [&](std::size_t number)
    {
      if (!this->Tiles[number].Done)
      {
        function(number, this->Grid.RectOf(number));
      }
    });
}

/// What the budget leaves beside the bricks that are kept.
std::uint64_t LevelCaster::BytesLeft() const
{
  return this->BudgetBytes - std::min(this->BudgetBytes, this->Source.Kept().Bytes());
}

/// Puts bricks from number `first` on into the batch, as many as the budget allows but at least
/// one, and enters them in the lists of the tiles. @return the first brick of the next batch
std::size_t LevelCaster::TakeBatch(std::size_t first)
{
  this->Batch.clear();
  this->Loaded.clear();
  std::vector<std::size_t> tiles; // under the bricks of the batch
  std::vector<std::size_t> ends;  // of each brick's
  const std::uint64_t left = this->BytesLeft();
  std::uint64_t bytes = 0;
  std::size_t unkept = 0;
  std::size_t next = first;
  for (; next < this->Bricks.size(); ++next)
  {
    const PlannedBrick& brick = this->Bricks[next];
    KeptBricks::Found& kept = this->Kept[next];
    const bool isThere = kept.Packed || brick.Entry;
    const std::uint64_t brickBytes = isThere ? 0 : this->BytesOf(brick);
    const bool full = bytes + brickBytes > left || (!isThere && unkept >= BricksPerBatch);
    if (full && !this->Batch.empty())
    {
      break;
    }
    const std::size_t before = tiles.size();
    this->ForTilesUnder(
      brick.Footprint, [&](std::size_t number, const PixelRect&) { tiles.push_back(number); });
    // What is in memory anyway costs less to draw than to look for open pixels.
    const bool look = !isThere && this->LoadBytesOf(brick) > 0;
    if (tiles.size() == before || (look && !this->AnyRayOpen(brick)))
    {
      tiles.resize(before);
      this->Statistics.BricksSkipped += BricksIn(brick);
      continue;
    }
    ends.push_back(tiles.size());
    this->Batch.push_back(&brick);
    this->Loaded.emplace_back();
    this->Loaded.back().Packed = std::move(kept.Packed);
    this->Loaded.back().Known = std::move(kept.Visibility);
    unkept += isThere ? 0 : 1;
    bytes += brickBytes;
  }
  this->EnterInTiles(tiles, ends);
  return next;
}

/// Makes the lists of the tiles.
/// @param tiles under the first brick of the batch, under the second, and so on
/// @param ends of each brick's tiles in these
void LevelCaster::EnterInTiles(
  const std::vector<std::size_t>& tiles, const std::vector<std::size_t>& ends)
{
  std::vector<std::size_t> counts(this->Tiles.size(), 0);
  for (const std::size_t tile : tiles)
  {
    ++counts[tile];
  }
  std::size_t first = 0;
  for (std::size_t tile = 0; tile < this->Tiles.size(); ++tile)
  {
    this->Tiles[tile].FirstBrick = first;
    this->Tiles[tile].EndOfBricks = first;
    first += counts[tile];
  }
  this->BricksOfTiles.resize(tiles.size());
  std::size_t i = 0;
  for (std::size_t brick = 0; brick < ends.size(); ++brick)
  {
    for (; i < ends[brick]; ++i)
    {
      this->BricksOfTiles[this->Tiles[tiles[i]].EndOfBricks++] = static_cast<int>(brick);
    }
  }
}

/// As loaded and as packed.
std::uint64_t LevelCaster::BytesOf(const PlannedBrick& brick) const
{
  return brick.Entry ? 0
                     : this->LoadBytesOf(brick) +
                         PackedBrick::BytesFor(brick.Cells, this->Shading != nullptr) +
                         (this->Source.Hidden() ? HiddenInBrick::BytesFor(brick.Cells) : 0);
}

std::uint64_t LevelCaster::BytesToDraw() const
{
  std::uint64_t bytes = 0;
  for (const PlannedBrick& brick : this->Bricks)
  {
    bytes += this->BytesOf(brick);
  }
  return bytes;
}

/// Looks which bricks are kept, of those that need to be.
void LevelCaster::FindKept()
{
  const double low = this->AnySampling->Table.Low();
  const bool shaded = this->Shading != nullptr;
  const std::size_t count = this->Bricks.size();
  this->Kept.assign(count, {});
  this->Pool.ParallelFor(static_cast<std::int64_t>((count + FoundTogether - 1) / FoundTogether),
    [&](std::int64_t part)
    {
      const std::size_t first = static_cast<std::size_t>(part) * FoundTogether;
      const std::size_t some = std::min(FoundTogether, count - first);
      KeptBricks::Wanted wanted[FoundTogether];
      for (std::size_t i = 0; i < some; ++i)
      {
        const PlannedBrick& brick = this->Bricks[first + i];
        wanted[i] = { brick.Entry ? -1 : this->KeptNumberOf(brick), brick.Cells, low, shaded };
      }
      this->Source.Kept().Find(wanted, some, this->Visible.Number(), &this->Kept[first]);
    });
}

/// Whether a pixel under a brick has not reached the opacity limit, or a better rank.
bool LevelCaster::AnyRayOpen(const PlannedBrick& brick)
{
  const float limit = this->TransmittanceLimit();
  const ProjectionTable* const projection = this->AnySampling->Projection.get();
  const bool ranked = projection && !projection->Averages();
  const auto isOpen = [&](const glm::vec4& pixel)
  { return ranked ? pixel.r < brick.HighestRank : pixel.a > limit; };
  bool open = false;
  this->ForTilesUnder(brick.Footprint,
    [&](std::size_t number, const PixelRect& rect)
    {
      const Tile& tile = this->Tiles[number];
      const PixelRect part = Intersection(brick.Footprint, rect);
      const int stride = tile.PixelStride;
      const glm::ivec2 first = (part.Lo + (stride - 1)) / stride * stride;
      open = open || !tile.Begun;
      for (int y = first.y; y < part.Hi.y && !open; y += stride)
      {
        for (int x = first.x; x < part.Hi.x && !open; x += stride)
        {
          open = isOpen(this->Picture->At(x, y));
        }
      }
    });
  return open;
}

/// Rays of a projection never end.
float LevelCaster::TransmittanceLimit() const
{
  return this->AnySampling->Projection ? 0.0f : 1.0f - this->Scene.OpacityLimit;
}

} // namespace banyan
