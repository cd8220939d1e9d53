// SPDX-License-Identifier: BSD-3-Clause
// Which bricks are those of the step before.
#include "Series/SeriesTesting.h"

#include <algorithm>

namespace
{

using namespace banyan;
using namespace banyan::testing;

/// Steps of which each but every third one has two rows swapped, inside of one brick: the numbers
/// of that brick have the same extremes and sums then, and are others.
Steps<std::uint8_t> SwappedRows(const Grid& grid, int count)
{
  Steps<std::uint8_t> steps;
  std::mt19937 random(3);
  const glm::ivec3 n = grid.Samples();
  std::vector<std::uint8_t> values(static_cast<std::size_t>(n.x) * n.y * n.z);
  std::generate(
    values.begin(), values.end(), [&] { return static_cast<std::uint8_t>(random() % 200); });
  const auto row = [&](int y, int z)
  { return values.begin() + (std::ptrdiff_t{ z } * n.y + y) * n.x; };
  for (int step = 0; step < count; ++step)
  {
    if (step % 3 != 0)
    {
      std::swap_ranges(row(3, 4) + 1, row(3, 4) + 15, row(6, 9) + 1);
    }
    steps.push_back(values);
  }
  return steps;
}

TEST(UnchangedBricks, AreThoseThatDecodeToTheSameBits)
{
  const Grid grid = GridOf(40, 33, 32);
  const auto steps = SwappedRows(grid, 11);
  for (const int interval : { 1, 4, 8 })
  {
    const TemporaryFolder folder;
    EncodeOptions options;
    options.ErrorBound = 0.0;
    options.KeyframeInterval = interval;
    Encode(folder / "rows.banyan", grid, steps, options);
    const auto file = SeriesFile::Open(folder / "rows.banyan");
    BrickCache cache(std::uint64_t{ 1 } << 26);
    int same = 0, others = 0;
    for (int step = 1; step < static_cast<int>(steps.size()); ++step)
    {
      const FieldKey now{ step, 0, 0, 0 }, before{ step - 1, 0, 0, 0 };
      const auto nodes = file->Nodes(now), nodesBefore = file->Nodes(before);
      for (std::size_t i = 0; i < nodes->size(); ++i)
      {
        const auto brick = static_cast<std::int64_t>(i);
        const auto a = cache.Get(*file, now, brick), b = cache.Get(*file, before, brick);
        const bool equal = std::memcmp(a->As<std::uint8_t>(), b->As<std::uint8_t>(),
                             static_cast<std::size_t>(a->Samples.Count())) == 0;
        EXPECT_EQ((*nodes)[i].Identity == (*nodesBefore)[i].Identity, equal)
          << "interval " << interval << ", step " << step << ", brick " << i;
        ++(equal ? same : others);
      }
    }
    EXPECT_EQ(others, 7); // one brick, in seven of ten steps
    EXPECT_GT(same, 50);
  }
}

} // namespace
