// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_BrickPlan_h
#define banyan_Render_Levels_BrickPlan_h

#include "Render/Levels/LevelScene.h"
#include "Render/Levels/PlannedBrick.h"

#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// The bricks of a level that are drawn, in order.
struct BrickPlan
{
  /// Front to back: no brick hides one before it. Projections that look for the best value have
  /// the bricks with the best ones first instead.
  std::vector<PlannedBrick> Bricks;
  PixelRect Touched;        ///< around the footprints of all of them
  std::int64_t Skipped = 0; ///< bricks of the source that cannot be seen, or are off screen
};

/// Finds the bricks with cells in `cells` that can be seen under the transfer function, between the
/// clip planes and on the screen. Small bricks side by side become one where all of them can be
/// seen (BrickGroups). Loads nothing. Takes time for what can be seen, not for all bricks
/// (SummaryTree).
/// @param cells of the level
/// @param budgetBytes that drawing may take: bricks become one only where that is a small part
BrickPlan PlanBricks(
  const LevelScene& level, const Box& cells, std::uint64_t budgetBytes, ThreadPool& pool);

/// Whether all bricks that PlanBricks finds take at most so many bytes, as loaded and as packed for
/// drawing. Bricks that are so small that no ray meets them may count, too. Takes time for at most
/// so many bytes.
/// @param bytes also the budget
bool AllFits(const LevelScene& level, const Box& cells, std::uint64_t bytes);

} // namespace banyan

#endif
