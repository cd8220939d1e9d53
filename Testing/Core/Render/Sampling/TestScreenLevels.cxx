// SPDX-License-Identifier: BSD-3-Clause
// Levels by what cells measure on the screen: against the nearest point of each ray, one by one.

#include "Render/Sampling/ScreenLevels.h"

#include "Render/Raycast/TileDepths.h"
#include "Render/Sampling/ElementsPerPixel.h"

#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <set>

namespace
{

using namespace banyan;

constexpr int Coarsest = 5;

/// Where a ray enters a box, as w of clip space; infinite where it does not.
double DepthOfEntry(const RayScene& scene, int x, int y)
{
  const Ray ray = scene.Camera.RayOf(x, y);
  const glm::dmat4 toIndex = glm::inverse(scene.IndexToWorld);
  const glm::dvec3 origin = toIndex * glm::dvec4(ray.Origin, 1.0);
  const glm::dvec3 direction = toIndex * glm::dvec4(ray.Direction, 0.0);
  double from = ray.Near;
  double to = ray.Far;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double a = (scene.DomainCells.Lo[axis] - origin[axis]) / direction[axis];
    const double b = (scene.DomainCells.Hi[axis] - origin[axis]) / direction[axis];
    from = std::max(from, std::min(a, b));
    to = std::min(to, std::max(a, b));
  }
  if (from >= to)
  {
    return std::numeric_limits<double>::infinity();
  }
  const glm::dvec4 point(ray.Origin + from * ray.Direction, 1.0);
  return (glm::inverse(scene.Camera.ClipToWorldMatrix()) * point).w;
}

/// Pixels that the longest edge of a finest cell covers at a depth, in the direction that shows
/// most of it.
double PixelsOfCell(const RayScene& scene, double depth)
{
  double edge = 0.0;
  for (int axis = 0; axis < 3; ++axis)
  {
    edge = std::max(edge, glm::length(glm::dvec3(scene.IndexToWorld[axis])));
  }
  const glm::dmat4 toClip = glm::inverse(scene.Camera.ClipToWorldMatrix());
  double most = 0.0;
  for (int row = 0; row < 2; ++row)
  {
    const glm::dvec3 gradient(toClip[0][row], toClip[1][row], toClip[2][row]);
    const double pixels = 0.5 * scene.Camera.ImageSize()[row] * glm::length(gradient) / depth;
    most = std::max(most, pixels * edge);
  }
  return most;
}

TEST(ScreenLevels, CellsAreNoLongerThanAllowedWhereRaysEnter)
{
  const glm::ivec3 n{ 129, 97, 257 };
  std::set<int> used;
  for (const double distance : { 0.7, 1.4, 3.0 })
  {
    for (const bool parallel : { false, true })
    {
      const glm::dmat4 stretched = glm::rotate(
        glm::scale(glm::dmat4(1.0), glm::dvec3(1.0, 0.5, 0.7)), 0.4, glm::dvec3(0.3, 1.0, 0.2));
      const RayScene scene = scenes::Scene(n, { 230, 170 }, stretched, distance, parallel);
      for (const double pixels : { 0.7, 3.0, 20.0 })
      {
        const TileSamplings samplings = SamplingsByScreen(scene, pixels, 0.5, Coarsest, true);
        const glm::ivec2 tiles = samplings.Tiles();
        int looked = 0;
        for (int y = 0; y < tiles.y; ++y)
        {
          for (int x = 0; x < tiles.x; ++x)
          {
            double nearest = std::numeric_limits<double>::infinity();
            for (int j = 32 * y; j < std::min(32 * y + 32, 170); ++j)
            {
              for (int i = 32 * x; i < std::min(32 * x + 32, 230); ++i)
              {
                nearest = std::min(nearest, DepthOfEntry(scene, i, j));
              }
            }
            const RaySampling& sampling =
              samplings.Samplings()[static_cast<std::size_t>(samplings.NumberAt({ x, y }))];
            EXPECT_EQ(sampling.Distance, std::ldexp(0.5, sampling.Level));
            EXPECT_EQ(sampling.PixelStride, 1);
            if (!std::isfinite(nearest))
            {
              continue;
            }
            ++looked;
            used.insert(sampling.Level);
            const double longest = std::ldexp(PixelsOfCell(scene, nearest), sampling.Level);
            EXPECT_TRUE(sampling.Level == 0 || longest <= 1.001 * pixels)
              << longest << " of " << pixels;
            // Blocks are a sixteenth of the domain, so the depth is nearly that of rays.
            EXPECT_TRUE(sampling.Level == Coarsest || 2.0 * longest > 0.7 * pixels)
              << longest << " of " << pixels;
          }
        }
        EXPECT_GT(looked, 4);
      }
    }
  }
  EXPECT_GE(used.size(), 4u);
}

