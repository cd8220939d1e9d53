// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Levels/LevelCaster.h"

#include "Base/StopFlag.h"
#include "Base/ThreadPool.h"
#include "Render/Levels/BatchDrawer.h"
#include "Render/Levels/BrickBatch.h"
#include "Render/Levels/BrickLoader.h"
#include "Render/Levels/LevelTiles.h"
#include "Render/Levels/SharedPlans.h"

namespace banyan
{
namespace
{

std::shared_ptr<const BrickPlan> PlanOf(
  const LevelScene& level, const Box& cells, std::uint64_t budgetBytes, ThreadPool& pool)
{
  SharedPlans* const shared = level.Scene.Plans.get();
  return shared ? shared->PlanOf(level, cells, budgetBytes, pool)
                : std::make_shared<const BrickPlan>(PlanBricks(level, cells, budgetBytes, pool));
}

} // namespace

LevelCaster::LevelCaster(const RayScene& scene, BrickSource& source, const Box& cells,
  std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics)
  : Level(scene, source)
  , BudgetBytes(budgetBytes)
  , Pool(pool)
  , Statistics(statistics)
  , Plan(PlanOf(this->Level, cells, budgetBytes, pool))
{
  this->Statistics.BricksSkipped += this->Plan->Skipped;
}

void LevelCaster::Draw(FloatImage& picture, PictureWatcher* watcher)
{
  const std::vector<PlannedBrick>& bricks = this->Plan->Bricks;
  LevelTiles tiles(
    this->Level, bricks, picture, watcher, static_cast<std::size_t>(this->Pool.Width()));
  BatchQueue queue(this->Level, bricks, this->BudgetBytes, this->Pool);
  const BrickLoader loader(this->Level);
  BatchDrawer drawer(this->Level, tiles, watcher, this->Pool);
  BrickBatch batch;
  while (!queue.Empty())
  {
    this->Statistics.BricksSkipped += queue.Take(tiles, batch);
    if (batch.Bricks.empty())
    {
      continue;
    }
    this->Pool.ParallelFor(static_cast<std::int64_t>(batch.Bricks.size()),
      [&](std::int64_t i)
      {
        if (this->Level.Scene.Stop)
        {
          this->Level.Scene.Stop->Check();
        }
        loader.Load(batch.Bricks[static_cast<std::size_t>(i)]);
      });
    for (const LoadedBrick& brick : batch.Bricks)
    {
      (brick.Planned->Entry ? this->Statistics.BricksUniform : this->Statistics.BricksDrawn) +=
        brick.Planned->Count();
    }
    this->Statistics.SamplesTaken += drawer.Draw(batch);
    batch.Bricks.clear();
  }
  for (std::size_t tile = 0; tile < tiles.Count(); ++tile)
  {
    tiles.Finish(tile, bricks.size());
  }
}

} // namespace banyan
