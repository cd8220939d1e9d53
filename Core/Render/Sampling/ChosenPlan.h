// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_ChosenPlan_h
#define banyan_Render_Sampling_ChosenPlan_h

#include "Render/Sampling/SamplingChoices.h"
#include "Render/Sampling/SamplingPlan.h"

#include <memory>
#include <vector>

namespace banyan
{

/// What probes told of a scene: a plan is chosen from it.
struct PlanBasis
{
  SamplingChoices Choices;
  SamplingWish Wish;
  glm::ivec2 ImageSize{ 0 };
};

/// What rays that end early may leave away, as a share of the tolerance.
constexpr double ShareOfEnds = 0.125;

/// What choices may add up to.
inline double AllowedError(const SamplingWish& wish)
{
  return wish.Tolerance * (1.0 - ShareOfEnds);
}

/// Gives each tile the cheapest sampling whose error is allowed, or the one with the smallest.
/// @param bases at least one, of pictures of one size: the error is allowed in all of them
/// @return probes and seconds are 0, and the opacity limit is not set
SamplingPlan ChoosePlan(const std::vector<std::shared_ptr<const PlanBasis>>& bases);

/// The plan that both scenes may be drawn with, as exactly as with their own. Where one of them
/// showed nothing, the other one's.
SamplingPlan SharedPlan(const SamplingPlan& a, const SamplingPlan& b);

} // namespace banyan

#endif
