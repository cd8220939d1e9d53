// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/TinyMeshes.h"

#include "Mesh/Octree/HexBricks.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <set>

namespace
{

using namespace banyan;

TEST(HexBrickOrder, IsExactFrontToBack)
{
  const auto mesh =
    meshes::Make(meshes::Wild({ 1, 1, 1 }, 4, 6), glm::dvec3(0.0), glm::dvec3(1.0), 3);
  const HexBricks all(meshes::Find(mesh.Mesh()), 2);
  const std::vector<HexBrick>& bricks = all.List();
  std::mt19937 random(2);
  std::uniform_real_distribution<double> around(-8.0, 24.0);
  for (int view = 0; view < 20; ++view)
  {
    Viewpoint from;
    from.Parallel = view % 2 == 1;
    from.Eye = { around(random), around(random), around(random) };
    from.Direction = glm::dvec3(around(random), around(random), around(random)) - 8.0;
    const std::vector<std::int64_t> ranks = all.RanksFrontToBack(from);
    EXPECT_EQ(std::set<std::int64_t>(ranks.begin(), ranks.end()).size(), bricks.size());
    // Rays through random places meet bricks in the order of their ranks.
    for (int ray = 0; ray < 200; ++ray)
    {
      const glm::dvec3 through(
        0.5 * (around(random) + 8.0), 0.5 * (around(random) + 8.0), 0.5 * (around(random) + 8.0));
      const glm::dvec3 way = from.Parallel ? from.Direction : through - from.Eye;
      const glm::dvec3 start = from.Parallel ? through - 3.0 * way : from.Eye;
      std::vector<std::pair<double, std::int64_t>> met;
      for (std::size_t i = 0; i < bricks.size(); ++i)
      {
        const Box box = bricks[i].FinestCells();
        double in = from.Parallel ? -1e9 : 0.0;
        double out = 1e9;
        for (int axis = 0; axis < 3; ++axis)
        {
          const double a = (box.Lo[axis] - start[axis]) / way[axis];
          const double b = (box.Hi[axis] - start[axis]) / way[axis];
          in = std::max(in, std::min(a, b));
          out = std::min(out, std::max(a, b));
        }
        if (in + 1e-9 < out)
        {
          met.emplace_back(in, ranks[i]);
        }
      }
      std::sort(met.begin(), met.end());
      for (std::size_t i = 1; i < met.size(); ++i)
      {
        ASSERT_LT(met[i - 1].second, met[i].second);
      }
    }
  }
}

} // namespace
