// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_LevelCaster_h
#define banyan_Render_Raycast_LevelCaster_h

#include "Render/Raycast/BrickProjector.h"
#include "Render/Raycast/BrickWork.h"
#include "Render/Raycast/RayCaster.h"
#include "Render/Raycast/TileGrid.h"
#include "Render/Scene/RayLattice.h"

#include <memory>
#include <optional>
#include <vector>

namespace banyan
{

class PictureWatcher;
class ThreadPool;

/// Casts the rays of those tiles of a picture that are sampled at one level: CastRays for that
/// level.
class LevelCaster
{
public:
  /// Everything referred to must stay. Finds the bricks that can be seen.
  /// @param source of the level
  /// @param cells to draw, in cells of the level
  LevelCaster(const RayScene& scene, BrickSource& source, const Box& cells,
    std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics);

  /// Pixels that the visible bricks may touch, those of other levels' tiles included.
  const PixelRect& Rect() const { return this->Touched; }

  /// What all bricks that can be seen take, as loaded and as packed for drawing.
  std::uint64_t BytesToDraw() const;

  /// Draws the tiles of the level, and makes them final: premultiplied colours and opacities.
  /// @param picture its pixels in tiles of the level are set, whatever they were; while they are
  /// drawn, they have the *transmittance* in the fourth component
  /// @param watcher is told of tiles that are final; null for none
  void Draw(FloatImage& picture, PictureWatcher* watcher);

private:
  struct PlannedBrick
  {
    std::int64_t Number = 0; ///< of several bricks, the first one's
    Box Together;  ///< positions of several bricks that are drawn as one; empty for one brick
    int Level = 0; ///< BrickSource::BrickLevel
    Box Cells;     ///< to pack, in its own
    Box Drawn;     ///< the part of them to draw, in cells of the source
    PixelRect Footprint;
    /// Front to back: of its group, of the eighth of that, and its own; 0 behind what is one brick.
    double Keys[3] = {};
    float HighestRank = 0; ///< of a projection
    /// Of the table, where all samples have it and are not shaded: nothing is loaded then.
    std::optional<int> Entry;
  };

  /// Of some of the bricks.
  struct PartOfPlan
  {
    std::vector<PlannedBrick> Bricks;
    PixelRect Touched;
    std::int64_t Skipped = 0;
  };

  /// Packed, or as the source gives it where it cannot be packed, or nothing where all is known.
  struct LoadedBrick
  {
    std::shared_ptr<const PackedBrick> Packed;
    std::optional<BrickVisibility> Known; ///< Seen, of a brick that was kept
    BrickVisibility Seen;
    PixelRect Footprint; ///< of what can be seen
    BrickView View;
    HiddenInBrick Hidden; ///< of View
  };

  /// A sampling that tiles of the level have.
  struct Sampled
  {
    RayLattice Lattice;
    std::shared_ptr<const StepTable> Steps;
    const StepTable& Table;
    std::unique_ptr<const ProjectionTable> Projection; ///< null when samples are composited

    /// Rays are made for the largest cells.
    Sampled(const RayScene& scene, double distance, const BrickSource& source);
  };

  struct Tile
  {
    const Sampled* Sampling = nullptr; ///< null for tiles of other levels
    int PixelStride = 1;
    bool Begun = false;         ///< its pixels are set
    bool Done = false;          ///< no ray of the tile needs another brick
    bool Final = false;         ///< its pixels have opacities
    std::size_t End = 0;        ///< behind the last brick over it
    std::size_t FirstBrick = 0; ///< in BricksOfTiles
    std::size_t EndOfBricks = 0;
  };

