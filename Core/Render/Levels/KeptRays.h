// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_KeptRays_h
#define banyan_Render_Levels_KeptRays_h

#include "Base/Hash.h"
#include "Render/Bricks/BrickSource.h"
#include "Render/Scene/FloatImage.h"
#include "Render/Scene/RayScene.h"
#include "Render/Scene/ReusedRays.h"

#include <cstdint>
#include <map>
#include <memory>
#include <vector>

namespace banyan
{

/// The rays of the last picture of a view, and what bricks they may have met: blocks of 4 x 4
/// pixels under no brick that has changed since are not cast again. The next picture has the bits
/// that it would have if all rays were cast.
///
///     bricks   a hash of the samples of each that can be seen ── compared with that of before
///     blocks   under the footprint of a brick that differs ── a bit of the tile's mask
///     tiles    another level, distance, stride or opacity limit ── all bits
///
/// It begins with the second picture of a view: of those that are seen once, while a camera moves,
/// nothing is kept, and nothing is looked at.
///
/// Several ranks look at all bricks, so that all know the same of all blocks. Rank 0 keeps the
/// picture of all of them; zones may move meanwhile.
///
/// Only of composited samples. A change of the transfer function is one of all bricks that have
/// values whose entries have changed. With light, rays near a brick that differs are cast, too.
class KeptRays
{
public:
  /// Looks what can be kept for the next picture.
  /// @param scene with its samplings; gets RayScene::Reused
  /// @param source of the finest level; all bricks
  /// @param name a hash of all that decides the next picture, its samplings apart; the same on all
  /// ranks
  /// @return a hash of all that is kept, for ranks to compare; zeros if that is nothing
  Hash128 Begin(RayScene& scene, BrickSource& source, const Hash128& name);

  /// Keeps the picture of that scene. Not to be called when a rank could not draw it.
  /// @param picture null but on rank 0
  void Keep(const std::shared_ptr<const FloatImage>& picture);

  void Forget();

private:
  /// Per brick of a level: 0 where nothing can be seen, else a hash of all samples.
  using Seen = std::vector<std::uint64_t>;

  bool MarkLevels(const RayScene& scene, BrickSource& source, const std::map<int, Seen>& next,
    ReusedRays& reused) const;
  void MarkTiles(const RayScene& scene, ReusedRays& reused) const;

  Hash128 View; ///< of the picture that was begun last
  Hash128 Name;
  float OpacityLimit = 0.0f;
  TransferFunction Transfer;
  std::shared_ptr<const TileSamplings> Samplings;
  std::map<int, Seen> Levels; ///< that it was drawn from
  bool Complete = false;      ///< whether it has been drawn
  std::shared_ptr<const FloatImage> Picture;
};

} // namespace banyan

#endif
