#include "Render/LevelCaster.h"

#include "Base/ThreadPool.h"
#include "Render/FunctionTables.h"

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
    this->ForTilesUnder(
      this->Bricks[i].Footprint, [i](Tile& tile, const PixelRect&) { tile.End = i + 1; });
  }
  // What a tile does not use of its slots need not be set.
  this->Scratch.reset(new RayTile[workers]);
  this->Meters.resize(workers);
}

/// Calls function(tile, rect) for the tiles under a footprint that have rays left.
template <class Function>
void LevelCaster::ForTilesUnder(const PixelRect& footprint, Function&& function)
{
  this->Grid.ForEachUnder(footprint,
    [&](std::size_t number)
    {
      if (!this->Tiles[number].Done)
      {
        function(this->Tiles[number], this->Grid.RectOf(number));
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
  for (Tile& tile : this->Tiles)
  {
    tile.Bricks.clear();
  }
  const std::uint64_t left = this->BytesLeft();
  std::uint64_t bytes = 0;
  std::size_t next = first;
  for (; next < this->Bricks.size(); ++next)
  {
    const PlannedBrick& brick = this->Bricks[next];
    KeptBricks::Pointer kept = this->FindKept(brick);
    const bool isThere = kept || brick.Entry;
    const std::uint64_t brickBytes = isThere ? 0 : this->BytesOf(brick);
    const bool full = bytes + brickBytes > left || this->Batch.size() >= BricksPerBatch;
    if (full && !this->Batch.empty())
    {
      break;
    }
    // What is in memory anyway costs less to draw than to look for open pixels.
    if (!this->AnyRayOpen(brick, !isThere && this->LoadBytesOf(brick) > 0))
    {
      this->Statistics.BricksSkipped += BricksIn(brick);
      continue;
    }
    const int position = static_cast<int>(this->Batch.size());
    this->ForTilesUnder(brick.Footprint,
      [position](Tile& tile, const PixelRect&) { tile.Bricks.push_back(position); });
    this->Batch.push_back(&brick);
    this->Loaded.emplace_back();
    this->Loaded.back().Packed = std::move(kept);
    bytes += brickBytes;
  }
  return next;
}

/// As loaded and as packed.
std::uint64_t LevelCaster::BytesOf(const PlannedBrick& brick) const
{
  return brick.Entry ? 0
                     : this->LoadBytesOf(brick) +
                         PackedBrick::BytesFor(brick.Cells, this->Shading != nullptr);
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

/// Null for bricks that are not kept, or need not be.
KeptBricks::Pointer LevelCaster::FindKept(const PlannedBrick& brick) const
{
  return brick.Entry ? nullptr
                     : this->Source.Kept().Find(this->KeptNumberOf(brick), brick.Cells,
                         this->AnySampling->Table.Low(), this->Shading != nullptr);
}

/// Whether a tile under a brick has rays left; if asked to look at pixels, whether one of them has
/// not reached the opacity limit, or a better rank.
bool LevelCaster::AnyRayOpen(const PlannedBrick& brick, bool lookAtPixels)
{
  const float limit = this->TransmittanceLimit();
  const ProjectionTable* const projection = this->AnySampling->Projection.get();
  const bool ranked = projection && !projection->Averages();
  const auto isOpen = [&](const glm::vec4& pixel)
  { return ranked ? pixel.r < brick.HighestRank : pixel.a > limit; };
  bool open = false;
  this->ForTilesUnder(brick.Footprint,
    [&](const Tile& tile, const PixelRect& rect)
    {
      const PixelRect part = Intersection(brick.Footprint, rect);
      const int stride = tile.PixelStride;
      const glm::ivec2 first = (part.Lo + (stride - 1)) / stride * stride;
      open = open || !lookAtPixels || !tile.Begun;
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