  void AddSamplings();
  void Plan();
  GroupList MembersOf(const BrickGroups& groups) const;
  GroupMembers Look(const BrickGroups& groups, const Box& bricks, ValueMask bins) const;
  void SkipAll(const BrickGroups& groups, const Box& bricks, PartOfPlan& plan) const;
  void PlanSome(const BrickGroups& groups, const Box& bricks, const GroupMembers& members,
    const Viewpoint& view, int depth, PartOfPlan& plan) const;
  bool PlanTogether(const BrickGroups& groups, const Box& bricks, const GroupMembers& members,
    PartOfPlan& plan) const;
  void PlanBrick(std::int64_t number, bool visible, PartOfPlan& plan) const;
  bool SeeBrick(PlannedBrick& brick) const;
  bool AllOnScreen(const BrickGroups& groups, const PlannedBrick& brick) const;
  void PlaceCells(PlannedBrick& brick, const Box& own) const;
  void SetKeys(
    std::size_t first, const Box& cells, const Viewpoint& view, int depth, PartOfPlan& plan) const;
  void TakeIn(PlannedBrick brick, PartOfPlan& plan) const;
  template <class Function>
  void ForBricksOf(const PlannedBrick& brick, Function&& function) const;
  ValueRange RangeOf(const PlannedBrick& brick) const;
  std::uint64_t LoadBytesOf(const PlannedBrick& brick) const;
  std::int64_t KeptNumberOf(const PlannedBrick& brick) const;
  static int BricksIn(const PlannedBrick& brick)
  {
    return brick.Together.Empty() ? 1 : static_cast<int>(brick.Together.Count());
  }
  PixelRect FootprintOf(const Box& cells) const;
  std::optional<int> EntryOf(std::int64_t brick) const;
  std::optional<int> EntryOfAll(const BrickGroups& groups, const Box& bricks) const;
  void MakeTiles();
  template <class Function>
  void ForTilesUnder(const PixelRect& footprint, Function&& function);
  std::uint64_t BytesLeft() const;
  std::size_t TakeBatch(std::size_t first);
  std::uint64_t BytesOf(const PlannedBrick& brick) const;
  void EnterInTiles(const std::vector<std::size_t>& tiles, const std::vector<std::size_t>& ends);
  void FindKept();
  bool AnyRayOpen(const PlannedBrick& brick);
  float TransmittanceLimit() const;
  void DrawBatch();
  void Load(const PlannedBrick& brick, LoadedBrick& loaded) const;
  BrickVisibility LookAt(const PlannedBrick& brick, const PackedBrick& packed) const;
  KeptBricks::Pointer Pack(const PlannedBrick& brick) const;
  bool IsLarge() const;
  double StepToPack(ScalarType type) const;
  float GradientScale() const;
  BrickView LoadLarge(const PlannedBrick& brick) const;
  PixelRect DrawnPixelsOf(const Tile& tile, const PixelRect& rect) const;
  const PixelRect& PixelsOf(std::size_t position) const;
  std::int64_t DrawTile(std::size_t number, RayTile& rays, BatchMeter& meter);
  CornerRays CornersOf(const PixelRect& rect) const;
  BrickAhead Ahead(
    std::size_t place, const CornerRays& corners, const PixelRect& rect, const RayTile& rays) const;
  void ClearTile(const PixelRect& rect) const;
  void FinishTile(std::size_t number);
  void RecordWork(double began);
  void ShareWork(std::size_t number, std::vector<WorkShare>& shares) const;
  void DrawBrick(const PlannedBrick& brick, const LoadedBrick& loaded, const Sampled& sampling,
    RayTile& rays) const;
  void ProjectPackedBrick(const PlannedBrick& brick, const PackedBrick& packed,
    const ProjectionTable& projection, RayTile& rays) const;

  const RayScene& Scene;
  BrickSource& Source;
  Box Cells;
  std::uint64_t BudgetBytes;
  ThreadPool& Pool;
  RayStatistics& Statistics;
  std::shared_ptr<const VisibleValues> VisibleOfFunction;
  const VisibleValues& Visible;
  glm::dmat4 IndexToWorld;
  RayCamera IndexCamera;
  std::vector<glm::dvec4> ClipPlanes;          ///< in index space
  std::unique_ptr<const ShadingTable> Shading; ///< null for none

  /// By number of the scene's samplings; null for those of other levels, and that no tile has.
  std::vector<std::unique_ptr<const Sampled>> Samplings;
  const Sampled* AnySampling = nullptr; ///< for what is the same for all

  PixelRect Touched;
  std::vector<PlannedBrick> Bricks;
  std::vector<std::int64_t> Ranks; ///< BrickSource::RanksFrontToBack
  std::size_t Taken = 0;           ///< bricks that have been in a batch, or need not be
  FloatImage* Picture = nullptr;
  PictureWatcher* Watcher = nullptr;
  TileGrid Grid;
  std::vector<Tile> Tiles;             ///< of the grid
  std::vector<int> BricksOfTiles;      ///< positions in the batch, front to back
  std::unique_ptr<RayTile[]> Scratch;  ///< one per worker
  std::vector<BatchMeter> Meters;      ///< one per worker
  std::vector<KeptBricks::Found> Kept; ///< of all planned bricks
  std::vector<const PlannedBrick*> Batch;
  bool AsksAhead = false;          ///< caches are asked for bricks of the batch
  std::vector<LoadedBrick> Loaded; ///< of the batch
};

/// Calls function(number) for each brick that a planned one is made of.
template <class Function>
void LevelCaster::ForBricksOf(const PlannedBrick& brick, Function&& function) const
{
  if (brick.Together.Empty())
  {
    function(brick.Number);
    return;
  }
  const glm::ivec3 counts = this->Source.Bricks();
  const glm::ivec3 size = brick.Together.Size();
  for (std::int64_t i = 0; i < brick.Together.Count(); ++i)
  {
    const auto place = static_cast<int>(i);
    const glm::ivec3 p = brick.Together.Lo + glm::ivec3(place % size.x, place / size.x % size.y,
                                               place / size.x / size.y);
    function(BrickSource::NumberOf(p, counts));
  }
}

} // namespace banyan

#endif
