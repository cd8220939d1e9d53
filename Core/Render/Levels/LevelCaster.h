// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_LevelCaster_h
#define banyan_Render_Levels_LevelCaster_h

#include "Render/Levels/BrickPlan.h"
#include "Render/Scene/PictureCaster.h"

#include <cstdint>
#include <memory>

namespace banyan
{

/// Casts the rays of those tiles of a picture that are sampled at one level: CastRays for that
/// level. It plans once (BrickPlan), then goes through the plan batch by batch: BatchQueue takes a
/// batch, BrickLoader loads it, and BatchDrawer draws it to the LevelTiles.
class LevelCaster final : public PictureCaster
{
public:
  /// Everything referred to must stay. Finds the bricks that can be seen.
  /// @param source of the level
  /// @param cells to draw, in cells of the level
  /// @param statistics is added to
  LevelCaster(const RayScene& scene, BrickSource& source, const Box& cells,
    std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics);

  const PixelRect& Rect() const override { return this->Plan->Touched; }
  void Draw(FloatImage& picture, PictureWatcher* watcher) override;

private:
  LevelScene Level;
  std::uint64_t BudgetBytes;
  ThreadPool& Pool;
  RayStatistics& Statistics;
  std::shared_ptr<const BrickPlan> Plan;
};

} // namespace banyan

#endif
