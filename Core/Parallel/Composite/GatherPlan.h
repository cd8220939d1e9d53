// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_GatherPlan_h
#define banyan_Parallel_Composite_GatherPlan_h

#include "Base/Box.h"

#include <vector>

namespace banyan
{

/// Who sends which part when the pieces of all ranks are gathered into one whole.
struct GatherPlan
{
  struct Part
  {
    int Rank = 0;
    Box Samples; ///< inside the rank's piece and inside the whole; never empty
  };
  std::vector<Part> Parts;  ///< disjoint, in the order of ranks
  std::vector<Box> Missing; ///< disjoint parts of the whole that no rank has; empty if all is well
};

/// Pieces may overlap (neighbours share a layer; sources that know nothing of pieces give the whole
/// to everybody) and may be empty: every sample is taken from the lowest rank that has it. The plan
/// depends on the arguments only, so all ranks come to the same one without a message.
GatherPlan PlanGathering(const Box& whole, const std::vector<Box>& pieces);

/// Returns the rest of `box` without `hole`: up to six disjoint boxes.
std::vector<Box> Subtract(const Box& box, const Box& hole);

} // namespace banyan

#endif
