// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/Zones.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace banyan
{
namespace
{

/// How often each position of a grid is covered.
std::vector<int> Cover(const std::vector<Box>& boxes, const glm::ivec3& size)
{
  std::vector<int> cover(static_cast<std::size_t>(size.x) * size.y * size.z, 0);
  for (const Box& box : boxes)
  {
    for (int z = box.Lo.z; z < box.Hi.z; ++z)
    {
      for (int y = box.Lo.y; y < box.Hi.y; ++y)
      {
        for (int x = box.Lo.x; x < box.Hi.x; ++x)
        {
          ++cover[(static_cast<std::size_t>(z) * size.y + y) * size.x + x];
        }
      }
    }
  }
  return cover;
}

std::int64_t Fullest(const std::vector<Box>& zones)
{
  std::int64_t fullest = 0;
  for (const Box& zone : zones)
  {
    fullest = std::max(fullest, zone.Count());
  }
  return fullest;
}

TEST(StaticZones, CoverTheGridOnce)
{
  std::mt19937 random(1);
  std::vector<glm::ivec3> grids{ { 1, 1, 1 }, { 1, 1, 64 }, { 2, 2, 2 }, { 7, 5, 3 },
    { 16, 16, 16 }, { 13, 1, 11 } };
  for (int i = 0; i < 20; ++i)
  {
    grids.emplace_back(random() % 12 + 1, random() % 12 + 1, random() % 12 + 1);
  }
  for (const glm::ivec3& grid : grids)
  {
    for (int ranks = 1; ranks <= 64; ++ranks)
    {
      const std::vector<Box> zones = StaticZones(grid, ranks);
      ASSERT_EQ(zones.size(), static_cast<std::size_t>(ranks));
      const std::vector<int> cover = Cover(zones, grid);
      EXPECT_TRUE(std::all_of(cover.begin(), cover.end(), [](int n) { return n == 1; }))
        << grid.x << "x" << grid.y << "x" << grid.z << " on " << ranks;
    }
  }
}

TEST(StaticZones, AreBalanced)
{
  for (int ranks = 1; ranks <= 64; ++ranks)
  {
    // A plane stands at most half a slab off the ideal ratio, at each level of the tree.
    const std::vector<Box> zones = StaticZones({ 64, 64, 64 }, ranks);
    const double mean = 64.0 * 64.0 * 64.0 / ranks;
    EXPECT_LT(static_cast<double>(Fullest(zones)), 1.15 * mean) << ranks;
  }
  EXPECT_EQ(Fullest(StaticZones({ 4, 4, 4 }, 64)), 1);
  EXPECT_EQ(Fullest(StaticZones({ 5, 3, 1 }, 15)), 1);
  EXPECT_EQ(Fullest(StaticZones({ 32, 32, 32 }, 8)), 16 * 16 * 16);
}

TEST(StaticZones, MoreRanksThanBricksLeaveSomeEmpty)
{
  const std::vector<Box> zones = StaticZones({ 1, 2, 1 }, 17);
  EXPECT_EQ(std::count_if(zones.begin(), zones.end(), [](const Box& b) { return !b.Empty(); }), 2);
  EXPECT_EQ(Fullest(zones), 1);
}

TEST(StaticZones, SplitTheLongestAxis)
{
  const std::vector<Box> zones = StaticZones({ 4, 9, 4 }, 3);
  EXPECT_EQ(zones[0], (Box{ { 0, 0, 0 }, { 4, 3, 4 } }));
  EXPECT_EQ(zones[2].Hi, glm::ivec3(4, 9, 4));
}

TEST(StaticZones, NothingToCutAndNoRanks)
{
  for (const Box& zone : StaticZones({ 0, 3, 3 }, 5))
  {
    EXPECT_TRUE(zone.Empty());
  }
  EXPECT_THROW(StaticZones({ 1, 1, 1 }, 0), Error);
}

TEST(CellsOfBricks, EndsWithTheGrid)
{
  EXPECT_EQ(CellsOfBricks({ { 0, 1, 2 }, { 2, 2, 3 } }, 16, { 32, 31, 33 }),
    (Box{ { 0, 16, 32 }, { 32, 31, 33 } }));
  EXPECT_TRUE(CellsOfBricks({ { 0, 0, 0 }, { 1, 1, 1 } }, 16, { 5, 5, 0 }).Empty());
  EXPECT_TRUE(CellsOfBricks({ { 1, 1, 1 }, { 1, 2, 2 } }, 16, { 50, 50, 50 }).Empty());
}

} // namespace
} // namespace banyan
