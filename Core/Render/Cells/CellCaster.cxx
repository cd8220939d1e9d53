// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/CellCaster.h"

#include "Base/RecycledMemory.h"
#include "Base/StopFlag.h"
#include "Base/ThreadPool.h"
#include "Render/Cells/RunCollector.h"
#include "Render/Levels/LevelTiles.h"
#include "Render/Levels/PictureWatcher.h"
#include "Render/Raycast/SegmentLog.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <optional>

namespace banyan
{

/// What a thread works with: about 3 MB, most of it the slab. The next picture takes the memory of
/// the one before: to clear its pages takes longer than a small picture.
struct CellCaster::Scratch
{
  static void* operator new(std::size_t bytes) { return LargeMemory::Allocate(bytes); }
  static void operator delete(void* memory, std::size_t bytes) { LargeMemory::Free(memory, bytes); }

  RayTile Rays;
  TileRows Rows;
  SampleSlab Slab;
  alignas(64) float Inside[RayTile::Slots]; ///< see LatticeJob
  std::vector<std::size_t> Begins;          ///< of slabs, in Items
  std::vector<std::uint32_t> Items;         ///< numbers of what is placed, slab by slab
  /// What runs take besides; null where pixels are drawn.
  struct ForRuns
  {
    SlabOwners Owners;
    RunCollector Collector;
  };
  std::unique_ptr<ForRuns> Runs;
  SegmentLog Log;                     ///< where the scene wants segments
  const AskedPixels* Asked = nullptr; ///< cells elsewhere are left out; null for none

