#include "BalanceFrames.h"

#include "CameraPath.h"

#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/DistributedFrame.h"
#include "Parallel/MpiCommunicator.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>

namespace banyan::bench
{
namespace
{

void DrawPath(Communicator& communicator, const BenchScene& scene, const BalanceOptions& options,
  LoadBalancing mode, const TakeFrame& take)
{
  ThreadPool pool(1);
  LoadBalancer balancer(BalancerFor(scene, options, mode, communicator.Size()));
  ArrayBrickSource source(
    scene.Data->Array(), BenchBrickCells, MaskRange{ scene.Low, scene.High }, pool);
  const glm::ivec3 cells = balancer.Given().Positions;
  const int edge = balancer.Given().BlockEdge;
  const std::vector<float> visible =
    VisibleParts(SceneOnPath(scene, options.Path, 0, options.Frames), source, cells, edge);
  for (int number = 0; number < options.Frames; ++number)
  {
    RayScene drawn = SceneOnPath(scene, options.Path, number, options.Frames);
    communicator.Barrier();
    const Timer whole;
    const BrickCosts view = ViewCosts(drawn, cells, edge, visible);
    balancer.BeginFrame(view);
    const std::vector<Box> zones = ZonesOf(balancer.Tree());
    BrickWork mine;
    drawn.Work = &mine;
    FrameStatistics statistics;
    DrawDistributed(communicator, drawn, &source, zones, ~std::uint64_t{ 0 }, pool, {}, statistics);
    const FrameWork took = GatherWork(communicator, mine, zones, view);
    balancer.FrameTook(took.Ranks, took.Blocks);
    BalanceFrame frame;
    frame.Milliseconds = 1e3 * AllMax(communicator, whole.Seconds());
    for (const RankWork& rank : took.Ranks)
    {
      frame.RankMilliseconds.push_back(1e3 * rank.Seconds);
    }
    frame.Number = number;
    frame.Mode = mode;
    frame.Imbalance = statistics.Imbalance;
    frame.BytesMoved = balancer.BytesMoved();
    if (communicator.Rank() == 0)
    {
      take(frame);
    }
  }
}

} // namespace

void DrawOnMpiRanks(const std::function<BenchScene()>& makeScene, const BalanceOptions& options,
  const TakeFrame& take)
{
  MPI_Init(nullptr, nullptr);
  try
  {
    const MPI_Comm world = MPI_COMM_WORLD;
    const auto communicator = MakeMpiCommunicator(&world);
    const BenchScene scene = makeScene();
    for (const LoadBalancing mode : options.Modes)
    {
      DrawPath(*communicator, scene, options, mode, take);
    }
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-balance: %s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
  }
  MPI_Finalize();
}

} // namespace banyan::bench
