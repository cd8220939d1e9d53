// SPDX-License-Identifier: BSD-3-Clause
#include "BrickRates.h"

#include "SeriesFiles.h"

#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Series/Encode/SeriesEncoder.h"

#include <ctime>

namespace banyan::bench
{
namespace
{

void Encode(const Volume& volume, const std::string& series)
{
  const glm::ivec3 samples = glm::min(volume.Samples, glm::ivec3(256));
  const glm::ivec3 first = (volume.Samples - samples) / 2;
  std::vector<std::uint8_t> values;
  for (int z = first.z; z < first.z + samples.z; ++z)
  {
    for (int y = first.y; y < first.y + samples.y; ++y)
    {
      const std::size_t row = static_cast<std::size_t>(z) * volume.Samples.y + y;
      const auto from =
        volume.Codes.begin() + static_cast<std::ptrdiff_t>(row * volume.Samples.x + first.x);
      values.insert(values.end(), from, from + samples.x);
    }
  }
  Grid grid;
  grid.Extent.Hi = samples;
  ArrayDescription array;
  array.Name = "value";
  array.Type = ScalarType::UInt8;
  array.ComponentNames = { "" };
  array.SeriesRanges = { { 0.0, 255.0 } };
  ThreadPool pool(1);
  SeriesEncoder encoder(series, grid, { array }, {}, pool);
  encoder.AddStep(0.0, { { values.data() } });
  encoder.Finish();
}

} // namespace

BrickRates MeasuredBrickRates(const Volume& volume, const std::string& folder)
{
  const std::string series = folder + "/middle.banyan";
  Encode(volume, series);
  BrickCache cache(std::uint64_t{ 1 } << 40);
  SeriesBrickSource source(SeriesFile::Open(series), {}, 0, cache);
  source.RangeOf(0); // what is known of bricks without their values is read once
  const glm::ivec3 counts = source.Bricks();
  const std::int64_t all = std::int64_t{ counts.x } * counts.y * counts.z;
  const std::clock_t before = std::clock();
  for (std::int64_t brick = 0; brick < all; ++brick)
  {
    source.Load(brick);
  }
  const double seconds = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
  return { BytesOf(series) / static_cast<double>(all), seconds / static_cast<double>(all) };
}

} // namespace banyan::bench
