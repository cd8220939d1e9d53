// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/VisibilityOrder.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace
{

using namespace banyan;

/// Every ray from the viewer must meet the bricks in the order given.
void ExpectOrder(
  const Viewpoint& view, const BrickSource& source, const Box& cells, std::mt19937& random)
{
  const std::vector<std::int64_t> order = VisibilityOrder(view, source, cells);
  std::vector<int> rank(source.Bricks().x * source.Bricks().y * source.Bricks().z, -1);
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    EXPECT_EQ(rank[order[i]], -1);
    rank[order[i]] = static_cast<int>(i);
  }
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const auto point = [&]
  {
    return glm::dvec3(cells.Lo) +
           glm::dvec3(unit(random), unit(random), unit(random)) * glm::dvec3(cells.Size());
  };
  const auto brickAt = [&](const glm::dvec3& p)
  {
    for (const std::int64_t brick : order)
    {
      if (source.CellsOf(brick).Contains(glm::ivec3(glm::floor(p))))
      {
        return brick;
      }
    }
    return std::int64_t{ -1 };
  };
  for (int i = 0; i < 200; ++i)
  {
    const glm::dvec3 target = point();
    const glm::dvec3 origin = view.Parallel ? target - 100.0 * view.Direction : view.Eye;
    int last = -1;
    for (int step = 1; step <= 300; ++step) // at the eye itself no brick hides another
    {
      const std::int64_t brick = brickAt(origin + (target - origin) * (step / 300.0));
      if (brick >= 0)
      {
        EXPECT_GE(rank[brick], last);
        last = rank[brick];
      }
    }
    EXPECT_GE(last, 0);
  }
}

TEST(VisibilityOrder, EyeAnywhereAndParallel)
{
  ThreadPool pool(1);
  const glm::ivec3 n(14, 11, 9);
  const std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  const ArrayBrickSource source(scenes::ArrayOf(values, n), 3, { 0, 1 }, pool);
  const Box cells{ glm::ivec3(0), n - 1 };
  std::mt19937 random(1);
  std::uniform_real_distribution<double> unit(-1.0, 1.0);
  for (int i = 0; i < 20; ++i)
  {
    Viewpoint view;
    const glm::dvec3 away(unit(random), unit(random), unit(random));
    view.Eye = glm::dvec3(7, 5, 4) + away * (i % 2 ? 6.0 : 40.0); // inside and outside
    ExpectOrder(view, source, cells, random);
    view.Parallel = true;
    view.Direction = away;
    ExpectOrder(view, source, cells, random);
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    Viewpoint view;
    view.Parallel = true;
    view.Direction = glm::dvec3(0.0);
    view.Direction[axis] = axis == 1 ? -1.0 : 1.0;
    ExpectOrder(view, source, cells, random);
    view.Parallel = false;
    view.Eye = glm::dvec3(6, 6, 3); // on brick faces
    ExpectOrder(view, source, cells, random);
  }
}

TEST(VisibilityOrder, OnlyBricksWithCellsAskedFor)
{
  ThreadPool pool(1);
  const glm::ivec3 n(9);
  const std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  const ArrayBrickSource source(scenes::ArrayOf(values, n), 4, { 0, 1 }, pool);
  const Viewpoint view;
  EXPECT_EQ(VisibilityOrder(view, source, { glm::ivec3(0), glm::ivec3(8) }).size(), 8u);
  EXPECT_EQ(VisibilityOrder(view, source, { glm::ivec3(3), glm::ivec3(4, 5, 4) }),
    (std::vector<std::int64_t>{ 0, 2 }));
  EXPECT_TRUE(VisibilityOrder(view, source, {}).empty());
}

} // namespace
