#include "Parallel/DistributedPlan.h"

#include "Parallel/DistributedPilot.h"

namespace banyan
{
namespace
{

/// The coarsest level, up to `most`, that all ranks with bricks have.
int CommonLevel(Communicator& communicator, BrickSource* source, const Box& domain, int most)
{
  int mine = most;
  while (source != nullptr && mine > 0 && source->AtLevel(mine, domain) == nullptr)
  {
    --mine;
  }
  return -static_cast<int>(AllMax(communicator, -mine));
}

/// The finest level that all ranks can draw pilots from without loading everything again for each
/// of them: half the budget is for bricks that are kept.
int FinestPilotLevel(Communicator& communicator, const RayScene& scene, BrickSource* source,
  const std::vector<Box>& zones, int coarsest, std::uint64_t budgetBytes, ThreadPool& pool)
{
  if (coarsest == 0)
  {
    return 0;
  }
  const Box& zone = zones.at(static_cast<std::size_t>(communicator.Rank()));
  int mine = 0;
  std::string failure;
  try
  {
    mine = source && !zone.Empty()
             ? FinestLevelWithin(scene, *source, zone, coarsest, budgetBytes / 2, pool)
             : 0;
  }
  catch (const std::exception& error)
  {
    failure = error.what();
  }
  const std::string agreed = AgreeOnError(communicator, failure);
  if (!agreed.empty())
  {
    throw Error(agreed);
  }
  return static_cast<int>(AllMax(communicator, mine));
}

} // namespace

SamplingPlan PlanDistributed(Communicator& communicator, const RayScene& scene, BrickSource* source,
  const std::vector<Box>& zones, std::uint64_t budgetBytes, ThreadPool& pool,
  const std::string& localError, SamplingWish wish, FrameStatistics& statistics)
{
  const std::string agreed = AgreeOnError(communicator, localError);
  if (!agreed.empty())
  {
    throw Error(agreed);
  }
  wish.CoarsestLevel = CommonLevel(communicator, source, scene.DomainCells, wish.CoarsestLevel);
  wish.FinestPilotLevel =
    FinestPilotLevel(communicator, scene, source, zones, wish.CoarsestLevel, budgetBytes, pool);
  return PlanSamplings(scene, wish,
    [&](const RayScene& pilot)
    {
      return DrawDistributedPilot(
        communicator, pilot, source, zones, budgetBytes, pool, statistics);
    });
}

} // namespace banyan
