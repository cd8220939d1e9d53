#include "Render/RayCaster.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Render/BrickProjector.h"
#include "Render/TileGrid.h"
#include "Render/VisibilityOrder.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <atomic>
#include <cmath>

namespace banyan
{
namespace
{

/// Bricks loaded before the rays that have become opaque are looked at again.
constexpr std::size_t BricksPerBatch = 512;

struct PlannedBrick
{
  std::int64_t Number = 0;
  Box Cells;
  PixelRect Footprint;
  double Key = 0;
  float HighestRank = 0; ///< of a projection
};

/// Packed, or as the source gives it where it cannot be packed.
struct LoadedBrick
{
  std::shared_ptr<const PackedBrick> Packed;
  BrickVisibility Seen;
  PixelRect Footprint; ///< of what can be seen
  BrickView View;
};

class Caster
{
public:
  Caster(const RayScene& scene, BrickSource& source, const Box& cells, std::uint64_t budgetBytes,
    ThreadPool& pool, RayStatistics& statistics)
    : Scene(scene)
    , Source(source)
    , Cells(Intersection(cells, scene.DomainCells))
    , BudgetBytes(budgetBytes)
    , Pool(pool)
    , Statistics(statistics)
    , Lattice(scene)
    , Table(scene.Transfer, scene.SampleDistance)
    , Visible(scene.Transfer)
    , IndexCamera(scene.Camera.InSpace(scene.IndexToWorld))
  {
    if (scene.Blend.Mode != BlendMode::Composite)
    {
      this->Projection = std::make_unique<const ProjectionTable>(scene, this->Table);
    }
    else if (scene.Shading.On)
    {
      this->Shading = std::make_unique<const ShadingTable>(
        scene.Shading, glm::dmat3(glm::inverse(scene.IndexToWorld)));
    }
  }

  FloatImage Cast()
  {
    this->Plan();
    this->Source.Kept().BeginPicture(this->BudgetBytes / 2);
    this->MakeTiles();
    std::size_t next = 0;
    while (next < this->Bricks.size())
    {
      next = this->TakeBatch(next);
      if (!this->Batch.empty())
      {
        this->DrawBatch();
      }
    }
    // The marcher keeps the transmittance where the picture has the opacity.
    for (glm::vec4& pixel : this->Picture.Pixels)
    {
      pixel.a = 1.0f - pixel.a;
    }
    return std::move(this->Picture);
  }

private:
  /// Finds the bricks that can be seen, front to back, and the rectangle that they cover.
  void Plan()
  {
    const glm::ivec3 counts = this->Source.Bricks();
    const std::int64_t count = std::int64_t{ counts.x } * counts.y * counts.z;
    const ValueMask visibleBins = this->Scene.Transfer.VisibleBins(this->Source.MasksAreOver());
    const Viewpoint view = InIndexSpace(this->Scene.Camera, this->Scene.IndexToWorld);
    for (std::int64_t number = 0; number < count; ++number)
    {
      PlannedBrick brick;
      brick.Number = number;
      const Box whole = this->Source.CellsOf(number);
      brick.Cells = Intersection(whole, this->Cells);
      if (brick.Cells.Empty())
      {
        continue;
      }
      const ValueRange range = this->Source.RangeOf(number);
      brick.HighestRank = this->Projection ? this->Projection->HighestRank(range) : 0.0f;
      const bool wanted = this->Projection ? brick.HighestRank > 0.0f
                                           : (this->Source.MaskOf(number) & visibleBins) != 0 &&
                                               this->Visible.Any(range.Low, range.High);
      if (wanted && !IsCutAway(this->Lattice.Planes(), brick.Cells))
      {
        brick.Footprint = Intersection(this->FootprintOf(brick.Cells), this->Scene.Viewport);
      }
      if (brick.Footprint.Empty())
      {
        ++this->Statistics.BricksSkipped;
        continue;
      }
      // The best values first: bricks that cannot beat them are then never loaded. Averages are
      // added up front to back, so that they round alike in bricks of all sizes.
      brick.Key = this->Projection && !this->Projection->Averages() ? -brick.HighestRank
                                                                    : VisibilityKey(view, whole);
      this->Picture.Rect = Union(this->Picture.Rect, brick.Footprint);
      this->Bricks.push_back(brick);
    }
    std::sort(this->Bricks.begin(), this->Bricks.end(),
      [](const PlannedBrick& a, const PlannedBrick& b)
      { return a.Key < b.Key || (a.Key == b.Key && a.Number < b.Number); });
  }

  PixelRect FootprintOf(const Box& cells) const
  {
    return this->IndexCamera.Footprint(glm::dvec3(cells.Lo), glm::dvec3(cells.Hi));
  }

