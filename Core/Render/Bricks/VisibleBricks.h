// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_VisibleBricks_h
#define banyan_Render_Bricks_VisibleBricks_h

#include "Render/Bricks/BrickSource.h"
#include "Render/Scene/RayScene.h"

#include <cstdint>
#include <vector>

namespace banyan
{

/// Which bricks have values that can be seen, wherever the camera is: through the transfer
/// function, or, where samples are not composited, at all. A brick too many is possible, one too
/// few is not.
class VisibleBricks
{
public:
  /// Both must stay.
  VisibleBricks(const RayScene& scene, const BrickSource& source);

  bool Contains(std::int64_t brick) const;

private:
  const BrickSource& Source;
  VisibleValues Visible;
  ValueMask Bins;
  bool Composited;
};

/// What can be seen of all bricks of a level together.
struct VisibleSigns
{
  std::int64_t Bricks = 0; ///< of which something can be seen
  ValueMask Bins = 0;      ///< that are there, and can be seen
};
VisibleSigns SignsOf(const RayScene& scene, const BrickSource& source);

/// Bricks of the finest level with cells in `cells` that CastRays may load for pictures of the
/// scene, for those of fewer pixels too (WithSize), and their probes: an upper bound.
std::vector<std::int64_t> BricksToLoad(
  const RayScene& scene, const BrickSource& source, const Box& cells);

} // namespace banyan

#endif
