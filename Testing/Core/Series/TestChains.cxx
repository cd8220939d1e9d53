// SPDX-License-Identifier: BSD-3-Clause
// How many steps a look at one brick takes: what an encoding tells is what a reader decodes.
#include "Series/SeriesTesting.h"

#include "Series/Decode/CacheContext.h"
#include "Series/Format/GroupFormat.h"

#include <set>

namespace banyan::testing
{
namespace
{

struct Case
{
  Grid Domain;
  int BrickCells;
  int Interval;
  double Rest; ///< the part along x that does not move
};

class Chains : public ::testing::TestWithParam<Case>
{
};

/// Steps of which the cache holds a box.
std::size_t StepsDecoded(const SeriesFile& file)
{
  const SeriesIndex& index = file.Index();
  const group::TableShape shape =
    group::ShapeOf(index.Domain.Samples(), { 0, 1, 2 }, index.BrickCells, 1);
  std::uint64_t most = 0; // blocks of a plane, in whatever order of axes
  for (const glm::ivec3& n : shape.Blocks)
  {
    most = std::max(most, static_cast<std::uint64_t>(n.x) * static_cast<std::uint64_t>(n.y) *
                            static_cast<std::uint64_t>(n.z));
  }
  std::set<int> steps;
  for (int step = 0; step < index.Steps(); ++step)
  {
    for (std::uint16_t plane = 0; plane < shape.Blocks.size(); ++plane)
    {
      for (std::uint64_t block = 0; block < most; ++block)
      {
        if (file.Caches()->Blocks().Find(
              { file.Id(), block, static_cast<std::uint32_t>(step), 0, plane }))
        {
          steps.insert(step);
        }
      }
    }
  }
  return steps.size();
}

TEST_P(Chains, AreAsLongAsToldStartingWithNothingInMemory)
{
  const Case& c = GetParam();
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const glm::ivec3 n = c.Domain.Samples();
  const int count = 2 * c.Interval + 3;
  const auto steps = Sample<float>(c.Domain, count,
    [&](int x, int y, int z, int s)
    {
      const bool rests = x < c.Rest * n.x;
      return rests && z < n.z / 2 ? 1.0f : Wavy<float>(x, y, z, rests ? 0 : s);
    });
  EncodeOptions options;
  options.BrickCells = c.BrickCells;
  options.KeyframeInterval = c.Interval;
  ArrayDescription description = Describe(steps);
  description.SeriesRanges = { ValueRange{ -60.0, 100.0 } };
  ThreadPool pool(2);
  SeriesEncoder encoder(path, c.Domain, { description }, options, pool);
  for (int s = 0; s < count; ++s)
  {
    encoder.AddStep(s, { { steps[static_cast<std::size_t>(s)].data() } });
  }
  const EncodeStatistics told = encoder.Finish().Statistics;
  const auto file = SeriesFile::Open(path);
  const BrickLayout layout = file->Layout(0);
  std::int64_t sum = 0, most = 0;
  for (int s = 0; s < count; ++s)
  {
    for (std::int64_t b = 0; b < layout.BrickCount(); ++b)
    {
      file->Caches()->Blocks().Forget(file->Id());
      std::vector<float> values(static_cast<std::size_t>(layout.SamplesOf(b).Count()));
      file->DecodeBrick({ s, 0, 0, 0 }, b, values.data());
      // A brick of one value is not decoded, and is a look at its own step.
      const auto chain = static_cast<std::int64_t>(std::max<std::size_t>(1, StepsDecoded(*file)));
      sum += chain;
      most = std::max(most, chain);
    }
  }
  EXPECT_EQ(told.ChainBricks, count * layout.BrickCount());
  EXPECT_EQ(told.ChainSum, sum);
  EXPECT_EQ(told.ChainMost, most);
}

INSTANTIATE_TEST_SUITE_P(Series, Chains,
  ::testing::Values(Case{ GridOf(73, 65, 69), 16, 8, 0.4 }, Case{ GridOf(70, 20, 19), 16, 4, 0.5 },
    Case{ GridOf(33, 17, 17), 16, 5, 0.0 }, Case{ GridOf(33, 67, 34), 32, 1, 0.0 },
    Case{ GridOf(17, 17, 17), 16, 70, 0.0 }, Case{ GridOf(1, 60, 60), 16, 3, 0.0 }));

} // namespace
} // namespace banyan::testing
