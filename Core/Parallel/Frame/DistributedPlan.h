// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Frame_DistributedPlan_h
#define banyan_Parallel_Frame_DistributedPlan_h

#include "Parallel/Frame/DistributedFrame.h"
#include "Render/Sampling/SamplingPlan.h"

namespace banyan
{

/// The coarsest level, up to `most`, that all ranks with bricks have. Collective, the same on all
/// ranks. When a rank fails, all ranks throw the same Error.
/// @param source null on ranks without bricks
int CommonLevel(Communicator& communicator, BrickSource* source, const Box& domain, int most);

/// Plans how a picture is to be sampled on all ranks: PlanSamplings with probes that all ranks draw
/// together. Collective; all ranks get the same plan. The parameters are those of DrawDistributed,
/// whose picture of `scene` with the plan's samplings and opacity limit then is within the
/// tolerance as estimated.
///
/// @param wish its coarsest level is lowered to what the bricks of all ranks have
/// @param statistics samples and bytes of the probes are added; the rest stays
/// When a rank fails, all ranks throw the same Error.
SamplingPlan PlanDistributed(Communicator& communicator, const RayScene& scene,
  const RankShare& share, SamplingWish wish, FrameStatistics& statistics);

} // namespace banyan

#endif
