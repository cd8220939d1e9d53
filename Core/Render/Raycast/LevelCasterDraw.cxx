// SPDX-License-Identifier: BSD-3-Clause
#include "Base/ThreadPool.h"
#include "Render/Raycast/LevelCaster.h"
#include "Render/Raycast/PictureWatcher.h"

#include <algorithm>
#include <atomic>

namespace banyan
{
namespace
{

/// More than the last cache of a processor holds, usually. Of fewer bytes most are still there from
/// the picture before: to ask for them takes longer than it saves.
constexpr std::size_t CacheBytes = std::size_t{ 48 } << 20;
/// Pixels from ray to ray, at most, where caches are asked for all that lies between.
constexpr int DensePixels = 2;

} // namespace

void LevelCaster::DrawBatch()
{
  this->Pool.ParallelFor(static_cast<std::int64_t>(this->Batch.size()),
    [this](std::int64_t i) { this->Load(*this->Batch[i], this->Loaded[i]); });
  for (const PlannedBrick* brick : this->Batch)
  {
    (brick->Entry ? this->Statistics.BricksUniform : this->Statistics.BricksDrawn) +=
      BricksIn(*brick);
  }
  std::size_t packed = 0;
  for (const LoadedBrick& loaded : this->Loaded)
  {
    packed += loaded.Packed ? loaded.Packed->Bytes() : 0;
  }
  // Rays of pilots are far apart, and most of what lies between them is not needed.
  this->AsksAhead = packed > CacheBytes && !this->Scene.Pilot;

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
    const bool any = this->Tiles[tile].EndOfBricks > this->Tiles[tile].FirstBrick;
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

void LevelCaster::ClearTile(const PixelRect& rect) const
{
  for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
  {
    std::fill_n(&this->Picture->At(rect.Lo.x, y), rect.Size().x, glm::vec4(0.0f));
  }
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
  if (tile.Begun)
  {
    const int stride = tile.PixelStride;
    const glm::ivec2 first = (rect.Lo + (stride - 1)) / stride * stride;
    for (int y = first.y; y < rect.Hi.y; y += stride)
    {
      glm::vec4* const row = &this->Picture->At(rect.Lo.x, y) - rect.Lo.x;
      for (int x = first.x; x < rect.Hi.x; x += stride)
      {
        row[x].a = 1.0f - row[x].a;
      }
    }
  }
  else
  {
    this->ClearTile(rect);
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
  std::vector<WorkShare> shares;
  for (std::size_t i = 0; i < this->Batch.size(); ++i)
  {
    this->ShareWork(i, shares);
  }
  AddBatch(
    *this->Scene.Work, this->Meters, shares, this->Source.CellLevel(), this->Scene.DomainCells);
}

/// What several bricks took that were drawn as one is theirs by what can be seen of each: the part
/// of its cells, and of the screen.
void LevelCaster::ShareWork(std::size_t number, std::vector<WorkShare>& shares) const
{
  const PlannedBrick& brick = *this->Batch[number];
  if (brick.Together.Empty())
  {
    shares.push_back({ number, brick.Drawn });
    return;
  }
  const BrickVisibility& seen = this->Loaded[number].Seen;
  const std::size_t first = shares.size();
  double all = 0.0;
  this->ForBricksOf(brick,
    [&](std::int64_t member)
    {
      const Box cells = Intersection(this->Source.CellsOf(member), brick.Drawn);
      const PixelRect pixels = Intersection(this->FootprintOf(cells), this->Scene.Viewport);
      const double visible = seen.Holes ? seen.MacrosIn(cells, brick.Cells.Lo) : 1.0;
      const double part = visible * static_cast<double>(pixels.Count());
      shares.push_back({ number, cells, all, all + part });
      all += part;
    });
  for (std::size_t i = first; i < shares.size(); ++i)
  {
    const auto count = static_cast<double>(shares.size() - first);
    const auto before = static_cast<double>(i - first);
    shares[i].From = all > 0.0 ? shares[i].From / all : before / count;
    shares[i].To = all > 0.0 ? shares[i].To / all : (before + 1.0) / count;
  }
}

/// The pixels of a tile that bricks of the batch may change: all of them if bricks of later batches
/// lie over it, for it is not known which rays these need.
PixelRect LevelCaster::DrawnPixelsOf(const Tile& tile, const PixelRect& rect) const
{
  if (tile.End > this->Taken)
  {
    return rect;
  }
  PixelRect drawn;
  for (std::size_t i = tile.FirstBrick; i < tile.EndOfBricks; ++i)
  {
    const auto position = static_cast<std::size_t>(this->BricksOfTiles[i]);
    drawn = Union(drawn, Intersection(this->PixelsOf(position), rect));
  }
  return drawn;
}

/// Of a brick of the batch: those that it is drawn to.
const PixelRect& LevelCaster::PixelsOf(std::size_t position) const
{
  const LoadedBrick& loaded = this->Loaded[position];
  return loaded.Packed ? loaded.Footprint : this->Batch[position]->Footprint;
}

/// @return samples taken
std::int64_t LevelCaster::DrawTile(std::size_t number, RayTile& rays, BatchMeter& meter)
{
  Tile& tile = this->Tiles[number];
  const PixelRect rect = this->Grid.RectOf(number);
  const PixelRect drawn = this->DrawnPixelsOf(tile, rect);
  if (drawn.Empty())
  {
    return 0;
  }
  rays.Open(tile.Sampling->Lattice, rect, *this->Picture, this->TransmittanceLimit(),
    tile.PixelStride, tile.Begun, drawn);
  rays.CellShift = this->Source.CoarsestBrickLevel();
  if (meter.IsOn())
  {
    meter.Start();
  }
  const bool asks = this->AsksAhead && tile.PixelStride <= DensePixels;
  const CornerRays corners = asks ? this->CornersOf(drawn) : CornerRays{};
  for (std::size_t i = tile.FirstBrick; i < tile.EndOfBricks; ++i)
  {
    if (rays.ActiveRays == 0)
    {
      break;
    }
    rays.Ahead =
      asks && i + 1 < tile.EndOfBricks ? this->Ahead(i, corners, rect, rays) : BrickAhead();
    const int position = this->BricksOfTiles[i];
    const PlannedBrick& brick = *this->Batch[static_cast<std::size_t>(position)];
    rays.BrickShift = rays.CellShift - brick.Level;
    const LoadedBrick& loaded = this->Loaded[static_cast<std::size_t>(position)];
    this->DrawBrick(brick, loaded, *tile.Sampling, rays);
    if (meter.IsOn())
    {
      const PixelRect& pixels = this->PixelsOf(static_cast<std::size_t>(position));
      meter.Lap(position, rays.SamplesTaken, Intersection(pixels, rect).Count());
    }
  }
  if (meter.IsOn())
  {
    meter.Finish(rect.Count());
  }
  if (!tile.Begun && tile.PixelStride > 1)
  {
    this->ClearTile(rect);
  }
  rays.Close(*this->Picture);
  tile.Begun = true;
  tile.Done = rays.ActiveRays == 0;
  return rays.SamplesTaken;
}

CornerRays LevelCaster::CornersOf(const PixelRect& rect) const
{
  const glm::ivec2 last = rect.Hi - 1;
  return { this->IndexCamera.RayOf(rect.Lo.x, rect.Lo.y),
    this->IndexCamera.RayOf(last.x, rect.Lo.y), this->IndexCamera.RayOf(rect.Lo.x, last.y),
    this->IndexCamera.RayOf(last.x, last.y) };
}

/// What asks the caches for the brick that comes behind another one.
/// @param place of the one before it, in BricksOfTiles; not a tile's last one
/// @param corners of the tile
/// @param rect of the tile
BrickAhead LevelCaster::Ahead(
  std::size_t place, const CornerRays& corners, const PixelRect& rect, const RayTile& rays) const
{
  const auto position = static_cast<std::size_t>(this->BricksOfTiles[place + 1]);
  const LoadedBrick& next = this->Loaded[position];
  // Rays are in cells of the source, which those of the brick may be smaller than.
  if (!next.Packed || this->Batch[position]->Level != 0)
  {
    return {};
  }
  const auto now = static_cast<std::size_t>(this->BricksOfTiles[place]);
  const PixelRect packets = rays.PacketsUnder(Intersection(this->PixelsOf(now), rect));
  return { *next.Packed, next.Seen.Cells, corners, packets.Count() };
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
    const BrickPart part{ loaded.View, corner, brick.Drawn, &loaded.Hidden };
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
    const ValueRange range = this->RangeOf(brick);
    ProjectPacked(packed, brick.Drawn, range, projection, brick.Footprint, rays);
  }
  else
  {
    ProjectUnpacked(packed, brick.Drawn, projection, brick.Footprint, rays);
  }
}

} // namespace banyan
