// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/GroupPlans.h"

#include "Render/Sampling/ChosenPlan.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// A step may show so many times as many bricks as the ends of its group, or as few.
constexpr double MostTimes = 1.25;
/// Or so many more: in small series a brick is much.
constexpr double MostMore = 8.0;
/// Plans that are kept: those of two groups, the view's first one, and steps planned by themselves.
constexpr std::size_t MostKnown = 8;

bool IsBetween(const VisibleSigns& now, const VisibleSigns& a, const VisibleSigns& b)
{
  const auto bricks = static_cast<double>(now.Bricks);
  const auto most = static_cast<double>(std::max(a.Bricks, b.Bricks));
  const auto least = static_cast<double>(std::min(a.Bricks, b.Bricks));
  return bricks <= std::max(MostTimes * most, most + MostMore) &&
         bricks >= std::min(least / MostTimes, least - MostMore) &&
         (now.Bins & ~(a.Bins | b.Bins)) == 0;
}

} // namespace

void GroupPlans::Forget()
{
  this->First = -1.0;
  this->Plays = false;
  this->Known.clear();
  this->Shared.clear();
}

/// @param took is added what making it took
const GroupPlans::End& GroupPlans::EndAt(double step, const MakePlan& make, SamplingPlan& took)
{
  const auto known = this->Known.find(step);
  if (known != this->Known.end())
  {
    return known->second;
  }
  const End& end = this->Known[step] = make(step);
  took.Probes += end.Plan.Probes;
  took.ProbeSeconds += end.Plan.ProbeSeconds;
  took.StrideSeconds += end.Plan.StrideSeconds;
  return end;
}

const SamplingPlan& GroupPlans::Between(int first, const End& a, const End& b)
{
  const auto known = this->Shared.find(first);
  return known != this->Shared.end()
           ? known->second
           : this->Shared.emplace(first, SharedPlan(a.Plan, b.Plan)).first->second;
}

SamplingPlan GroupPlans::Of(
  const Hash128& view, double step, int steps, const VisibleSigns& now, const MakePlan& make)
{
  if (view != this->View)
  {
    this->Forget();
    this->View = view;
  }
  this->Plays = this->Plays || (this->First >= 0.0 && step != this->First);
  this->First = this->First < 0.0 ? step : this->First;
  if (this->Known.size() > MostKnown)
  {
    this->Known.clear();
    this->Shared.clear();
  }
  SamplingPlan took;
  SamplingPlan plan;
  const int first = static_cast<int>(step) / StepsTogether * StepsTogether;
  const int next = std::min(first + StepsTogether, steps - 1);
  if (!this->Plays || step == next)
  {
    plan = this->EndAt(step, make, took).Plan;
  }
  else
  {
    const End& a = this->EndAt(first, make, took);
    const End& b = this->EndAt(next, make, took);
    plan = IsBetween(now, a.Signs, b.Signs) ? this->Between(first, a, b)
                                            : this->EndAt(step, make, took).Plan;
  }
  plan.Probes = took.Probes;
  plan.ProbeSeconds = took.ProbeSeconds;
  plan.StrideSeconds = took.StrideSeconds;
  return plan;
}

} // namespace banyan
