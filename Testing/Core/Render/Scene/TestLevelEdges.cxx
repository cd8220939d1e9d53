// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/LevelEdges.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

TEST(LevelEdges, AreTheSameAlongAllAxesUnlessAGridIsFlat)
{
  for (const LevelEdges& edges :
    { LevelEdges(), LevelEdges::Following({ 100, 100, 51 }), LevelEdges::Following({ 0, 0, 0 }) })
  {
    EXPECT_EQ(edges.At(0), glm::ivec3(1));
    EXPECT_EQ(edges.At(1), glm::ivec3(2));
    EXPECT_EQ(edges.At(30), glm::ivec3(1 << 30));
    EXPECT_FALSE(edges.AreFinest());
  }
}

TEST(LevelEdges, KeepTheShortAxesOfFlatGrids)
{
  const LevelEdges edges = LevelEdges::Following({ 2048, 128, 700 });
  EXPECT_EQ(edges.At(0), glm::ivec3(1));
  EXPECT_EQ(edges.At(1), glm::ivec3(2, 1, 1));  // 1024 x 128 x 700
  EXPECT_EQ(edges.At(2), glm::ivec3(4, 1, 2));  // 512 x 128 x 350
  EXPECT_EQ(edges.At(4), glm::ivec3(16, 1, 8)); // 128 x 128 x 88
  EXPECT_EQ(edges.At(5), glm::ivec3(32, 2, 16));
}

/// From level to level, an axis is halved where it is longer than half of the longest one.
TEST(LevelEdges, AreWhatTheRuleSays)
{
  for (const glm::ivec3& cells : { glm::ivec3(1, 1, 1 << 26), glm::ivec3(63, 1000, 64),
         glm::ivec3(64, 32, 33), glm::ivec3(16384, 16384, 128), glm::ivec3(7, 0, 3) })
  {
    const LevelEdges edges = LevelEdges::Following(cells);
    glm::dvec3 length(glm::max(cells, 1));
    glm::ivec3 expected(1);
    for (int level = 0; level < 30; ++level)
    {
      ASSERT_EQ(edges.At(level), expected) << level;
      const double longest = std::max({ length.x, length.y, length.z });
      for (int axis = 0; axis < 3; ++axis)
      {
        const bool halved = length[axis] > 0.5 * longest;
        length[axis] *= halved ? 0.5 : 1.0;
        expected[axis] *= halved ? 2 : 1;
      }
    }
  }
}

TEST(LevelEdges, OfMeshesAreOneEverywhere)
{
  EXPECT_TRUE(LevelEdges::Finest().AreFinest());
  EXPECT_EQ(LevelEdges::Finest().At(30), glm::ivec3(1));
}

} // namespace