  void MakeTiles()
  {
    this->Picture.Pixels.assign(
      static_cast<std::size_t>(this->Picture.Rect.Count()), glm::vec4(0, 0, 0, 1));
    this->Tiles = TileGrid(this->Picture.Rect);
    const std::size_t tiles = this->Tiles.Count();
    this->TileIsDone.assign(tiles, 0);
    this->BricksOfTile.resize(tiles);
    this->Scratch.resize(this->Pool.Width());
  }

  /// What the budget leaves beside the bricks that are kept.
  std::uint64_t BytesLeft() const
  {
    return this->BudgetBytes - std::min(this->BudgetBytes, this->Source.Kept().Bytes());
  }

  /// Puts bricks from number `first` on into the batch, as many as the budget allows but at least
  /// one, and enters them in the lists of the tiles. @return the first brick of the next batch
  std::size_t TakeBatch(std::size_t first)
  {
    this->Batch.clear();
    this->Loaded.clear();
    for (std::vector<int>& bricks : this->BricksOfTile)
    {
      bricks.clear();
    }
    const std::uint64_t left = this->BytesLeft();
    std::uint64_t bytes = 0;
    std::size_t next = first;
    for (; next < this->Bricks.size(); ++next)
    {
      const PlannedBrick& brick = this->Bricks[next];
      KeptBricks::Pointer kept = this->Source.Kept().Find(
        brick.Number, brick.Cells, this->Table.Low(), this->Shading != nullptr);
      const std::uint64_t loadBytes = kept ? 0 : this->Source.LoadBytes(brick.Number);
      const std::uint64_t brickBytes =
        kept ? 0 : loadBytes + PackedBrick::BytesFor(brick.Cells, this->Shading != nullptr);
      const bool full = bytes + brickBytes > left || this->Batch.size() >= BricksPerBatch;
      if (full && !this->Batch.empty())
      {
        break;
      }
      // What is in memory anyway costs less to draw than to look for open pixels.
      if (loadBytes > 0 && !this->AnyRayOpen(brick))
      {
        ++this->Statistics.BricksSkipped;
        continue;
      }
      const int position = static_cast<int>(this->Batch.size());
      this->Tiles.ForEachUnder(brick.Footprint,
        [&](std::size_t tile)
        {
          if (!this->TileIsDone[tile])
          {
            this->BricksOfTile[tile].push_back(position);
          }
        });
      this->Batch.push_back(&brick);
      this->Loaded.emplace_back();
      this->Loaded.back().Packed = std::move(kept);
      bytes += brickBytes;
    }
    return next;
  }

  /// Whether a pixel under a brick has not reached the opacity limit, or a better rank.
  bool AnyRayOpen(const PlannedBrick& brick) const
  {
    const PixelRect& footprint = brick.Footprint;
    const float limit = this->TransmittanceLimit();
    const bool ranked = this->Projection && !this->Projection->Averages();
    const auto open = [&](const glm::vec4& pixel)
    { return ranked ? pixel.r < brick.HighestRank : pixel.a > limit; };
    for (int y = footprint.Lo.y; y < footprint.Hi.y; ++y)
    {
      const glm::vec4* row = &this->Picture.At(footprint.Lo.x, y);
      const glm::vec4* end = row + footprint.Size().x;
      if (std::any_of(row, end, open))
      {
        return true;
      }
    }
    return false;
  }

  /// Rays of a projection never end.
  float TransmittanceLimit() const
  {
    return this->Projection ? 0.0f : 1.0f - this->Scene.OpacityLimit;
  }

  void DrawBatch()
  {
    this->Pool.ParallelFor(static_cast<std::int64_t>(this->Batch.size()),
      [this](std::int64_t i) { this->Load(*this->Batch[i], this->Loaded[i]); });
    this->Statistics.BricksDrawn += static_cast<std::int64_t>(this->Batch.size());

    std::atomic<std::int64_t> samples{ 0 };
    const std::function<void(std::int64_t, int)> draw = [&](std::int64_t tile, int worker)
    {
      if (!this->BricksOfTile[tile].empty())
      {
        samples += this->DrawTile(tile, this->Scratch[worker]);
      }
    };
    this->Pool.ParallelFor(static_cast<std::int64_t>(this->BricksOfTile.size()), draw);
    this->Statistics.SamplesTaken += samples;
    this->Loaded.clear();
  }

  void Load(const PlannedBrick& brick, LoadedBrick& loaded) const
  {
    if (!loaded.Packed)
    {
      if (!PackedBrick::CanPack(brick.Cells))
      {
        loaded.View = this->LoadLarge(brick);
        return;
      }
      loaded.Packed = this->Pack(brick);
      this->Source.Kept().Keep(brick.Number, loaded.Packed);
    }
    loaded.Footprint = brick.Footprint;
    if (this->Projection)
    {
      return;
    }
    loaded.Seen =
      BrickVisibility(*loaded.Packed, this->Source.RangeOf(brick.Number), this->Visible);
    loaded.Footprint =
      loaded.Seen.Cells == brick.Cells ? brick.Footprint : this->FootprintOf(loaded.Seen.Cells);
  }

