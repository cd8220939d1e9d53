// SPDX-License-Identifier: BSD-3-Clause
#include "BalanceFrames.h"

#include "BricksFromDisk.h"
#include "CameraPath.h"
#include "PathBalancer.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/Communicate/MpiCommunicator.h"
#include "Parallel/Fields/PieceField.h"
#include "Parallel/Frame/DistributedFrame.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <cstdio>

namespace banyan::bench
{
namespace
{

void DrawPath(Communicator& communicator, const BenchScene& scene, const BalanceOptions& options,
  BalanceMode mode, const TakeFrame& take)
{
  ThreadPool pool(1);
  PathBalancer balancer(mode, BalancerFor(scene, options, communicator.Size()));
  ArrayBrickSource source(
    scene.Data->Array(), BenchBrickCells, MaskRange{ scene.Low, scene.High }, pool);
  const glm::ivec3 cells = balancer.GetOptions().Positions;
  const int edge = balancer.GetOptions().BlockEdge;
  const std::vector<float> visible =
    VisibleParts(SceneOnPath(scene, options.Path, 0, options.Frames), source, cells, edge);
  for (int number = 0; number < options.Frames; ++number)
  {
    RayScene drawn = SceneOnPath(scene, options.Path, number, options.Frames);
    communicator.Barrier();
    const Timer whole;
    const BrickCosts view = ViewCosts(drawn, cells, edge, visible);
    const ScreenCuts cuts(drawn);
    balancer.BeginFrame(view, options.Turns ? &cuts : nullptr);
    const std::vector<Box> zones = ZonesOf(balancer.Tree());
    BrickWork mine;
    drawn.Work = &mine;
    FrameStatistics statistics;
    CompositeOptions compositing;
    compositing.WhileCasting = !options.CompositeAfter || number % 2 == 0;
    DrawDistributed(
      communicator, drawn, { &source, zones, ~std::uint64_t{ 0 }, pool }, statistics, compositing);
    const FrameCost took = GatherCost(communicator, mine, zones, view);
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

void DrawPieces(Communicator& communicator, const BenchScene& scene, const BalanceOptions& options,
  BalanceMode mode, const TakeFrame& take)
{
  ThreadPool pool(1);
  const glm::ivec3 cells = scene.Data->Samples - 1;
  std::vector<Box> pieces;
  for (const Box& zone : ZonesOf(EqualZoneTree(cells, communicator.Size())))
  {
    pieces.push_back(zone.Empty() ? Box{} : Box{ zone.Lo, zone.Hi + 1 });
  }
  const Box& own = pieces[static_cast<std::size_t>(communicator.Rank())];
  PieceField field;
  if (mode == BalanceMode::SliceStep)
  {
    throw Error("Pieces do not follow slice-step: --modes off,measured-cost.");
  }
  field.Take(communicator, pieces, PartOf(scene.Data->Array(), own), cells, BenchBrickCells,
    mode == BalanceMode::Off ? LoadBalancing::Off : LoadBalancing::MeasuredCost, pool);
  double fetching = 0.0;
  double drawing = 0.0;
  for (int number = 0; number < options.Frames; ++number)
  {
    RayScene drawn = SceneOnPath(scene, options.Path, number, options.Frames);
    communicator.Barrier();
    const Timer whole;
    field.BeginFrame(communicator, drawn, ~std::uint64_t{ 0 });
    BrickWork measured; // where nobody balances
    drawn.Work = drawn.Work ? drawn.Work : &measured;
    FrameStatistics statistics;
    CompositeOptions compositing;
    compositing.WhileCasting = !options.CompositeAfter || number % 2 == 0;
    DrawDistributed(communicator, drawn,
      { field.Source(), field.Zones(), ~std::uint64_t{ 0 }, pool }, statistics, compositing);
    field.EndFrame(communicator);
    BalanceFrame frame;
    frame.Milliseconds = 1e3 * AllMax(communicator, whole.Seconds());
    const double mine = 1e3 * drawn.Work->DrawSeconds;
    frame.RankMilliseconds.resize(static_cast<std::size_t>(communicator.Size()));
    communicator.AllGather(&mine, sizeof(mine), frame.RankMilliseconds.data());
    drawing += frame.Milliseconds;
    fetching += 1e3 * AllMax(communicator, field.FrameStatistics().FetchSeconds);
    frame.Number = number;
    frame.Mode = mode;
    frame.Imbalance = statistics.Imbalance;
    frame.BytesMoved = static_cast<double>(field.FrameStatistics().BytesMoved);
    if (communicator.Rank() == 0)
    {
      take(frame);
    }
  }
  if (communicator.Rank() == 0)
  {
    std::fprintf(stderr, "%s: %.2f ms per frame, of which %.2f until bricks were fetched\n",
      NameOf(mode), drawing / options.Frames, fetching / options.Frames);
  }
}

/// What it takes to fetch all bricks of a volume from the memory of the first rank.
void FetchAll(Communicator& communicator, const BenchScene& scene)
{
  const auto ranks = static_cast<std::size_t>(communicator.Size());
  const SampleArray whole = scene.Data->Array();
  std::vector<Box> pieces(ranks);
  pieces[0] = whole.Samples;
  const PieceGrid grid(pieces, BenchBrickCells);
  const PieceSamples mine = communicator.Rank() == 0 ? PieceSamples(whole) : PieceSamples();
  const std::vector<ScalarType> types(ranks, whole.Type);
  std::vector<std::int64_t> wanted;
  std::vector<std::int32_t> counts(ranks * ranks, 0);
  for (std::size_t rank = 1; rank < ranks; ++rank)
  {
    counts[rank * ranks] = static_cast<std::int32_t>(grid.Count());
  }
  for (std::int64_t brick = 0; brick < grid.Count() && communicator.Rank() != 0; ++brick)
  {
    wanted.push_back(brick);
  }
  for (int round = 0; round < 5; ++round)
  {
    BrickFetch fetch(grid, types, mine, false);
    FetchedBricks into;
    communicator.Barrier();
    const Timer timer;
    fetch.Exchange(communicator, wanted, counts, into);
    const double seconds = AllMax(communicator, timer.Seconds());
    const double bytes = AllSum(communicator, static_cast<double>(into.Bytes()));
    const double bricks = AllSum(communicator, static_cast<double>(into.Count()));
    if (communicator.Rank() == 0)
    {
      std::printf("%.0f bricks, %.1f MB, %.1f ms, %.2f us per brick\n", bricks, bytes / 1e6,
        1e3 * seconds, 1e6 * seconds / bricks);
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
    if (options.Exchange)
    {
      FetchAll(*communicator, scene);
      if (!options.Disk.empty() && communicator->Rank() == 0)
      {
        EncodeForDisk(scene, options.Disk);
        ReadBricks(options.Disk);
      }
      communicator->Barrier();
    }
    for (const BalanceMode mode : options.Exchange ? std::vector<BalanceMode>{} : options.Modes)
    {
      (options.Pieces ? DrawPieces : DrawPath)(*communicator, scene, options, mode, take);
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