/// A slab of ground, seen from just above it along it: the plane of the eye goes through blocks.
RayScene OverTheGround()
{
  RayScene scene = scenes::Scene({ 257, 129, 33 }, { 320, 256 });
  const glm::dvec3 eye(3.0, 64.0, 36.0);
  const glm::dmat4 view = glm::lookAt(eye, eye + glm::dvec3(1.0, 0.05, -0.05), glm::dvec3(0, 0, 1));
  const glm::dmat4 projection = glm::perspective(std::acos(-1.0) / 3.0, 1.25, 0.01, 1000.0);
  scene.Camera = RayCamera(projection * view, { 320, 256 }, eye);
  return scene;
}

TEST(ScreenLevels, DepthsAreThoseOfRaysNearToFar)
{
  const RayScene scene = OverTheGround();
  const TileDepths depths(scene);
  double least = std::numeric_limits<double>::infinity();
  double most = 0.0;
  for (int y = 0; y < depths.Tiles().y; ++y)
  {
    for (int x = 0; x < depths.Tiles().x; ++x)
    {
      double nearest = std::numeric_limits<double>::infinity();
      for (int i = 0; i < 32 * 32; ++i)
      {
        nearest = std::min(nearest, DepthOfEntry(scene, 32 * x + i % 32, 32 * y + i / 32));
      }
      const double depth = depths.At({ x, y });
      EXPECT_LE(depth, 1.0001 * nearest);
      if (std::isfinite(nearest))
      {
        // A block is 16 long, 8 wide, and covers tiles that it only touches.
        EXPECT_GE(depth, nearest - 24.0) << x << ", " << y;
        EXPECT_GT(depth, 1.0);
        least = std::min(least, depth);
        most = std::max(most, depth);
      }
    }
  }
  EXPECT_LT(least, 8.0);
  EXPECT_GT(most, 60.0);
}

TEST(ScreenLevels, ElementsPerPixelAreCountedUnderEachTile)
{
  const RayScene scene = OverTheGround();
  const TileDepths depths(scene);
  const glm::dvec2 sides = PixelSides(scene.Camera);
  const double most = 0.002;
  const std::vector<int> levels = FinestLevelsOfTiles(scene, most, Coarsest);
  for (std::size_t i = 0; i < levels.size(); ++i)
  {
    const int tile = static_cast<int>(i);
    const double depth = depths.At({ tile % depths.Tiles().x, tile / depths.Tiles().x });
    const double elements = depth * sides.x * depth * sides.y / std::ldexp(1.0, 2 * levels[i]);
    EXPECT_TRUE(levels[i] == Coarsest || elements <= most);
    EXPECT_TRUE(levels[i] == 0 || 4.0 * elements > most);
    EXPECT_GE(levels[i], FinestLevelFor(scene, most, Coarsest));
  }
  EXPECT_GE(std::set<int>(levels.begin(), levels.end()).size(), 4u);
  const std::vector<int> any = FinestLevelsOfTiles(scene, 0.0, Coarsest);
  EXPECT_EQ(std::set<int>(any.begin(), any.end()), std::set<int>{ 0 });
}

TEST(ScreenLevels, AnEyeInsideSeesTheFinestLevel)
{
  const RayScene scene = scenes::Scene({ 65, 65, 65 }, { 100, 100 }, glm::dmat4(1.0), 0.05);
  const TileSamplings samplings = SamplingsByScreen(scene, 50.0, 1.0, Coarsest, true);
  EXPECT_EQ(samplings.UsedLevels(), std::set<int>{ 0 });
}

TEST(ScreenLevels, AFixedDistanceIsThatOfAllLevels)
{
  const RayScene scene = scenes::Scene({ 65, 65, 65 }, { 100, 100 });
  const TileSamplings samplings = SamplingsByScreen(scene, 50.0, 0.25, Coarsest, false);
  for (const RaySampling& sampling : samplings.Samplings())
  {
    EXPECT_EQ(sampling.Distance, 0.25);
  }
  EXPECT_EQ(samplings.Samplings().size(), Coarsest + 1u);
  EXPECT_GT(*samplings.UsedLevels().rbegin(), 2);
}

} // namespace
