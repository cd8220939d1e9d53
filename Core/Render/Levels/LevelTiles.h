// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_LevelTiles_h
#define banyan_Render_Levels_LevelTiles_h

#include "Render/Levels/LevelScene.h"
#include "Render/Levels/PlannedBrick.h"
#include "Render/Raycast/TileGrid.h"
#include "Render/Scene/FloatImage.h"
#include "Render/Scene/ReusedRays.h"

#include <cstddef>
#include <vector>

namespace banyan
{

class PictureWatcher;

/// How far a tile of a picture has been drawn. Begun comes first, then Done, unless bricks run out
/// before all rays have ended, then Final. None of them is taken back.
struct LevelTile
{
  const LevelSampling* Sampling = nullptr; ///< null for tiles of other levels, which are Done
  int PixelStride = 1;                     ///< RaySampling::PixelStride
  std::uint64_t Cast = ReusedRays::All;    ///< blocks whose rays are cast: ReusedRays
  bool Begun = false;                      ///< its pixels are set
  bool Done = false;                       ///< no ray of it needs another brick
  bool Final = false;                      ///< its pixels have opacities
  std::size_t End = 0;                     ///< one behind the last brick of the plan over it
};

/// The tiles of a picture while one level is drawn. The fourth component of a pixel is the
/// *transmittance* from when its tile has Begun until it is Final, and the opacity then.
///
/// Different tiles may be changed from different threads at a time.
class LevelTiles
{
public:
  /// Everything referred to must stay.
  /// @param bricks of the plan
  /// @param watcher is told of tiles that are final; null for none
  /// @param workers how many threads draw: probes have so few pixels that tiles are made smaller
  LevelTiles(const LevelScene& level, const std::vector<PlannedBrick>& bricks, FloatImage& picture,
    PictureWatcher* watcher, std::size_t workers);

  std::size_t Count() const { return this->Tiles.size(); }
  const TileGrid& Cut() const { return this->Grid; }
  LevelTile& operator[](std::size_t tile) { return this->Tiles[tile]; }
  const LevelTile& operator[](std::size_t tile) const { return this->Tiles[tile]; }
  PixelRect RectOf(std::size_t tile) const { return this->Grid.RectOf(tile); }
  FloatImage& Picture() const { return this->Pixels; }

  /// Calls function(tile) for the tiles under a footprint that are not Done.
  template <class Function>
  void ForOpenUnder(const PixelRect& footprint, Function&& function) const
  {
    this->Grid.ForEachUnder(footprint,
      [&](std::size_t tile)
      {
        if (!this->Tiles[tile].Done)
        {
          function(tile);
        }
      });
  }

  /// Whether a pixel under a brick has not reached the opacity limit, or has a rank that the brick
  /// can better.
  bool AnyRayOpen(const PlannedBrick& brick) const;

  /// Sets all pixels of a rectangle to nothing.
  void Clear(const PixelRect& rect) const;

  /// Makes a tile of this level Final, once, if it is Done or no later brick comes over it.
  /// @param taken bricks of the plan that have been drawn, or need not be
  void Finish(std::size_t tile, std::size_t taken);

private:
  const LevelScene& Level;
  FloatImage& Pixels;
  PictureWatcher* Watcher;
  TileGrid Grid;
  std::vector<LevelTile> Tiles; ///< of Grid
};

} // namespace banyan

#endif
