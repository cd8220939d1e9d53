// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_CompositeWhileCasting_h
#define banyan_Parallel_Composite_CompositeWhileCasting_h

#include "Parallel/Composite/TileOwnerCompositor.h"
#include "Render/Levels/PictureWatcher.h"

#include <atomic>
#include <exception>
#include <memory>
#include <vector>

namespace banyan
{

/// Begins to composite while rays are still cast: sends chunks of the plan as soon as their
/// tiles are final, and blends what comes, all in the thread that casts, between its tiles. Other
/// threads only count tiles. The picture is that of Composite to the last bit.
///
/// Ranks do not know of each other's failures before they send: one that fails sends empty messages
/// in the place of what is left. They have to agree on errors after `Finish`, on all ranks.
class CompositeWhileCasting final : public PictureWatcher
{
public:
  /// Everything referred to must stay. The arguments are those of TileOwnerCompositor.
  CompositeWhileCasting(Communicator& communicator, const std::vector<int>& frontToBack,
    const PixelRect& viewport, const CompositeOptions& options, CompositeStatistics& statistics);

  void Begins(const FloatImage& picture) override;
  void TileIsFinal(std::size_t tile) override;
  void BetweenTiles() override;

  /// Does what is left to do when rays have been cast. Throws what compositing has thrown so far.
  /// @param mine what has been cast; null when that has failed
  /// @return as Composite; of no use when a rank has failed
  FloatImage Finish(const FloatImage* mine);

  /// Parts of the picture that this rank had dealt with before its last ray was cast.
  int ChunksAhead() const { return this->Ahead; }

private:
  int Self = 0;
  TileOwnerCompositor Frame;
  const FloatImage* Picture = nullptr;        ///< while it is being cast
  std::vector<std::vector<int>> ChunksOfTile; ///< per tile of the picture
  /// Per chunk, tiles of the picture that are not final; chunks of which this rank draws nothing
  /// have none.
  std::unique_ptr<std::atomic<int>[]> TilesLeft;
  std::vector<bool> Added;
  int Ahead = 0;
  std::exception_ptr Failure;
};

} // namespace banyan

#endif
