// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/BrickPrefetcher.h"

#include "Render/Bricks/PackedBrick.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <vector>

namespace
{

using namespace banyan;

/// A brick of 32^3 cells at some place, of floats, of numbers or with gradients.
PackedBrick BrickAt(const glm::ivec3& low, int kind)
{
  const glm::ivec3 n(33);
  std::vector<float> values(33 * 33 * 33);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = static_cast<float>(i % 200);
  }
  const BrickView view{ values.data(), ScalarType::Float32, { 1, 33, 33 * 33 }, nullptr };
  const Box cells{ low, low + 32 };
  return kind == 2 ? PackedBrick(view, Box{ low, low + n }, cells, 0.0, 1.0f)
                   : PackedBrick(view, low, cells, 0.0, kind == 1 ? 1.0 : 0.0);
}

/// Samples of a brick that were asked for, and how often.
std::vector<int> Asked(BrickPrefetcher ahead)
{
  std::vector<int> times(33 * 33 * 33, 0);
  for (Box some = ahead.NextSlice(); !some.Empty(); some = ahead.NextSlice())
  {
    EXPECT_TRUE((Box{ glm::ivec3(0), glm::ivec3(33) }.Contains(some)));
    for (int z = some.Lo.z; z < some.Hi.z; ++z)
    {
      for (int y = some.Lo.y; y < some.Hi.y; ++y)
      {
        for (int x = some.Lo.x; x < some.Hi.x; ++x)
        {
          ++times[static_cast<std::size_t>((z * 33 + y) * 33 + x)];
        }
      }
    }
  }
  return times;
}

CornerRays CornersOf(const RayCamera& camera, const PixelRect& rect)
{
  return { camera.RayOf(rect.Lo.x, rect.Lo.y), camera.RayOf(rect.Hi.x - 1, rect.Lo.y),
    camera.RayOf(rect.Lo.x, rect.Hi.y - 1), camera.RayOf(rect.Hi.x - 1, rect.Hi.y - 1) };
}

/// Marks the samples around what a ray meets of a brick.
void Mark(const Ray& ray, const glm::ivec3& low, std::vector<int>& met)
{
  for (double t = 0.0; t < 400.0; t += 0.25)
  {
    const glm::ivec3 cell = glm::ivec3(glm::floor(ray.Origin + t * ray.Direction)) - low;
    for (int i = 0; i < 8 && Box{ glm::ivec3(0), glm::ivec3(32) }.Contains(Box{ cell, cell + 1 });
         ++i)
    {
      const glm::ivec3 p = cell + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
      met[static_cast<std::size_t>((p.z * 33 + p.y) * 33 + p.x)] = 1;
    }
  }
}

TEST(BrickPrefetcher, AsksForWhatRaysOfATileMeetAndForLittleElse)
{
  const glm::ivec3 low(64, 32, 32);
  // Along z, along x, along y, and from inside of the brick.
  const glm::dvec3 eyes[4] = { { 160.0, 120.0, 330.0 }, { 380.0, 120.0, 150.0 },
    { 120.0, 380.0, 150.0 }, { 80.0, 50.0, 50.0 } };
  for (int kind = 0; kind < 3; ++kind)
  {
    const PackedBrick brick = BrickAt(low, kind);
    for (const glm::dvec3& eye : eyes)
    {
      const glm::dmat4 view =
        glm::lookAt(eye, glm::dvec3(75.0, 45.0, 44.0), glm::dvec3(0.1, 0.8, 0.6));
      const RayCamera camera(
        glm::perspective(0.6, 1.0, 0.5, 1000.0) * view, { 256, 256 }, glm::dvec3(0.0));
      const PixelRect tile{ { 124, 122 }, { 136, 134 } };
      const BrickPrefetcher ahead(brick, brick.Cells(), CornersOf(camera, tile), 64);
      const std::vector<int> times = Asked(ahead);
      std::vector<int> met(times.size(), 0);
      for (int y = tile.Lo.y; y < tile.Hi.y; ++y)
      {
        for (int x = tile.Lo.x; x < tile.Hi.x; ++x)
        {
          Mark(camera.RayOf(x, y), low, met);
        }
      }
      double asked = 0;
      double needed = 0;
      double both = 0;
      for (std::size_t i = 0; i < times.size(); ++i)
      {
        EXPECT_LE(times[i], 1);
        asked += times[i];
        needed += met[i];
        both += times[i] * met[i];
      }
      EXPECT_GT(needed, 100.0);
      // Rays are looked at where they meet slices, and may be in another cell in between, above all
      // near the eye. Along x whole lines of the caches are asked for, with up to 32 samples.
      const bool alongX = &eye == &eyes[1];
      const bool inside = &eye == &eyes[3];
      EXPECT_GT(both, (inside ? 0.6 : 0.95) * needed) << kind << ", from " << eye.x;
      EXPECT_LT(asked, (alongX ? 5.0 : inside ? 2.0 : 1.3) * needed) << kind << ", from " << eye.x;
    }
  }
}

TEST(BrickPrefetcher, KeepsToThePartThatIsDrawn)
{
  const PackedBrick brick = BrickAt(glm::ivec3(0), 0);
  Ray ray{ { 10.0, 10.0, -50.0 }, { 0.0, 0.0, 1.0 }, 0.0, 1e9 };
  const CornerRays corners{ ray, ray, ray, ray };
  BrickPrefetcher ahead(brick, { { 4, 5, 6 }, { 12, 13, 14 } }, corners, 3);
  Box all;
  for (Box some = ahead.NextSlice(); !some.Empty(); some = ahead.NextSlice())
  {
    all = Union(all, some);
  }
  EXPECT_EQ(all, (Box{ { 10, 10, 6 }, { 12, 12, 15 } }));
  // Beside the rays, and behind the eye: anything, but of the brick.
  ray.Origin = { 1e5, 10.0, 90.0 };
  BrickPrefetcher beside(brick, brick.Cells(), { ray, ray, ray, ray }, 3);
  for (Box some = beside.NextSlice(); !some.Empty(); some = beside.NextSlice())
  {
    EXPECT_TRUE((Box{ glm::ivec3(0), glm::ivec3(33) }.Contains(some)));
  }
  EXPECT_TRUE(BrickPrefetcher(brick, {}, corners, 3).NextSlice().Empty());
  EXPECT_TRUE(BrickPrefetcher().NextSlice().Empty());
}

TEST(BrickPrefetcher, IsDoneAfterAsManyCallsAsWereForetold)
{
  const PackedBrick brick = BrickAt(glm::ivec3(0), 2);
  for (const glm::dvec3& direction :
    { glm::dvec3(0.0, 0.0, 1.0), glm::dvec3(0.0, 1.0, 0.0), glm::dvec3(1.0, 0.0, 0.0) })
  {
    for (const std::int64_t calls : { 0, 1, 2, 7, 64 })
    {
      const Ray ray{ glm::dvec3(10.0) - 60.0 * direction, direction, 0.0, 1e9 };
      BrickPrefetcher ahead(brick, brick.Cells(), { ray, ray, ray, ray }, calls);
      for (std::int64_t i = 0; i < std::max<std::int64_t>(calls, 1); ++i)
      {
        ahead.Ask();
      }
      EXPECT_TRUE(ahead.NextSlice().Empty());
    }
  }
}

} // namespace
