// SPDX-License-Identifier: BSD-3-Clause
#include "BricksFromDisk.h"

#include "SeriesFiles.h"

#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Cache/BrickCache.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Series/Encode/SeriesEncoder.h"

#include <cstdio>
#include <filesystem>

namespace banyan::bench
{
namespace
{

constexpr std::uint64_t AllMemory = std::uint64_t{ 1 } << 40;

/// @param every how many bricks one is read of
void ReadOnce(const std::string& series, bool cold, std::int64_t every)
{
  BrickCache cache(AllMemory);
  SeriesBrickSource source(SeriesFile::Open(series), {}, 0, cache);
  source.RangeOf(0); // what is known of bricks without their values is read once
  if (cold)
  {
    DropFromCache(series);
  }
  const Timer timer;
  const glm::ivec3 counts = source.Bricks();
  const std::int64_t all = std::int64_t{ counts.x } * counts.y * counts.z;
  std::int64_t bricks = 0;
  for (std::int64_t brick = 0; brick < all; brick += every, ++bricks)
  {
    source.Load(brick);
  }
  const double seconds = timer.Seconds();
  std::printf("%s, 1 of %lld bricks: %lld bricks, series of %.1f MB, %.1f ms, %.2f us per brick\n",
    cold ? "from the disk" : "from the system's cache", static_cast<long long>(every),
    static_cast<long long>(bricks), BytesOf(series) / 1e6, 1e3 * seconds,
    1e6 * seconds / static_cast<double>(bricks));
}

} // namespace

void EncodeForDisk(const BenchScene& scene, const std::string& series)
{
  if (std::filesystem::exists(series))
  {
    return;
  }
  Grid grid;
  grid.Extent.Hi = scene.Data->Samples;
  ArrayDescription array;
  array.Name = "value";
  array.Type = scene.Data->Type();
  array.ComponentNames = { "" };
  array.SeriesRanges = { { scene.Low, scene.High } };
  ThreadPool pool(1);
  SeriesEncoder encoder(series, grid, { array }, {}, pool);
  encoder.AddStep(0.0, { { scene.Data->Values() } });
  encoder.Finish();
  BringToDisk(series);
}

void ReadBricks(const std::string& series)
{
  for (const std::int64_t every : { 1, 64 })
  {
    for (int round = 0; round < 3; ++round)
    {
      for (const bool cold : { true, false })
      {
        ReadOnce(series, cold, every);
      }
    }
  }
}

} // namespace banyan::bench
