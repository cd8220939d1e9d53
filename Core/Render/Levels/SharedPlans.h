// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Levels_SharedPlans_h
#define banyan_Render_Levels_SharedPlans_h

#include "Base/Hash.h"
#include "Render/Levels/BrickPlan.h"

#include <cstdint>
#include <memory>
#include <mutex>

namespace banyan
{

/// A plan that several pictures have in common. Most probes of a frame differ from the one before
/// in nothing but the distance between samples, which does not matter to bricks: one plan does for
/// all of them. Keeps the plan that was asked for last, and is made for one frame.
///
/// Methods may be called from any thread.
class SharedPlans
{
public:
  /// What PlanBricks gives for the same arguments, or gave when they were the last ones.
  /// @param level its source must stay, and keep its values, as long as this
  std::shared_ptr<const BrickPlan> PlanOf(
    const LevelScene& level, const Box& cells, std::uint64_t budgetBytes, ThreadPool& pool);

private:
  Hash128 Name; ///< of all that decides Last
  std::shared_ptr<const BrickPlan> Last;
  std::mutex Mutex;
};

} // namespace banyan

#endif
