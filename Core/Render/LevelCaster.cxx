#include "Render/LevelCaster.h"

#include "Base/ThreadPool.h"
#include "Render/FunctionTables.h"
#include "Render/PictureWatcher.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <atomic>

namespace banyan
{
namespace
{

static_assert(TileSamplings::Edge == RayTile::Edge, "a tile has one sampling");
/// Bricks loaded before the rays that have become opaque are looked at again.
constexpr std::size_t BricksPerBatch = 512;

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
  this->Grid = TileGrid(this->Picture->Rect);
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
  const auto workers = static_cast<std::size_t>(this->Pool.Width());
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
    if (!this->AnyRayOpen(brick, !isThere && this->Source.LoadBytes(brick.Number) > 0))
    {
      ++this->Statistics.BricksSkipped;
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
                     : this->Source.LoadBytes(brick.Number) +
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
                     : this->Source.Kept().Find(this->Source.KeptNumber(brick.Number), brick.Cells,
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
      open = open || !lookAtPixels;
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

void LevelCaster::DrawBatch()
{
  this->Pool.ParallelFor(static_cast<std::int64_t>(this->Batch.size()),
    [this](std::int64_t i) { this->Load(*this->Batch[i], this->Loaded[i]); });
  const auto uniform = std::count_if(this->Batch.begin(), this->Batch.end(),
    [](const PlannedBrick* brick) { return brick->Entry.has_value(); });
  this->Statistics.BricksUniform += uniform;
  this->Statistics.BricksDrawn += static_cast<std::int64_t>(this->Batch.size()) - uniform;

  for (BatchMeter& meter : this->Meters)
  {
    meter.Reset(this->Scene.Work ? this->Batch.size() : 0);
  }
  const auto now = [this] { return this->Scene.Work ? this->Scene.Work->Clock() : 0.0; };
  const double began = now();
  double watched = 0.0; // of the thread that casts, in which it drew nothing
  std::atomic<std::int64_t> samples{ 0 };
  const std::function<void(std::int64_t, int)> draw = [&](std::int64_t number, int worker)
  {
    const auto tile = static_cast<std::size_t>(number);
    const bool any = !this->Tiles[tile].Bricks.empty();
    if (any)
    {
      const auto mine = static_cast<std::size_t>(worker);
      samples += this->DrawTile(tile, this->Scratch[mine], this->Meters[mine]);
    }
    this->FinishTile(tile);
    // The first worker is the thread that casts.
    if (any && this->Watcher && worker == 0)
    {
      const double from = now();
      this->Watcher->BetweenTiles();
      watched += now() - from;
    }
  };
  this->Pool.ParallelFor(static_cast<std::int64_t>(this->Tiles.size()), draw);
  this->Statistics.SamplesTaken += samples;
  // Meanwhile the others have drawn its tiles.
  this->RecordWork(began + watched / this->Pool.Width());
  this->Loaded.clear();
}

/// Makes opacities of the transmittances of a tile of this level, once, if nothing that is not in
/// the batch comes over it any more.
void LevelCaster::FinishTile(std::size_t number)
{
  Tile& tile = this->Tiles[number];
  if (!tile.Sampling || tile.Final || !(tile.Done || tile.End <= this->Taken))
  {
    return;
  }
  const PixelRect rect = this->Grid.RectOf(number);
  for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
  {
    glm::vec4* const row = &this->Picture->At(rect.Lo.x, y);
    for (int x = 0; x < rect.Size().x; ++x)
    {
      row[x].a = 1.0f - row[x].a;
    }
  }
  tile.Final = true;
  if (this->Watcher)
  {
    this->Watcher->TileIsFinal(number);
  }
}

/// @param began when drawing the batch did
void LevelCaster::RecordWork(double began)
{
  if (!this->Scene.Work)
  {
    return;
  }
  this->Scene.Work->DrawSeconds += this->Scene.Work->Clock() - began;
  std::vector<Box> cells;
  for (const PlannedBrick* brick : this->Batch)
  {
    cells.push_back(brick->Drawn);
  }
  AddBatch(
    *this->Scene.Work, this->Meters, cells, this->Source.CellLevel(), this->Scene.DomainCells);
}

/// @return samples taken
std::int64_t LevelCaster::DrawTile(std::size_t number, RayTile& rays, BatchMeter& meter)
{
  Tile& tile = this->Tiles[number];
  rays.Open(tile.Sampling->Lattice, this->Grid.RectOf(number), *this->Picture,
    this->TransmittanceLimit(), tile.PixelStride);
  rays.CellShift = this->Source.CoarsestBrickLevel();
  if (meter.IsOn())
  {
    meter.Start();
  }
  for (const int position : tile.Bricks)
  {
    if (rays.ActiveRays == 0)
    {
      break;
    }
    const PlannedBrick& brick = *this->Batch[static_cast<std::size_t>(position)];
    rays.BrickShift = rays.CellShift - brick.Level;
    const LoadedBrick& loaded = this->Loaded[static_cast<std::size_t>(position)];
    this->DrawBrick(brick, loaded, *tile.Sampling, rays);
    if (meter.IsOn())
    {
      const PixelRect& drawn = loaded.Packed ? loaded.Footprint : brick.Footprint;
      meter.Lap(
        position, rays.SamplesTaken, Intersection(drawn, this->Grid.RectOf(number)).Count());
    }
  }
  if (meter.IsOn())
  {
    meter.Finish(this->Grid.RectOf(number).Count());
  }
  rays.Close(*this->Picture);
  tile.Done = rays.ActiveRays == 0;
  return rays.SamplesTaken;
}

void LevelCaster::DrawBrick(const PlannedBrick& brick, const LoadedBrick& loaded,
  const Sampled& sampling, RayTile& rays) const
{
  const ProjectionTable* const projection = sampling.Projection.get();
  if (brick.Entry)
  {
    const bool fits = rays.PacketsFit && PackedBrick::CanPack(brick.Cells);
    const auto march = fits ? MarchUniform : MarchUniformPlain;
    march(brick.Drawn, sampling.Table, *brick.Entry, brick.Footprint, rays);
  }
  else if (!loaded.Packed)
  {
    const glm::ivec3 corner = this->Source.CellsOf(brick.Number).Lo;
    const BrickPart part{ loaded.View, corner, brick.Drawn };
    projection ? ProjectBrick(part, *projection, brick.Footprint, rays)
               : MarchBrick(part, sampling.Table, brick.Footprint, rays, this->Scene.Interpolation);
  }
  else if (projection)
  {
    this->ProjectPackedBrick(brick, *loaded.Packed, *projection, rays);
  }
  else
  {
    const auto march = rays.PacketsFit ? MarchPacked : MarchUnpacked;
    march(*loaded.Packed, loaded.Seen, sampling.Table, this->Shading.get(), loaded.Footprint, rays,
      this->Scene.Interpolation);
  }
}

void LevelCaster::ProjectPackedBrick(const PlannedBrick& brick, const PackedBrick& packed,
  const ProjectionTable& projection, RayTile& rays) const
{
  if (rays.PacketsFit)
  {
    const ValueRange range = this->Source.RangeOf(brick.Number);
    ProjectPacked(packed, brick.Drawn, range, projection, brick.Footprint, rays);
  }
  else
  {
    ProjectUnpacked(packed, brick.Drawn, projection, brick.Footprint, rays);
  }
}

} // namespace banyan
