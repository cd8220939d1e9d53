// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_CellCaster_h
#define banyan_Render_Cells_CellCaster_h

#include "Render/Cells/CellBins.h"
#include "Render/Cells/CellSource.h"
#include "Render/Cells/RayRuns.h"
#include "Render/Levels/LevelScene.h"
#include "Render/Raycast/TileGrid.h"
#include "Render/Scene/PictureCaster.h"

#include <memory>
#include <vector>

namespace banyan
{

class LevelTiles;
class ThreadPool;

/// Draws the cells of a mesh, or a lattice with its values: tile by tile, and in each tile slab by
/// slab from the eye on.
class CellCaster final : public PictureCaster
{
public:
  /// Everything referred to must stay. Finds the cells that can be seen.
  /// @param level the source itself, or that of a coarser level
  /// @param lattice of the coarser level; null where cells are drawn
  /// @param statistics is added to
  CellCaster(const RayScene& scene, CellSource& source, BrickSource& level,
    std::shared_ptr<const MeshLattice> lattice, ThreadPool& pool, RayStatistics& statistics);
  ~CellCaster() override;

  const PixelRect& Rect() const override { return this->Bins.Rect(); }
  void Draw(FloatImage& picture, PictureWatcher* watcher) override
  {
    this->DrawTiles(picture, watcher, {});
  }
  /// The same, but for tiles of others: nothing is there.
  void DrawTiles(FloatImage& picture, PictureWatcher* watcher, const TileShare& share);

  /// Draws a piece of a mesh: what this rank has of each tile, for RunMerger. Tiles may come in
  /// several parts. Cells alone: lattices have no owners.
  /// @param asked null for all of the picture, else tiles of which intervals are wanted raw
  std::vector<TileRuns> DrawRuns(const std::vector<AskedTile>* asked);

  const LevelScene& Drawn() const { return this->Level; }
  /// @param sampling of the tile
  SlabBlend BlendOf(const LevelSampling& sampling) const;

private:
  struct Scratch;

  void CountCells();
  void DrawTile(LevelTiles& tiles, std::size_t number, Scratch& scratch) const;
  void DrawRunsOf(LevelTiles& tiles, std::size_t number, const AskedTile* asked, Scratch& scratch,
    TileRuns& found) const;
  void OpenTile(
    const LevelTiles& tiles, std::size_t number, const PixelRect& rect, Scratch& scratch) const;
  bool MayDraw(const PlacedCell& cell, const Scratch& scratch, double perDistance) const;
  void SortBySlabs(const LevelSampling& sampling, std::size_t number, Scratch& scratch) const;
  void DrawSlabs(const LevelSampling& sampling, std::size_t number, Scratch& scratch) const;

  LevelScene Level;
  const std::shared_ptr<const MeshLattice> Lattice;
  const CellField& Field; ///< cells that are drawn, or those with faces at the border
  ThreadPool& Pool;
  RayStatistics& Statistics;
  CellBins Bins;
  // What a second round finds of the first one.
  bool Sorted = false;                           ///< Bins, by tiles
  std::vector<std::unique_ptr<Scratch>> ForRuns; ///< by worker
};

} // namespace banyan

#endif
