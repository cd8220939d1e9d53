// SPDX-License-Identifier: BSD-3-Clause
#include "BalanceFrames.h"

#include "CameraPath.h"
#include "PathBalancer.h"

#include "Base/ThreadPool.h"

#include <ctime>

#include <algorithm>

namespace banyan::bench
{
namespace
{

constexpr std::uint64_t AllMemory = ~std::uint64_t{ 0 };

double ProcessorSeconds()
{
  timespec time;
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

std::unique_ptr<ArrayBrickSource> SourceOf(const BenchScene& scene, ThreadPool& pool)
{
  return std::make_unique<ArrayBrickSource>(
    scene.Data->Array(), BenchBrickCells, MaskRange{ scene.Low, scene.High }, pool);
}

} // namespace

LoadBalancer::Options BalancerFor(const BenchScene& scene, const BalanceOptions& given, int ranks)
{
  LoadBalancer::Options options;
  options.Positions = scene.Data->Samples - 1;
  options.Ranks = ranks;
  options.BrickPositions = BenchBrickCells;
  options.PlaneStep = given.PlaneStep;
  options.TurnGain = 1.0 + 0.01 * given.TurnPercent;
  options.BlockEdge = BlockEdgeFor(options.Positions);
  options.BytesPerPosition = static_cast<double>(SizeOf(scene.Data->Type()));
  return options;
}

void DrawSimulated(const BenchScene& scene, const BalanceOptions& options, BalanceMode mode,
  int ranks, const TakeFrame& take)
{
  ThreadPool pool(1);
  PathBalancer balancer(mode, BalancerFor(scene, options, ranks));
  // One for each rank, as each has packed bricks of its own.
  std::vector<std::unique_ptr<ArrayBrickSource>> sources;
  for (int rank = 0; rank < ranks; ++rank)
  {
    sources.push_back(SourceOf(scene, pool));
  }
  const glm::ivec3 cells = balancer.GetOptions().Positions;
  const int edge = balancer.GetOptions().BlockEdge;
  const std::vector<float> visible = VisibleParts(
    SceneOnPath(scene, options.Path, 0, options.Frames), *sources.front(), cells, edge);
  for (int number = 0; number < options.Frames; ++number)
  {
    RayScene drawn = SceneOnPath(scene, options.Path, number, options.Frames);
    const BrickCosts view = ViewCosts(drawn, cells, edge, visible);
    const ScreenCuts cuts(drawn);
    balancer.BeginFrame(view, options.Turns ? &cuts : nullptr);
    const std::vector<Box> zones = ZonesOf(balancer.Tree());
    std::vector<BrickWork> work(static_cast<std::size_t>(ranks));
    BalanceFrame frame;
    for (std::size_t rank = 0; rank < work.size(); ++rank)
    {
      drawn.Work = &work[rank];
      RayStatistics statistics;
      // A rank has a core of its own: what others took of this one does not count.
      work[rank].Clock = ProcessorSeconds;
      const double before = ProcessorSeconds();
      CastRays(drawn, *sources[rank], zones[rank], AllMemory, pool, statistics);
      const double seconds = ProcessorSeconds() - before;
      frame.RankMilliseconds.push_back(1e3 * seconds);
    }
    FrameCost took = SumCost(work, view);
    for (std::size_t rank = 0; options.Counted && rank < work.size(); ++rank)
    {
      took.Ranks[rank].Seconds = CountedSeconds(took.Ranks[rank].Work);
      frame.RankMilliseconds[rank] = 1e3 * took.Ranks[rank].Seconds;
    }
    balancer.FrameTook(took.Ranks, took.Blocks);
    frame.Number = number;
    frame.Mode = mode;
    frame.Imbalance = ImbalanceOf(frame.RankMilliseconds);
    frame.Milliseconds =
      *std::max_element(frame.RankMilliseconds.begin(), frame.RankMilliseconds.end());
    frame.BytesMoved = balancer.BytesMoved();
    take(frame);
  }
}

void WriteBrickTimes(const BenchScene& scene, const BalanceOptions& options, std::FILE* file)
{
  ThreadPool pool(1);
  const auto source = SourceOf(scene, pool);
  std::fprintf(file, "frame,x,y,z,samples,pixels,rays,microseconds,draw_ms\n");
  for (int number = 0; number < options.Frames; ++number)
  {
    RayScene drawn = SceneOnPath(scene, options.Path, number, options.Frames);
    BrickWork work;
    drawn.Work = &work;
    RayStatistics statistics;
    CastRays(drawn, *source, drawn.DomainCells, AllMemory, pool, statistics);
    for (const BrickWork::Part& part : work.Parts)
    {
      std::fprintf(file, "%d,%d,%d,%d,%lld,%lld,%.0f,%.3f,%.3f\n", number, part.Cells.Lo.x,
        part.Cells.Lo.y, part.Cells.Lo.z, static_cast<long long>(part.Took.Samples),
        static_cast<long long>(part.Took.Pixels), part.Took.Rays, 1e6 * part.Took.Seconds,
        1e3 * work.DrawSeconds);
    }
  }
}

} // namespace banyan::bench
