// SPDX-License-Identifier: BSD-3-Clause
// What a camera that moves shows next.
#include "Render/Scenes.h"

#include "Render/Bricks/ArrayBrickSource.h"
#include "Render/Bricks/ViewPrefetcher.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace
{

using namespace banyan;

const glm::ivec2 Pixels(80, 60);
const glm::ivec3 Samples(65);
const glm::dvec3 Middle(32.0);

enum class Move
{
  Round,
  Past,
  Away,
  Aside ///< parallel projection
};

/// A camera close to the volume, of which it shows a part, at a time.
RayCamera At(Move move, double time)
{
  glm::dmat4 view = glm::lookAt(Middle + glm::dvec3(20, 15, 70), Middle, glm::dvec3(0, 1, 0));
  glm::dmat4 projection = glm::perspective(0.5, 4.0 / 3.0, 1.0, 500.0);
  switch (move)
  {
    case Move::Round:
      view = view * glm::translate(glm::dmat4(1.0), Middle) *
             glm::rotate(glm::dmat4(1.0), 0.25 * time, glm::dvec3(0.2, 1, 0)) *
             glm::translate(glm::dmat4(1.0), -Middle);
      break;
    case Move::Past:
      view = glm::translate(glm::dmat4(1.0), glm::dvec3(5.0 * time, -3.0 * time, 0)) * view;
      break;
    case Move::Away:
      view = glm::translate(glm::dmat4(1.0), glm::dvec3(0, 0, -12.0 * time)) * view;
      break;
    case Move::Aside:
      projection = glm::ortho(-16.0, 16.0, -12.0, 12.0, 1.0, 500.0);
      view = glm::translate(glm::dmat4(1.0), glm::dvec3(-2.0 * time, 0, 0)) * view;
      break;
  }
  return { projection * view, Pixels, Middle };
}

RayScene SceneAt(Move move, double time)
{
  RayScene scene = scenes::Scene(Samples, Pixels);
  scene.Camera = At(move, time);
  return scene;
}

class ViewPrefetcherOf : public ::testing::TestWithParam<Move>
{
protected:
  ThreadPool Pool{ 1 };
  const std::vector<float> Values = scenes::Sampled<float>(scenes::Standard, Samples);
  ArrayBrickSource Source{ scenes::ArrayOf(this->Values, Samples), 8, { 0.0, 1.0 }, this->Pool };
};

INSTANTIATE_TEST_SUITE_P(
  Moves, ViewPrefetcherOf, ::testing::Values(Move::Round, Move::Past, Move::Away, Move::Aside));

TEST_P(ViewPrefetcherOf, AnEvenMoveIsExpectedToGoOn)
{
  const RayScene scene = SceneAt(this->GetParam(), 1.0);
  const std::optional<RayScene> next =
    SceneAfter(scene, At(this->GetParam(), 0.0).ClipToWorldMatrix());
  ASSERT_TRUE(next);
  const RayCamera truth = At(this->GetParam(), 2.0);
  for (const glm::ivec2 pixel : { glm::ivec2(0, 0), glm::ivec2(79, 59), glm::ivec2(33, 7) })
  {
    const Ray expected = truth.RayOf(pixel.x, pixel.y);
    const Ray found = next->Camera.RayOf(pixel.x, pixel.y);
    EXPECT_LT(glm::length(expected.Direction - found.Direction), 1e-9);
    // Of parallel rays the one through the same pixel starts on the same line.
    const glm::dvec3 apart = found.Origin - expected.Origin;
    EXPECT_LT(glm::length(glm::cross(apart, expected.Direction)), 1e-7);
  }
}

TEST_P(ViewPrefetcherOf, WhatComesOntoTheScreenIsFound)
{
  const RayScene scene = SceneAt(this->GetParam(), 1.0);
  const RayScene next = SceneAt(this->GetParam(), 2.0);
  const Box cells{ { 3, 0, 10 }, { 64, 64, 60 } };
  const std::vector<std::int64_t> found = BricksComingOntoScreen(scene, next, this->Source, cells);
  const std::set<std::int64_t> unique(found.begin(), found.end());
  EXPECT_EQ(unique.size(), found.size());
  int coming = 0;
  for (std::int64_t brick = 0; brick < 512; ++brick)
  {
    const Box part = Intersection(this->Source.CellsOf(brick), cells);
    const glm::dvec3 low(part.Lo);
    const glm::dvec3 high(part.Hi);
    const bool now = !scene.Camera.Footprint(low, high).Empty();
    const bool then = !next.Camera.Footprint(low, high).Empty();
    if (part.Empty() || (now && !then))
    {
      EXPECT_EQ(unique.count(brick), 0u) << brick;
    }
    // A footprint may be a pixel too large: of bricks at the very edge nothing is said.
    const bool surely = scene.Camera.Footprint(low - 0.5, high + 0.5).Empty() && then;
    if (!part.Empty() && surely)
    {
      ++coming;
      EXPECT_EQ(unique.count(brick), 1u) << brick;
    }
  }
  EXPECT_GE(coming, 3);
  EXPECT_LT(unique.size(), 256u) << "far from all";
}

TEST(ViewPrefetcher, NothingComesWhereEverythingIsSeen)
{
  ThreadPool pool(1);
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, Samples);
  const ArrayBrickSource source(scenes::ArrayOf(values, Samples), 8, { 0.0, 1.0 }, pool);
  const RayScene scene = scenes::Scene(Samples, Pixels, glm::dmat4(1.0), 3.0);
  RayScene next = scene;
  next.Camera = SceneAt(Move::Round, 1.0).Camera;
  EXPECT_TRUE(BricksComingOntoScreen(scene, next, source, scene.DomainCells).empty());
}

TEST(ViewPrefetcher, WhatIsInvisibleIsNotExpected)
{
  ThreadPool pool(1);
  const std::vector<float> values(
    static_cast<std::size_t>(Samples.x) * Samples.y * Samples.z, 0.1f);
  const ArrayBrickSource source(scenes::ArrayOf(values, Samples), 8, { 0.0, 1.0 }, pool);
  RayScene scene = SceneAt(Move::Past, 1.0);
  RayScene next = SceneAt(Move::Past, 2.0);
  scene.Transfer = next.Transfer = scenes::Tabulate(scenes::Sparse);
  EXPECT_TRUE(BricksComingOntoScreen(scene, next, source, scene.DomainCells).empty());
}

} // namespace
