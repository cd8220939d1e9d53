// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Render/Sampling/ImageError.h"
#include "Render/Scene/RayLattice.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

/// Every k-th sample, as levels have them.
std::vector<float> Coarser(const std::vector<float>& values, const glm::ivec3& n, int every)
{
  const glm::ivec3 size = (n - 2 + every) / every + 1;
  std::vector<float> coarse;
  for (int z = 0; z < size.z; ++z)
  {
    for (int y = 0; y < size.y; ++y)
    {
      for (int x = 0; x < size.x; ++x)
      {
        const glm::ivec3 p = glm::min(glm::ivec3(x, y, z) * every, n - 1);
        coarse.push_back(values[p.x + std::size_t(n.x) * (p.y + std::size_t(n.y) * p.z)]);
      }
    }
  }
  return coarse;
}

void ExpectSame(const FloatImage& a, const FloatImage& b, const PixelRect& where)
{
  for (int y = where.Lo.y; y < where.Hi.y; ++y)
  {
    for (int x = where.Lo.x; x < where.Hi.x; ++x)
    {
      const auto pixel = [&](const FloatImage& image)
      {
        const bool inside = x >= image.Rect.Lo.x && x < image.Rect.Hi.x && y >= image.Rect.Lo.y &&
                            y < image.Rect.Hi.y;
        return inside ? image.At(x, y) : glm::vec4(0.0f);
      };
      ASSERT_EQ(pixel(a), pixel(b)) << x << ", " << y;
    }
  }
}

class TileSamplingsTest : public testing::Test
{
protected:
  glm::ivec3 N{ 41, 38, 47 };
  std::vector<float> Values = scenes::Sampled<float>(scenes::Standard, this->N);
  RayScene Scene = scenes::Scene(this->N, { 90, 70 });

  FloatImage Draw(const RayScene& scene, int brickCells = 16, int threads = 1)
  {
    return scenes::Draw(scene, scenes::ArrayOf(this->Values, this->N), { brickCells, threads })
      .Image;
  }

  RayScene With(const std::vector<RaySampling>& samplings,
    const std::function<int(const glm::ivec2&)>& number) const
  {
    auto tiles = std::make_shared<TileSamplings>(this->Scene.Camera.ImageSize(), samplings);
    for (int y = 0; y < tiles->Tiles().y; ++y)
    {
      for (int x = 0; x < tiles->Tiles().x; ++x)
      {
        tiles->SetNumber({ x, y }, number({ x, y }));
      }
    }
    RayScene scene = this->Scene;
    scene.Samplings = tiles;
    return scene;
  }
  RayScene With(const RaySampling& sampling) const
  {
    return this->With({ sampling }, [](const glm::ivec2&) { return 0; });
  }
};

TEST_F(TileSamplingsTest, AsManyAsLevelsDistancesAndStridesGive)
{
  const std::vector<RaySampling> many(700, RaySampling{});
  TileSamplings samplings({ 90, 70 }, many);
  samplings.SetNumber({ 1, 2 }, 699);
  EXPECT_EQ(samplings.NumberAt({ 1, 2 }), 699);
  EXPECT_EQ(samplings.NumberAt({ 0, 0 }), 0);
  EXPECT_TRUE(samplings.Used()[699]);
  EXPECT_FALSE(samplings.Used()[699 - 512]);
  EXPECT_THROW(TileSamplings({ 90, 70 }, {}), Error);
  EXPECT_THROW(TileSamplings({ 90, 70 }, std::vector<RaySampling>(65537)), Error);
}

TEST_F(TileSamplingsTest, OneSamplingIsTheSampleDistance)
{
  for (const double distance : { 0.7, 2.5 })
  {
    this->Scene.SampleDistance = distance;
    const FloatImage expected = this->Draw(this->Scene);
    EXPECT_GT(expected.Rect.Count(), 1000);
    ExpectSame(this->Draw(this->With(RaySampling{ 0, distance })), expected, this->Scene.Viewport);
  }
}