  KeptBricks::Pointer Pack(const PlannedBrick& brick) const
  {
    const double low = this->Table.Low();
    if (!this->Shading)
    {
      const BrickView view = this->Source.Load(brick.Number);
      const glm::ivec3 corner = this->Source.CellsOf(brick.Number).Lo;
      return std::make_shared<const PackedBrick>(view, corner, brick.Cells, low);
    }
    Box around;
    const BrickView view = this->Source.LoadAround(brick.Number, around);
    return std::make_shared<const PackedBrick>(
      view, around, brick.Cells, low, this->GradientScale());
  }

  /// Brings gradients near 1, so that their squares neither overflow nor vanish.
  float GradientScale() const
  {
    const MaskRange range = this->Source.MasksAreOver();
    const double width = range.High - range.Low;
    const int exponent = width > 0.0 && std::isfinite(width) ? std::ilogb(width) : 0;
    return static_cast<float>(std::exp2(-std::clamp(exponent, -100, 100)));
  }

  BrickView LoadLarge(const PlannedBrick& brick) const
  {
    if (this->Shading)
    {
      throw Error("Bricks of so many cells per axis cannot be shaded",
        { {}, {}, static_cast<std::uint64_t>(brick.Cells.Size().x),
          static_cast<std::uint64_t>(PackedBrick::LargestEdge) });
    }
    return this->Source.Load(brick.Number);
  }

  /// @return samples taken
  std::int64_t DrawTile(std::int64_t number, RayTile& tile)
  {
    tile.Open(this->Lattice, this->Tiles.RectOf(number), this->Picture, this->TransmittanceLimit());
    for (const int position : this->BricksOfTile[number])
    {
      if (tile.ActiveRays == 0)
      {
        break;
      }
      this->DrawBrick(*this->Batch[position], this->Loaded[position], tile);
    }
    tile.Close(this->Picture);
    this->TileIsDone[number] = tile.ActiveRays == 0 ? 1 : 0;
    return tile.SamplesTaken;
  }

  void DrawBrick(const PlannedBrick& brick, const LoadedBrick& loaded, RayTile& tile) const
  {
    if (!loaded.Packed)
    {
      const glm::ivec3 corner = this->Source.CellsOf(brick.Number).Lo;
      const BrickPart part{ loaded.View, corner, brick.Cells };
      this->Projection
        ? ProjectBrick(part, *this->Projection, brick.Footprint, tile)
        : MarchBrick(part, this->Table, brick.Footprint, tile, this->Scene.Interpolation);
    }
    else if (this->Projection)
    {
      this->ProjectPackedBrick(brick, *loaded.Packed, tile);
    }
    else
    {
      const auto march = tile.PacketsFit ? MarchPacked : MarchUnpacked;
      march(*loaded.Packed, loaded.Seen, this->Table, this->Shading.get(), loaded.Footprint, tile,
        this->Scene.Interpolation);
    }
  }

  void ProjectPackedBrick(const PlannedBrick& brick, const PackedBrick& packed, RayTile& tile) const
  {
    if (tile.PacketsFit)
    {
      const ValueRange range = this->Source.RangeOf(brick.Number);
      ProjectPacked(packed, range, *this->Projection, brick.Footprint, tile);
    }
    else
    {
      ProjectUnpacked(packed, *this->Projection, brick.Footprint, tile);
    }
  }

  const RayScene& Scene;
  BrickSource& Source;
  Box Cells;
  std::uint64_t BudgetBytes;
  ThreadPool& Pool;
  RayStatistics& Statistics;
  RayLattice Lattice;
  StepTable Table;
  VisibleValues Visible;
  std::unique_ptr<const ShadingTable> Shading;       ///< null for none
  std::unique_ptr<const ProjectionTable> Projection; ///< null when samples are composited
  RayCamera IndexCamera;

  FloatImage Picture;
  std::vector<PlannedBrick> Bricks;
  TileGrid Tiles;
  std::vector<char> TileIsDone;               ///< no ray of the tile needs another brick
  std::vector<std::vector<int>> BricksOfTile; ///< positions in the batch, front to back
  std::vector<RayTile> Scratch;               ///< one per worker
  std::vector<const PlannedBrick*> Batch;
  std::vector<LoadedBrick> Loaded; ///< of the batch
};

} // namespace

FloatImage CastRays(const RayScene& scene, BrickSource& source, const Box& cells,
  std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics)
{
  return Caster(scene, source, cells, budgetBytes, pool, statistics).Cast();
}

} // namespace banyan
