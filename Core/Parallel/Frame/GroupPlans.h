// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Frame_GroupPlans_h
#define banyan_Parallel_Frame_GroupPlans_h

#include "Base/Hash.h"
#include "Render/Bricks/VisibleBricks.h"
#include "Render/Sampling/SamplingPlan.h"

#include <functional>
#include <map>

namespace banyan
{

/// Plans of a series that plays in one view: one for a group of steps instead of one for each.
///
///     step       0                       8                      16
///     plans      P0 ─────────────────── P8 ─────────────────── P16
///     frames     |  1  2  3  4  5  6  7  |  9 10 11 12 13 14 15  |
///                  good enough for both     good enough for both
///
/// The first picture of a view has a plan of its own: nobody knows yet whether the series plays.
/// Each step after that takes the cheapest plan that is good enough for the first step of its group
/// and for that of the next one: whatever was drawn before, the same plan. A step that shows values
/// which neither end of its group does, or much more or less than both, is planned by itself.
/// Between two steps it is the same: a place among steps need not be a whole number.
class GroupPlans
{
public:
  static constexpr int StepsTogether = 8;

  /// A plan, and what was seen at its step.
  struct End
  {
    SamplingPlan Plan;
    VisibleSigns Signs;
  };
  /// Plans a step. Called alike on all ranks.
  using MakePlan = std::function<End(double step)>;

  /// The plan of a frame; its times and probes are those that this frame took.
  /// @param view a hash of all that decides the plan but the step
  /// @param now what is seen at the step
  /// @param steps of the series
  SamplingPlan Of(
    const Hash128& view, double step, int steps, const VisibleSigns& now, const MakePlan& make);

  void Forget();

private:
  const End& EndAt(double step, const MakePlan& make, SamplingPlan& took);
  const SamplingPlan& Between(int first, const End& a, const End& b);

  Hash128 View;
  double First = -1.0;                ///< step that was drawn first in the view; -1: none
  bool Plays = false;                 ///< another one was drawn since
  std::map<double, End> Known;        ///< by step
  std::map<int, SamplingPlan> Shared; ///< by the first step of the group
};

} // namespace banyan

#endif