  /// Blends the slab, into pixels or runs.
  void Blend(int firstRow, const SlabBlend& blend)
  {
    if (this->Runs)
    {
      BlendSlabInRuns(this->Slab, this->Rows, firstRow, blend, this->Rays, this->Runs->Owners,
        this->Runs->Collector);
    }
    else
    {
      BlendSlab(this->Slab, this->Rows, firstRow, blend, this->Rays);
    }
  }
};

namespace
{

/// @return null where nothing is asked of a tile
const AskedTile* FindTile(const std::vector<AskedTile>& asked, const glm::ivec2& position)
{
  const auto found = std::find_if(
    asked.begin(), asked.end(), [&](const AskedTile& tile) { return tile.Position == position; });
  return found == asked.end() ? nullptr : &*found;
}

} // namespace

CellCaster::CellCaster(const RayScene& scene, CellSource& source, BrickSource& level,
  std::shared_ptr<const MeshLattice> lattice, ThreadPool& pool, RayStatistics& statistics)
  : Level(scene, level)
  , Lattice(std::move(lattice))
  , Field(this->Lattice            ? source.WithBorder(this->Level.IsShaded(), pool)
          : this->Level.IsShaded() ? source.WithGradients(pool)
                                   : source.Cells())
  , Pool(pool)
  , Statistics(statistics)
  , Bins(
      scene, this->Lattice
               ? source.BordersIn(scene, pool)
               : source.SeenIn(scene,
                   scene.Blend.Mode == BlendMode::Composite ? this->Level.Visible : nullptr, pool))
{
}

CellCaster::~CellCaster() = default;

void CellCaster::DrawTiles(FloatImage& picture, PictureWatcher* watcher, const TileShare& share)
{
  const auto workers = static_cast<std::size_t>(this->Pool.Width());
  LevelTiles tiles(this->Level, {}, picture, watcher, workers);
  this->Bins.Sort(tiles.Cut(), this->Pool);
  std::vector<std::unique_ptr<Scratch>> scratch(workers);
  std::atomic<std::int64_t> samples{ 0 };
  const std::function<void(std::int64_t, int)> draw = [&](std::int64_t number, int worker)
  {
    if (this->Level.Scene.Stop)
    {
      this->Level.Scene.Stop->Check();
    }
    std::unique_ptr<Scratch>& mine = scratch[static_cast<std::size_t>(worker)];
    if (!mine)
    {
      mine = std::make_unique<Scratch>();
    }
    const auto tile = static_cast<std::size_t>(number);
    if (!tiles[tile].Done && this->Bins.Over(tile).Count > 0 &&
        share.Has(tiles.Cut().PositionOf(tile)))
    {
      this->DrawTile(tiles, tile, *mine);
      samples += mine->Rays.SamplesTaken;
    }
    tiles.Finish(tile, 0);
    // The first worker is the thread that casts.
    if (watcher && worker == 0)
    {
      watcher->BetweenTiles();
    }
  };
  this->Pool.ParallelFor(static_cast<std::int64_t>(tiles.Count()), draw);
  this->Statistics.SamplesTaken += samples;
  this->CountCells();
}

void CellCaster::CountCells()
{
  this->Statistics.BricksSkipped += this->Bins.Skipped();
  this->Statistics.BricksDrawn +=
    static_cast<std::int64_t>(this->Field.Cells->Order.size()) - this->Bins.Skipped();
}

void CellCaster::DrawTile(LevelTiles& tiles, std::size_t number, Scratch& scratch) const
{
  LevelTile& tile = tiles[number];
  const PixelRect rect = tiles.RectOf(number);
  RayTile& rays = scratch.Rays;
  this->OpenTile(tiles, number, rect, scratch);
  SegmentPicture* const segments = this->Level.Scene.Segments;
  rays.Log = segments ? &scratch.Log : nullptr;
  if (scratch.Rows.Count > 0)
  {
    this->DrawSlabs(*tile.Sampling, number, scratch);
  }
  if (segments)
  {
    segments->Add(scratch.Log.Take(tiles.Cut().PositionOf(number), rays, tile.Sampling->Distance));
  }
  if (tile.PixelStride > 1)
  {
    tiles.Clear(rect);
  }
  rays.Close(tiles.Picture());
  tile.Begun = true;
  tile.Done = true;
}

/// Places the rays of a tile, or of some pixels of it.
void CellCaster::OpenTile(
  const LevelTiles& tiles, std::size_t number, const PixelRect& rect, Scratch& scratch) const
{
  const LevelTile& tile = tiles[number];
  RayTile& rays = scratch.Rays;
  rays.Open(tile.Sampling->Lattice, rect, tiles.Picture(), this->Level.TransmittanceLimit(),
    tile.PixelStride, false, rect, tile.Cast);
  rays.CellShift = 0;
  rays.BrickShift = 0;
  scratch.Rows.Take(rays, tile.Sampling->Lattice.Setup());
}

std::vector<TileRuns> CellCaster::DrawRuns(const std::vector<AskedTile>* asked)
{
  const auto workers = static_cast<std::size_t>(this->Pool.Width());
  FloatImage none; // whose pixels nobody sets
  none.Rect = this->Bins.Rect();
  LevelTiles tiles(this->Level, {}, none, nullptr, workers);
  if (!asked || !this->Sorted)
  {
    this->Bins.Sort(tiles.Cut(), this->Pool);
    this->Sorted = true;
  }
  this->ForRuns.resize(workers);
  std::vector<TileRuns> found(tiles.Count());
  std::atomic<std::int64_t> samples{ 0 };
  const std::function<void(std::int64_t, int)> draw = [&](std::int64_t number, int worker)
  {
    if (this->Level.Scene.Stop)
    {
      this->Level.Scene.Stop->Check();
    }
    const auto tile = static_cast<std::size_t>(number);
    found[tile].Position = tiles.Cut().PositionOf(tile);
    const AskedTile* const ofTile = asked ? FindTile(*asked, found[tile].Position) : nullptr;
    if (tiles[tile].Done || this->Bins.Over(tile).Count == 0 || (asked && !ofTile))
    {
      return;
    }
    std::unique_ptr<Scratch>& mine = this->ForRuns[static_cast<std::size_t>(worker)];
    if (!mine)
    {
      mine = std::make_unique<Scratch>();
      mine->Runs = std::make_unique<Scratch::ForRuns>();
    }
    this->DrawRunsOf(tiles, tile, ofTile, *mine, found[tile]);
    samples += mine->Rays.SamplesTaken;
  };
  this->Pool.ParallelFor(static_cast<std::int64_t>(tiles.Count()), draw);
  this->Statistics.SamplesTaken += samples;
  if (!asked)
  {
    this->CountCells();
  }
  return found;
}

void CellCaster::DrawRunsOf(LevelTiles& tiles, std::size_t number, const AskedTile* asked,
  Scratch& scratch, TileRuns& found) const
{
  PixelRect rect = tiles.RectOf(number);
  std::optional<AskedPixels> pixels;
  if (asked)
  {
    pixels.emplace(*asked);
    rect = Intersection(rect, pixels->Rect());
  }
  scratch.Asked = asked ? &*pixels : nullptr;
  if (rect.Empty())
  {
    return;
  }
  this->OpenTile(tiles, number, rect, scratch);
  if (scratch.Rows.Count > 0)
  {
    scratch.Runs->Collector.Begin(scratch.Rows, asked, this->Level.Scene.Segments != nullptr);
    this->DrawSlabs(*tiles[number].Sampling, number, scratch);
    scratch.Runs->Collector.Finish(scratch.Rays, *this->Field.Cells, found);
  }
}

SlabBlend CellCaster::BlendOf(const LevelSampling& sampling) const
{
  const bool relative = this->Field.Base != 0.0;
  return { sampling.Table, sampling.Projection.get(), this->Level.Shading.get(), relative,
    relative ? static_cast<float>(this->Field.Base - sampling.Table.Low()) : 0.0f };
}

/// Whether a cell may have samples of a tile, or rays cross the face: few do where samples and rays
/// are far apart.
bool CellCaster::MayDraw(const PlacedCell& cell, const Scratch& scratch, double perDistance) const
{
  if (cell.Face == PlacedCell::Whole && !scratch.Rows.AnyEnds && !cell.HoldsSamples(perDistance))
  {
    return false;
  }
  const int stride = scratch.Rays.Stride;
  const PixelRect pixels = cell.PixelsIn(this->Bins.PictureSize(), scratch.Rays.Rect);
  const glm::ivec2 first = (pixels.Lo + (stride - 1)) / stride * stride;
  return first.x < pixels.Hi.x && first.y < pixels.Hi.y &&
         (!scratch.Asked || scratch.Asked->AnyIn(pixels));
}

/// Sorts what lies over a tile by slabs.
void CellCaster::SortBySlabs(
  const LevelSampling& sampling, std::size_t number, Scratch& scratch) const
{
  const CellBins::Span over = this->Bins.Over(number);
  const TileRows& rows = scratch.Rows;
  const double perDistance = 1.0 / sampling.Distance;
  const std::size_t slabs = static_cast<std::size_t>(rows.Count - 1) / SampleSlab::Rows + 1;
  const PlacedCell* const placed = this->Bins.Placed();
  const auto forSlabs = [&](auto&& function)
  {
    for (std::size_t i = 0; i < over.Count; ++i)
    {
      const PlacedCell& cell = placed[over.Items[i]];
      if (!this->MayDraw(cell, scratch, perDistance))
      {
        continue;
      }
      const double last = rows.Count - 1.0;
      const double first = std::floor(cell.Near * perDistance) - rows.FirstNumber;
      const double end = std::floor(cell.Far * perDistance) - rows.FirstNumber;
      if (end < 0.0 || first > last)
      {
        continue;
      }
      const auto from = static_cast<std::size_t>(std::max(first, 0.0)) / SampleSlab::Rows;
      const auto to = static_cast<std::size_t>(std::min(end, last)) / SampleSlab::Rows;
      for (std::size_t slab = from; slab <= to; ++slab)
      {
        function(slab, over.Items[i]);
      }
    }
  };
  scratch.Begins.assign(slabs + 2, 0);
  forSlabs([&](std::size_t slab, std::uint32_t) { ++scratch.Begins[slab + 2]; });
  for (std::size_t i = 2; i < slabs + 2; ++i)
  {
    scratch.Begins[i] += scratch.Begins[i - 1];
  }
  scratch.Items.resize(scratch.Begins[slabs + 1]);
  forSlabs([&](std::size_t slab, std::uint32_t item)
    { scratch.Items[scratch.Begins[slab + 1]++] = item; });
}

/// Draws slab after slab, until all rays have ended.
void CellCaster::DrawSlabs(
  const LevelSampling& sampling, std::size_t number, Scratch& scratch) const
{
  this->SortBySlabs(sampling, number, scratch);
  const TileRows& rows = scratch.Rows;
  const std::size_t slabs = static_cast<std::size_t>(rows.Count - 1) / SampleSlab::Rows + 1;
  const SlabBlend blend = this->BlendOf(sampling);
  std::fill_n(scratch.Inside, RayTile::Slots, -1.0f);
  for (std::size_t slab = 0; slab < slabs && scratch.Rays.ActiveRays > 0; ++slab)
  {
    const std::size_t begin = scratch.Begins[slab];
    const std::size_t count = scratch.Begins[slab + 1] - begin;
    if (count == 0 && !this->Lattice)
    {
      continue;
    }
    const int firstRow = static_cast<int>(slab) * SampleSlab::Rows;
    const SlabJob job{ this->Field, this->Bins.Placed(), scratch.Items.data() + begin, count,
      this->Bins.PictureSize(), 1.0 / sampling.Distance, firstRow, blend.Shading, scratch.Rays,
      rows, scratch.Slab, scratch.Runs ? &scratch.Runs->Owners : nullptr };
    if (this->Lattice)
    {
      DrawLatticeSlab(job, { *this->Lattice, scratch.Inside, blend.Projection != nullptr });
    }
    else
    {
      DrawSlab(job);
    }
    scratch.Blend(firstRow, blend);
  }
}

} // namespace banyan