TEST_F(TileSamplingsTest, EachTileHasItsOwn)
{
  const std::vector<RaySampling> samplings{ { 0, 0.5 }, { 1, 2.0 }, { 0, 3.0 }, { 2, 4.0 } };
  const auto number = [](const glm::ivec2& tile) { return (tile.x + 2 * tile.y) % 4; };
  for (const int threads : { 1, 3 })
  {
    const FloatImage mixed = this->Draw(this->With(samplings, number), 16, threads);
    for (int i = 0; i < 4; ++i)
    {
      const FloatImage pure = this->Draw(this->With(samplings[static_cast<std::size_t>(i)]));
      for (int y = 0; y < 3; ++y)
      {
        for (int x = 0; x < 3; ++x)
        {
          const glm::ivec2 low = glm::ivec2(x, y) * TileSamplings::Edge;
          if (number({ x, y }) == i)
          {
            ExpectSame(
              mixed, pure, Intersection({ low, low + TileSamplings::Edge }, this->Scene.Viewport));
          }
        }
      }
    }
  }
}

TEST_F(TileSamplingsTest, ALevelIsTheGridOfEverySecondSample)
{
  // Whole cells only, so that the coarser grid ends where the finer one does.
  this->N = { 41, 37, 45 };
  this->Values = scenes::Sampled<float>(scenes::Standard, this->N);
  this->Scene = scenes::Scene(this->N, { 90, 70 });
  for (const int level : { 1, 2 })
  {
    const int every = 1 << level;
    const std::vector<float> coarse = Coarser(this->Values, this->N, every);
    RayScene same = this->Scene;
    same.IndexToWorld = glm::scale(same.IndexToWorld, glm::dvec3(every));
    same.DomainCells = { glm::ivec3(0), (this->N - 1) / every };
    same.SampleDistance = 1.5;
    for (const bool shaded : { false, true })
    {
      same.Shading.On = this->Scene.Shading.On = shaded;
      const FloatImage expected =
        scenes::Draw(same, scenes::ArrayOf(coarse, (this->N - 1) / every + 1)).Image;
      const FloatImage drawn = this->Draw(this->With({ level, 1.5 }));
      // The projection of boxes rounds in other units, so only the values are the same bits.
      ExpectSame(drawn, expected, Intersection(drawn.Rect, expected.Rect));
      EXPECT_GT(drawn.Rect.Count(), 1000);
    }
  }
}

TEST_F(TileSamplingsTest, LevelsEndWhereTheGridEnds)
{
  // 40 x 37 x 46 cells: neither 2 nor 4 divide all of them.
  for (const int level : { 1, 2, 3 })
  {
    const FloatImage fine = this->Draw(this->With({ 0, 0.25 }));
    const FloatImage coarse = this->Draw(this->With({ level, 0.25 }));
    // Rays that miss the grid see nothing of what the last coarse cell has beyond it.
    int touched = 0;
    for (int y = coarse.Rect.Lo.y; y < coarse.Rect.Hi.y; ++y)
    {
      for (int x = coarse.Rect.Lo.x; x < coarse.Rect.Hi.x; ++x)
      {
        if (RayLattice(this->Scene).SamplesOf(x, y).Empty())
        {
          ASSERT_EQ(coarse.At(x, y).a, 0.0f);
          ++touched;
        }
      }
    }
    EXPECT_GT(touched, 20);
    EXPECT_LT(MaxDifference(fine, coarse), 0.15 * level);
  }
}

TEST_F(TileSamplingsTest, BrickSizeAndMagnitudeChangeNoBit)
{
  const RayScene scene =
    this->With({ { 1, 1.7 }, { 2, 3.0 } }, [](const glm::ivec2& tile) { return tile.x % 2; });
  const FloatImage expected = this->Draw(scene, 16);
  ExpectSame(this->Draw(scene, 8), expected, scene.Viewport);
  ExpectSame(this->Draw(scene, 32), expected, scene.Viewport);
  // Values that have to be copied: the magnitude of one component that is not negative.
  SampleArray array = scenes::ArrayOf(this->Values, this->N);
  array.Component = SampleArray::Magnitude;
  ExpectSame(scenes::Draw(scene, array).Image, expected, scene.Viewport);
}

TEST_F(TileSamplingsTest, PiecesOfAGridHaveNoLevels)
{
  SampleArray array = scenes::ArrayOf(this->Values, this->N);
  array.Samples.Hi.z = 20;
  RayScene scene = this->With(RaySampling{ 1, 2.0 });
  EXPECT_THROW(scenes::Draw(scene, array), Error);
  scene.Samplings = std::make_shared<const TileSamplings>(
    glm::ivec2(400, 70), std::vector<RaySampling>{ { 0, 1.0 } });
  EXPECT_THROW(this->Draw(scene), Error);
}

} // namespace
