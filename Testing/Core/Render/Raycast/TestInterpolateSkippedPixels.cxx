// SPDX-License-Identifier: BSD-3-Clause
// Pictures of which only some pixels have rays, and what fills the others.
#include "Base/ThreadPool.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

class SkippedPixels : public testing::Test
{
protected:
  SkippedPixels()
  {
    // All strides beside all others, and tiles cut by the edges of the picture.
    const std::vector<RaySampling> samplings{ { 0, 0.8, 1 }, { 1, 2.0, 2 }, { 0, 1.5, 4 },
      { 0, 0.8, 8 } };
    auto tiles = std::make_shared<TileSamplings>(this->Scene.Camera.ImageSize(), samplings);
    for (int y = 0; y < tiles->Tiles().y; ++y)
    {
      for (int x = 0; x < tiles->Tiles().x; ++x)
      {
        tiles->SetNumber({ x, y }, (x * x + 3 * y) % 4);
      }
    }
    this->Strided.Samplings = tiles;
    std::vector<RaySampling> same = samplings;
    for (RaySampling& sampling : same)
    {
      sampling.PixelStride = 1;
    }
    auto all = std::make_shared<TileSamplings>(this->Scene.Camera.ImageSize(), same);
    for (int y = 0; y < tiles->Tiles().y; ++y)
    {
      for (int x = 0; x < tiles->Tiles().x; ++x)
      {
        all->SetNumber({ x, y }, tiles->NumberAt({ x, y }));
      }
    }
    this->Scene.Samplings = all;
  }

  FloatImage Draw(const RayScene& scene, int brickCells = 16, int threads = 1)
  {
    return scenes::Draw(scene, scenes::ArrayOf(this->Values, this->N), { brickCells, threads })
      .Image;
  }

  int StrideAt(int x, int y) const
  {
    const TileSamplings& tiles = *this->Strided.Samplings;
    const int number = tiles.NumberAt(glm::ivec2(x, y) / TileSamplings::Edge);
    return tiles.Samplings()[static_cast<std::size_t>(number)].PixelStride;
  }
  bool HasRay(int x, int y) const
  {
    const int stride = this->StrideAt(x, y);
    return x % stride == 0 && y % stride == 0;
  }

  /// By its definition: a pixel without a ray lies between the corners of its cell, whatever they
  /// are.
  glm::vec4 ValueAt(const FloatImage& rays, int x, int y) const
  {
    if (x < rays.Rect.Lo.x || y < rays.Rect.Lo.y || x >= rays.Rect.Hi.x || y >= rays.Rect.Hi.y)
    {
      return glm::vec4(0.0f);
    }
    if (this->HasRay(x, y))
    {
      return rays.At(x, y);
    }
    const int stride = this->StrideAt(x, y);
    const int left = x / stride * stride;
    const int below = y / stride * stride;
    const float right = static_cast<float>(x - left) / static_cast<float>(stride);
    const float up = static_cast<float>(y - below) / static_cast<float>(stride);
    glm::vec4 sum(0.0f);
    for (int corner = 0; corner < 4; ++corner)
    {
      const int i = corner % 2;
      const int j = corner / 2;
      const float weight = (i ? right : 1.0f - right) * (j ? up : 1.0f - up);
      if (weight > 0.0f)
      {
        sum += weight * this->ValueAt(rays, left + i * stride, below + j * stride);
      }
    }
    return sum;
  }

  glm::ivec3 N{ 41, 38, 47 };
  std::vector<float> Values = scenes::Sampled<float>(scenes::Standard, this->N);
  RayScene Scene = scenes::Scene(this->N, { 190, 170 });
  RayScene Strided = this->Scene;
};

TEST_F(SkippedPixels, RaysAreThoseOfWholePictures)
{
  const FloatImage all = this->Draw(this->Scene);
  ASSERT_GT(all.Rect.Count(), 10000);
  // Bricks of 200 cells are drawn one ray after the other.
  for (const int brickCells : { 8, 16, 200 })
  {
    for (const int threads : { 1, 3 })
    {
      const FloatImage some = this->Draw(this->Strided, brickCells, threads);
      ASSERT_EQ(some.Rect, all.Rect);
      for (int y = all.Rect.Lo.y; y < all.Rect.Hi.y; ++y)
      {
        for (int x = all.Rect.Lo.x; x < all.Rect.Hi.x; ++x)
        {
          const glm::vec4 expected = this->HasRay(x, y) ? all.At(x, y) : glm::vec4(0.0f);
          ASSERT_EQ(some.At(x, y), expected) << x << ", " << y;
        }
      }
    }
  }
}

TEST_F(SkippedPixels, GeometryEndsTheirRaysToo)
{
  for (RayScene* scene : { &this->Scene, &this->Strided })
  {
    scene->Depth.clear();
    for (int i = 0; i < 190 * 170; ++i)
    {
      scene->Depth.push_back(i % 7 < 3 ? 0.9f : 1.0f);
    }
  }
  const FloatImage all = this->Draw(this->Scene);
  const FloatImage some = this->Draw(this->Strided);
  for (int y = all.Rect.Lo.y; y < all.Rect.Hi.y; ++y)
  {
    for (int x = all.Rect.Lo.x; x < all.Rect.Hi.x; ++x)
    {
      if (this->HasRay(x, y))
      {
        ASSERT_EQ(some.At(x, y), all.At(x, y)) << x << ", " << y;
      }
    }
  }
}

TEST_F(SkippedPixels, AreFilledByDefinition)
{
  const FloatImage rays = this->Draw(this->Strided);
  FloatImage filled = rays;
  ThreadPool one(1);
  InterpolateSkippedPixels(this->Strided, filled, one);
  int seen = 0;
  for (int y = rays.Rect.Lo.y; y < rays.Rect.Hi.y; ++y)
  {
    for (int x = rays.Rect.Lo.x; x < rays.Rect.Hi.x; ++x)
    {
      const glm::vec4 expected = this->ValueAt(rays, x, y);
      for (int c = 0; c < 4; ++c)
      {
        ASSERT_NEAR(filled.At(x, y)[c], expected[c], 1e-6) << x << ", " << y;
      }
      seen += !this->HasRay(x, y) && expected.a > 0.1f ? 1 : 0;
    }
  }
  EXPECT_GT(seen, 3000);
  FloatImage again = rays;
  ThreadPool three(3);
  InterpolateSkippedPixels(this->Strided, again, three);
  EXPECT_EQ(again.Pixels, filled.Pixels);
}

TEST_F(SkippedPixels, WholePicturesAreLeftAlone)
{
  const FloatImage all = this->Draw(this->Scene);
  FloatImage filled = all;
  ThreadPool pool(2);
  InterpolateSkippedPixels(this->Scene, filled, pool);
  EXPECT_EQ(filled.Pixels, all.Pixels);
  FloatImage empty;
  InterpolateSkippedPixels(this->Strided, empty, pool);
  EXPECT_TRUE(empty.Pixels.empty());
}

} // namespace
