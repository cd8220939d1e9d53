// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/BatchDrawer.h"

#include "Base/StopFlag.h"
#include "Base/ThreadPool.h"
#include "Render/Levels/PictureWatcher.h"
#include "Render/Raycast/BrickProjector.h"

#include <atomic>
#include <functional>

namespace banyan
{
namespace
{

/// More than the last cache of a processor holds, usually. If a batch has fewer bytes, most of them
/// are still there from the picture before: to ask for them takes longer than it saves.
constexpr std::size_t CacheBytes = std::size_t{ 48 } << 20;
/// Pixels from ray to ray, at most, where caches are asked for all that lies between.
constexpr int DensePixels = 2;

std::size_t PackedBytes(const BrickBatch& batch)
{
  std::size_t bytes = 0;
  for (const LoadedBrick& brick : batch.Bricks)
  {
    bytes += brick.Packed ? brick.Packed->Bytes() : 0;
  }
  return bytes;
}

} // namespace

// Scratch is not set: a tile does not read slots that it did not write.
BatchDrawer::BatchDrawer(
  const LevelScene& level, LevelTiles& tiles, PictureWatcher* watcher, ThreadPool& pool)
  : Level(level)
  , Tiles(tiles)
  , Watcher(watcher)
  , Pool(pool)
  , Scratch(new RayTile[static_cast<std::size_t>(pool.Width())])
  , Meters(static_cast<std::size_t>(pool.Width()))
  , Logs(level.Scene.Segments ? static_cast<std::size_t>(pool.Width()) : 0)
{
  for (std::size_t i = 0; i < this->Logs.size(); ++i)
  {
    this->Scratch[i].Log = &this->Logs[i];
  }
}

std::int64_t BatchDrawer::Draw(const BrickBatch& batch)
{
  // Rays of probes are far apart, and most of what lies between them is not needed.
  const bool prefetch = !this->Level.Scene.Probe && PackedBytes(batch) > CacheBytes;
  BrickWork* const work = this->Level.Scene.Work;
  for (BatchMeter& meter : this->Meters)
  {
    meter.Reset(work ? batch.Bricks.size() : 0);
  }
  const auto now = [work] { return work ? work->Clock() : 0.0; };
  const double began = now();
  double watched = 0.0; // of the thread that casts, in which it drew nothing
  std::atomic<std::int64_t> samples{ 0 };
  const std::function<void(std::int64_t, int)> draw = [&](std::int64_t number, int worker)
  {
    const auto tile = static_cast<std::size_t>(number);
    const bool any = !batch.Over(tile).Empty();
    if (any)
    {
      const auto mine = static_cast<std::size_t>(worker);
      samples += this->DrawTile(batch, tile, this->Scratch[mine], this->Meters[mine], prefetch);
    }
    this->Tiles.Finish(tile, batch.End);
    // The first worker is the thread that casts.
    if (any && this->Watcher && worker == 0)
    {
      const double from = now();
      this->Watcher->BetweenTiles();
      watched += now() - from;
    }
  };
  this->Pool.ParallelFor(static_cast<std::int64_t>(this->Tiles.Count()), draw);
  if (work)
  {
    // While one thread watched, the others have drawn its tiles.
    this->RecordWork(batch, began + watched / this->Pool.Width());
  }
  return samples;
}

/// @param prefetch whether caches are asked for bricks before they are drawn
/// @return samples taken
std::int64_t BatchDrawer::DrawTile(const BrickBatch& batch, std::size_t number, RayTile& rays,
  BatchMeter& meter, bool prefetch) const
{
  LevelTile& tile = this->Tiles[number];
  const PixelRect rect = this->Tiles.RectOf(number);
  const PixelRect drawn = this->DrawnPixels(batch, number);
  if (drawn.Empty())
  {
    return 0;
  }
  FloatImage& picture = this->Tiles.Picture();
  rays.Open(tile.Sampling->Lattice, rect, picture, this->Level.TransmittanceLimit(),
    tile.PixelStride, tile.Begun, drawn, tile.Cast);
  rays.CellShift = this->Level.Source.CoarsestBrickLevel();
  this->DrawBricks(batch, number, drawn, rays, meter, prefetch && tile.PixelStride <= DensePixels);
  if (rays.Log)
  {
    this->Level.Scene.Segments->Add(
      rays.Log->Take(this->Tiles.Cut().PositionOf(number), rays, tile.Sampling->Distance));
  }
  if (!tile.Begun && tile.PixelStride > 1)
  {
    this->Tiles.Clear(rect);
  }
  rays.Close(picture);
  tile.Begun = true;
  tile.Done = rays.ActiveRays == 0;
  return rays.SamplesTaken;
}

/// The pixels of a tile that bricks of the batch may change: all of them if bricks of later batches
/// lie over it, for it is not known which rays these need.
PixelRect BatchDrawer::DrawnPixels(const BrickBatch& batch, std::size_t number) const
{
  const PixelRect rect = this->Tiles.RectOf(number);
  if (this->Tiles[number].End > batch.End)
  {
    return rect;
  }
  PixelRect drawn;
  for (const int position : batch.Over(number))
  {
    const LoadedBrick& brick = batch.Bricks[static_cast<std::size_t>(position)];
    drawn = Union(drawn, Intersection(brick.Pixels(), rect));
  }
  return drawn;
}

/// Draws the bricks over a tile, until all rays have ended. While one is drawn, the caches are
/// asked for the next one.
void BatchDrawer::DrawBricks(const BrickBatch& batch, std::size_t number, const PixelRect& drawn,
  RayTile& rays, BatchMeter& meter, bool prefetch) const
{
  const PixelRect rect = this->Tiles.RectOf(number);
  const LevelSampling& sampling = *this->Tiles[number].Sampling;
  if (meter.IsOn())
  {
    meter.Start();
  }
  const CornerRays corners = prefetch ? this->CornersOf(drawn) : CornerRays{};
  const BrickBatch::Positions over = batch.Over(number);
  for (std::size_t i = 0; i < over.Count() && rays.ActiveRays != 0; ++i)
  {
    const LoadedBrick& brick = batch.Bricks[static_cast<std::size_t>(over[i])];
    const PixelRect pixels = Intersection(brick.Pixels(), rect);
    rays.Ahead = BrickPrefetcher();
    if (prefetch && i + 1 < over.Count())
    {
      const LoadedBrick& next = batch.Bricks[static_cast<std::size_t>(over[i + 1])];
      // Rays are in cells of the source, which those of the brick may be smaller than.
      if (next.Packed && next.Planned->Level == 0)
      {
        rays.Ahead = BrickPrefetcher(
          *next.Packed, next.Seen.Cells, corners, rays.PacketsUnder(pixels).Count());
      }
    }
    rays.BrickShift = rays.CellShift - brick.Planned->Level;
    if (this->Level.Scene.Stop)
    {
      this->Level.Scene.Stop->Check();
    }
    this->DrawBrick(brick, sampling, rays);
    if (meter.IsOn())
    {
      meter.Lap(over[i], rays.SamplesTaken, pixels.Count());
    }
  }
  if (meter.IsOn())
  {
    meter.Finish(rect.Count());
  }
}

/// Draws a brick with the fastest kernel that fits: none of samples where all are equal, packets of
/// rays where it is packed, one ray after the other elsewhere.
void BatchDrawer::DrawBrick(
  const LoadedBrick& brick, const LevelSampling& sampling, RayTile& rays) const
{
  const PlannedBrick& planned = *brick.Planned;
  const SampleInterpolation interpolation = this->Level.Scene.Interpolation;
  if (planned.Entry)
  {
    const bool fits = rays.PacketsFit && PackedBrick::CanPack(planned.Cells);
    const auto march = fits ? MarchUniform : MarchUniformPlain;
    march(planned.Drawn, sampling.Table, *planned.Entry, planned.Footprint, rays);
  }
  else if (sampling.Projection)
  {
    this->DrawProjected(brick, *sampling.Projection, rays);
  }
  else if (!brick.Packed)
  {
    const glm::ivec3 corner = this->Level.Source.CellsOf(planned.Number).Lo;
    MarchBrick({ brick.View, corner, planned.Drawn, &brick.Hidden }, sampling.Table,
      planned.Footprint, rays, interpolation);
  }
  else
  {
    const auto march = rays.PacketsFit ? MarchPacked : MarchUnpacked;
    march(*brick.Packed, brick.Seen, sampling.Table, this->Level.Shading.get(), brick.Footprint,
      rays, interpolation);
  }
}

void BatchDrawer::DrawProjected(
  const LoadedBrick& brick, const ProjectionTable& projection, RayTile& rays) const
{
  const PlannedBrick& planned = *brick.Planned;
  if (!brick.Packed)
  {
    const glm::ivec3 corner = this->Level.Source.CellsOf(planned.Number).Lo;
    ProjectBrick(
      { brick.View, corner, planned.Drawn, &brick.Hidden }, projection, planned.Footprint, rays);
  }
  else if (rays.PacketsFit)
  {
    const ValueRange range = planned.RangeIn(this->Level.Source);
    ProjectPacked(*brick.Packed, planned.Drawn, range, projection, planned.Footprint, rays);
  }
  else
  {
    ProjectUnpacked(*brick.Packed, planned.Drawn, projection, planned.Footprint, rays);
  }
}

CornerRays BatchDrawer::CornersOf(const PixelRect& rect) const
{
  const RayCamera& camera = this->Level.IndexCamera;
  const glm::ivec2 last = rect.Hi - 1;
  return { camera.RayOf(rect.Lo.x, rect.Lo.y), camera.RayOf(last.x, rect.Lo.y),
    camera.RayOf(rect.Lo.x, last.y), camera.RayOf(last.x, last.y) };
}

/// @param began when drawing the batch did
void BatchDrawer::RecordWork(const BrickBatch& batch, double began) const
{
  BrickWork& work = *this->Level.Scene.Work;
  work.DrawSeconds += work.Clock() - began;
  std::vector<WorkShare> shares;
  for (std::size_t i = 0; i < batch.Bricks.size(); ++i)
  {
    this->ShareWork(batch, i, shares);
  }
  AddBatch(
    work, this->Meters, shares, this->Level.Source.CellEdges(), this->Level.Scene.DomainCells);
}

/// Divides the work of bricks that were drawn as one among them, by what can be seen of each: the
/// part of its cells, and of the screen.
void BatchDrawer::ShareWork(
  const BrickBatch& batch, std::size_t position, std::vector<WorkShare>& shares) const
{
  const LoadedBrick& brick = batch.Bricks[position];
  const PlannedBrick& planned = *brick.Planned;
  if (planned.Together.Empty())
  {
    shares.push_back({ position, planned.Drawn });
    return;
  }
  const BrickVisibility& seen = brick.Seen;
  const std::size_t first = shares.size();
  double all = 0.0;
  planned.ForEach(this->Level.Source,
    [&](std::int64_t member)
    {
      const Box cells = Intersection(this->Level.Source.CellsOf(member), planned.Drawn);
      const PixelRect pixels =
        Intersection(this->Level.FootprintOf(cells), this->Level.Scene.Viewport);
      const double visible = seen.Holes ? seen.MacrosIn(cells, planned.Cells.Lo) : 1.0;
      const double part = visible * static_cast<double>(pixels.Count());
      shares.push_back({ position, cells, all, all + part });
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

} // namespace banyan
