// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_PictureWatcher_h
#define banyan_Render_Levels_PictureWatcher_h

#include "Render/Levels/RayCaster.h"

#include <cstddef>

namespace banyan
{

/// Is told which pixels of a picture are final while the others are still being drawn. Nothing of
/// it may throw.
class PictureWatcher
{
public:
  virtual ~PictureWatcher() = default;

  /// Before anything is drawn, by the thread that casts.
  /// @param picture stays where it is until the cast has ended; pixels are not to be read before
  /// they are final
  virtual void Begins(const FloatImage& picture) = 0;

  /// A tile of TileGrid(picture.Rect) is final: what CastRays will return there. Once per tile, by
  /// any worker.
  virtual void TileIsFinal(std::size_t tile) = 0;

  /// Now and then between tiles, by the thread that casts.
  virtual void BetweenTiles() = 0;
};

/// CastRays, watched. The picture is the same to the last bit.
FloatImage CastRaysWatched(const RayScene& scene, BrickSource& source, const Box& cells,
  std::uint64_t budgetBytes, ThreadPool& pool, RayStatistics& statistics, PictureWatcher& watcher);

} // namespace banyan

#endif
