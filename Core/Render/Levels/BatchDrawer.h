// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_BatchDrawer_h
#define banyan_Render_Levels_BatchDrawer_h

#include "Render/Bricks/BrickPrefetcher.h"
#include "Render/Levels/BrickBatch.h"
#include "Render/Levels/LevelTiles.h"
#include "Render/Raycast/BrickWork.h"
#include "Render/Raycast/RayTile.h"
#include "Render/Raycast/SegmentLog.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

class PictureWatcher;
class ThreadPool;

/// Draws loaded batches to the tiles of a picture. A thread draws all bricks over one tile, in the
/// order of the batch, and then takes another tile: no pixel is shared, and pictures do not depend
/// on the number of threads.
class BatchDrawer
{
public:
  /// Everything referred to must stay.
  /// @param watcher is called between tiles; null for none
  BatchDrawer(
    const LevelScene& level, LevelTiles& tiles, PictureWatcher* watcher, ThreadPool& pool);

  /// Draws all bricks of a batch, and finishes the tiles that need no later one.
  /// @param batch loaded; all batches before it have been drawn
  /// @return samples taken
  std::int64_t Draw(const BrickBatch& batch);

private:
  std::int64_t DrawTile(const BrickBatch& batch, std::size_t number, RayTile& rays,
    BatchMeter& meter, bool prefetch) const;
  PixelRect DrawnPixels(const BrickBatch& batch, std::size_t number) const;
  void DrawBricks(const BrickBatch& batch, std::size_t number, const PixelRect& drawn,
    RayTile& rays, BatchMeter& meter, bool prefetch) const;
  void DrawBrick(const LoadedBrick& brick, const LevelSampling& sampling, RayTile& rays) const;
  void DrawProjected(
    const LoadedBrick& brick, const ProjectionTable& projection, RayTile& rays) const;
  CornerRays CornersOf(const PixelRect& rect) const;
  void RecordWork(const BrickBatch& batch, double began) const;
  void ShareWork(
    const BrickBatch& batch, std::size_t position, std::vector<WorkShare>& shares) const;

  const LevelScene& Level;
  LevelTiles& Tiles;
  PictureWatcher* Watcher;
  ThreadPool& Pool;
  std::unique_ptr<RayTile[]> Scratch; ///< one per worker
  std::vector<BatchMeter> Meters;     ///< one per worker
  std::vector<SegmentLog> Logs;       ///< one per worker where the scene wants segments, else none
};

} // namespace banyan

#endif
