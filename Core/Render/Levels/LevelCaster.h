// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_LevelCaster_h
#define banyan_Render_Levels_LevelCaster_h

#include "Render/Levels/BrickPlan.h"

#include <cstdint>
#include <memory>

namespace banyan
{

class PictureWatcher;

/// Casts the rays of those tiles of a picture that are sampled at one level: CastRays for that
/// level. It plans once (BrickPlan), then goes through the plan batch by batch: BatchQueue takes a
/// batch, BrickLoader loads it, and BatchDrawer draws it to the LevelTiles.
class LevelCaster
{
public:
  /// Everything referred to must stay. Finds the bricks that can be seen.
  /// @param source of the level
  /// @param cells to draw, in cells of the level
  /// @param statistics is added to
  LevelCaster(const RayScene& scene, BrickSource& source, const Box& cells,
    std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics);

  /// Pixels that the visible bricks may touch, those of other levels' tiles included.
  const PixelRect& Rect() const { return this->Plan->Touched; }

  /// Draws the tiles of the level, and makes them final: premultiplied colours and opacities.
  /// @param picture its pixels in tiles of the level are set, whatever they were; while they are
  /// drawn, they have the *transmittance* in the fourth component
  /// @param watcher is told of tiles that are final; null for none
  void Draw(FloatImage& picture, PictureWatcher* watcher);

private:
  LevelScene Level;
  std::uint64_t BudgetBytes;
  ThreadPool& Pool;
  RayStatistics& Statistics;
  std::shared_ptr<const BrickPlan> Plan;
};

} // namespace banyan

#endif
