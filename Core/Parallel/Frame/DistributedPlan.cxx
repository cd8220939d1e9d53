// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/DistributedPlan.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Frame/DistributedProbe.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// The largest of what the ranks say, or the error of the first one that fails, on all of them.
template <class Function>
int LargestOfAll(Communicator& communicator, Function&& mine)
{
  int value = 0;
  Collective(communicator, [&] { value = mine(); });
  return static_cast<int>(AllMax(communicator, value));
}

/// The finest level that all ranks can draw probes from without loading everything again for each
/// of them: half the budget is for bricks that are kept.
int FinestProbeLevel(
  Communicator& communicator, const RayScene& scene, const RankShare& share, int coarsest)
{
  if (coarsest == 0)
  {
    return 0;
  }
  const Box& zone = share.Zones.at(static_cast<std::size_t>(communicator.Rank()));
  return LargestOfAll(communicator,
    [&]
    {
      return share.Source && !zone.Empty() ? FinestLevelWithin(scene, *share.Source, zone, coarsest,
                                               PackedBrickCache::PartOf(share.BudgetBytes))
                                           : 0;
    });
}

} // namespace

int CommonLevel(Communicator& communicator, BrickSource* source, const Box& domain, int most)
{
  // The least of all is the largest of the negatives.
  return -LargestOfAll(communicator,
    [&]
    {
      int level = most;
      while (source != nullptr && level > 0 && source->AtLevel(level, domain) == nullptr)
      {
        --level;
      }
      return -level;
    });
}

SamplingPlan PlanDistributed(Communicator& communicator, const RayScene& scene,
  const RankShare& share, SamplingWish wish, FrameStatistics& statistics)
{
  ThrowTogether(communicator, share.Failure);
  wish.CoarsestLevel =
    CommonLevel(communicator, share.Source, scene.DomainCells, wish.CoarsestLevel);
  wish.FinestProbeLevel = FinestProbeLevel(communicator, scene, share, wish.CoarsestLevel);
  if (wish.StaysInMemory)
  {
    wish.FinestLevel = std::max(wish.FinestLevel, wish.FinestProbeLevel);
  }
  return PlanSamplings(scene, wish,
    [&](const RayScene& probe)
    { return DrawDistributedProbe(communicator, probe, share, statistics); });
}

} // namespace banyan
