// SPDX-License-Identifier: BSD-3-Clause
#include "RealWall.h"

#include "WallScenes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Parallel/Communicate/MpiCommunicator.h"
#include "Parallel/Frame/DistributedFrame.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <cmath>
#include <cstdio>
#include <fstream>

namespace banyan::bench
{
namespace
{

constexpr std::uint64_t AllMemory = ~std::uint64_t{ 0 };

/// As WallRanks has written them.
RankShare SharesIn(
  const std::string& path, int ranks, bool byPicture, BrickSource& source, ThreadPool& pool)
{
  RankShare share{ &source, {}, AllMemory, pool };
  std::ifstream file(path);
  for (int rank = 0; rank < ranks; ++rank)
  {
    if (byPicture)
    {
      PixelRect region;
      file >> region.Lo.x >> region.Lo.y >> region.Hi.x >> region.Hi.y;
      share.Regions.push_back(region);
    }
    else
    {
      Box zone;
      file >> zone.Lo.x >> zone.Lo.y >> zone.Lo.z >> zone.Hi.x >> zone.Hi.y >> zone.Hi.z;
      share.Zones.push_back(zone);
    }
  }
  int more = 0;
  if (!file || file >> more)
  {
    throw Error("The frames were recorded for another number of ranks.", { path });
  }
  return share;
}

int Rounded(float value)
{
  return static_cast<int>(std::lround(255.0f * std::clamp(value, 0.0f, 1.0f)));
}

/// In 1/255, where both have pixels.
double DifferenceOf(const FloatImage& part, const FloatImage& whole)
{
  int largest = 0;
  for (int y = part.Rect.Lo.y; y < part.Rect.Hi.y && !part.Rect.Empty(); ++y)
  {
    for (int x = part.Rect.Lo.x; x < part.Rect.Hi.x; ++x)
    {
      for (int c = 0; c < 4; ++c)
      {
        largest =
          std::max(largest, std::abs(Rounded(part.At(x, y)[c]) - Rounded(whole.At(x, y)[c])));
      }
    }
  }
  return largest;
}

void Draw(Communicator& ranks, const BenchScene& bench, const WallColumn& column,
  const std::string& view, const std::string& folder)
{
  ThreadPool pool(1);
  ArrayBrickSource source(bench.Data->Array(), BrickCells, MaskRange{ 0.0, 255.0 }, pool);
  const Wall wall(column.Megapixels, column.Tiles);
  const RayScene scene = PlannedOnWall(bench, source, view, wall, 0.0, pool);
  RayStatistics statistics;
  FloatImage alone = CastViewport(scene, source, scene.DomainCells, AllMemory, pool, statistics);
  InterpolateSkippedPixels(scene, alone, pool);
  for (const bool byPicture : { false, true })
  {
    const std::string name = byPicture ? "by-picture" : "by-data";
    const RankShare share =
      SharesIn(folder + "/" + name + "/shares", ranks.Size(), byPicture, source, pool);
    FrameStatistics took;
    const FloatImage mine = DrawDistributed(ranks, scene, share, took, {}, wall.Tiles);
    const double difference = AllMax(ranks, DifferenceOf(mine, alone));
    if (ranks.Rank() == 0)
    {
      std::printf(
        "%s,%.0f,%g\n", name.c_str(), static_cast<double>(took.BytesComposited), difference);
    }
  }
}

} // namespace

void DrawRealWall(const BenchScene& scene, const WallColumn& column, const std::string& view,
  const std::string& folder)
{
  MPI_Init(nullptr, nullptr);
  try
  {
    const MPI_Comm world = MPI_COMM_WORLD;
    const auto communicator = MakeMpiCommunicator(&world);
    Draw(*communicator, scene, column, view, folder);
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-walls: %s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
  }
  MPI_Finalize();
}

} // namespace banyan::bench
