// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_SliceStep_h
#define banyan_Benchmarks_SliceStep_h

#include "Parallel/Balance/ZoneTree.h"

#include <vector>

namespace banyan::bench
{

/// The published rule: seconds are summed up the tree, and depth first each plane moves by one
/// slice of bricks towards the child that costs more. With unequal numbers of ranks under the
/// children the costs are those per rank. Planes stay `slice` apart where there is room, so that no
/// zone is lost.
///
/// @param rankSeconds of the last frame, one per rank
/// @param slice positions that a plane moves by, at least 1
/// @par Source: "Dynamic load balancing for parallel volume rendering", section 3.2
/// Throws Error when the numbers of ranks differ.
ZoneTree RebalanceSliceStep(
  const ZoneTree& tree, const std::vector<double>& rankSeconds, int slice = 1);

} // namespace banyan::bench

#endif
