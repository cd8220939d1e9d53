// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_FrameCost_h
#define banyan_Parallel_Balance_FrameCost_h

#include "Parallel/Balance/BrickCosts.h"
#include "Parallel/Balance/RankSpeeds.h"
#include "Parallel/Communicate/Communicator.h"
#include "Render/Raycast/BrickWork.h"

#include <vector>

namespace banyan
{

struct RayScene;
class BrickSource;

/// Part of each block's cells whose brick can be seen through the scene's transfer function, [0,
/// 1].
/// @param source of the whole grid, from its first cell on; needs no values
std::vector<float> VisibleParts(
  const RayScene& scene, const BrickSource& source, const glm::ivec3& cells, int blockEdge);

/// Estimates how much is seen of each block of cells: its visible volume inside the viewport, as
/// large as the picture shows it. The cost is in proportion to the samples that the block would
/// take if nothing hid it. All ranks get the same bits, because they evaluate the same numbers in
/// the same order.
/// @param visible VisibleParts; empty for 1 everywhere
BrickCosts ViewCosts(const RayScene& scene, const glm::ivec3& cells, int blockEdge,
  const std::vector<float>& visible = {});

/// Work of a brick in samples: those taken, and what its rays take without them.
double WorkOf(const DrawnWork& took);

/// Holds what all ranks did for a frame.
struct FrameCost
{
  std::vector<RankWork> Ranks;
  BrickCosts Blocks; ///< work by blocks of cells
};

/// Collective, one AllGather: each rank sends its seconds and the work of the blocks in its zone.
/// @param zones of the frame, in cells
/// @param view ViewCosts of the frame: what a brick took is divided among its blocks by what is
/// seen
FrameCost GatherCost(Communicator& communicator, const BrickWork& mine,
  const std::vector<Box>& zones, const BrickCosts& view);

/// The same on one rank, from what each of several did.
FrameCost SumCost(const std::vector<BrickWork>& ranks, const BrickCosts& view);

} // namespace banyan

#endif
