// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/Zones.h"
#include "Parallel/Composite/CompositePlan.h"
#include "Parallel/Composite/Footprints.h"
#include "Render/Levels/RayCaster.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

/// Whether a ray meets a box between the clipping planes, by the slabs of its axes.
bool Meets(const Ray& ray, const glm::dvec3& low, const glm::dvec3& high)
{
  double first = ray.Near;
  double last = ray.Far;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double a = (low[axis] - ray.Origin[axis]) / ray.Direction[axis];
    const double b = (high[axis] - ray.Origin[axis]) / ray.Direction[axis];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first < last;
}

TEST(Footprints, HoldEveryRayThatMeetsTheirBox)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  const glm::ivec2 size(67, 49);
  const PixelRect viewport{ { 3, 2 }, { 60, 47 } };
  long long met = 0;
  long long covered = 0;
  for (int trial = 0; trial < 120; ++trial)
  {
    // Outside, close by and inside of the volume.
    const double distance = trial % 3 == 0 ? 0.1 : (trial % 3 == 1 ? 0.7 : 2.0);
    const RayScene scene =
      scenes::Scene({ 33, 33, 33 }, size, glm::dmat4(1.0), distance, trial % 2 == 1);
    const RayCamera camera = scene.Camera.InSpace(scene.IndexToWorld);
    const glm::dvec3 low(32 * unit(random), 32 * unit(random), 32 * unit(random));
    const glm::dvec3 high = low + glm::dvec3(9 * unit(random), 9 * unit(random), 9 * unit(random));
    const Footprint footprint = FootprintOf(camera, low, high, viewport);
    for (int y = viewport.Lo.y; y < viewport.Hi.y; ++y)
    {
      const Footprint::Interval row = footprint.Row(y);
      covered += std::max(0, row.Hi - row.Lo);
      EXPECT_TRUE(row.Lo >= row.Hi || (row.Lo >= viewport.Lo.x && row.Hi <= viewport.Hi.x));
      for (int x = viewport.Lo.x; x < viewport.Hi.x; ++x)
      {
        if (Meets(camera.RayOf(x, y), low, high))
        {
          ++met;
          EXPECT_TRUE(row.Lo <= x && x < row.Hi) << trial << ": " << x << ", " << y;
        }
      }
    }
  }
  EXPECT_GT(met, 3000);
  // Hulls, not rectangles: hardly larger than what is met, but for boxes around the eye.
  EXPECT_LT(covered, met + met / 4);
}

TEST(Footprints, OfNothingAreEmpty)
{
  const RayScene scene = scenes::Scene({ 9, 9, 9 }, { 20, 20 }, glm::dmat4(1.0), 1.5, false);
  const auto footprints = FootprintsOfZones(scene.Camera, scene.IndexToWorld,
    { Box{}, Box{ glm::ivec3(0), glm::ivec3(8) } }, scene.Viewport);
  EXPECT_TRUE(footprints[0].Empty());
  EXPECT_FALSE(footprints[1].Empty());
}

/// What the ranks of a plan send each other covers every pixel that anybody may draw, once.
TEST(CompositePlans, SendEveryPixelToOnePlace)
{
  const RayScene scene = scenes::Scene({ 65, 65, 65 }, { 150, 133 }, glm::dmat4(1.0), 1.2, false);
  for (const int ranks : { 1, 2, 3, 5, 8, 16, 64 })
  {
    std::vector<Box> zones;
    for (const Box& bricks : StaticZones({ 8, 8, 8 }, ranks))
    {
      zones.push_back(CellsOfBricks(bricks, 8, { 64, 64, 64 }));
    }
    const auto footprints =
      FootprintsOfZones(scene.Camera, scene.IndexToWorld, zones, scene.Viewport);
    const PixelRect behind{ { 70, 60 }, { 90, 80 } };
    const CompositePlan plan = PlanCompositing(footprints, scene.Viewport, behind, true);
    std::vector<long long> incoming(static_cast<std::size_t>(ranks), 0);
    for (int rank = 0; rank < ranks; ++rank)
    {
      std::vector<int> sent(static_cast<std::size_t>(scene.Viewport.Count()), 0);
      CompositePlan::Region region;
      const auto count = [&](int tile, bool shared)
      {
        for (const CompositePlan::Run& run : region)
        {
          for (int x = run.Lo; x < run.Hi; ++x)
          {
            ++sent[static_cast<std::size_t>(run.Y) * scene.Viewport.Size().x + x];
          }
          if (shared && plan.Tiles[tile].Owner != rank)
          {
            incoming[plan.Tiles[tile].Owner] += run.Hi - run.Lo;
          }
        }
      };
      for (int tile = 0; tile < static_cast<int>(plan.Tiles.size()); ++tile)
      {
        for (int kind = 0; kind < CompositePlan::Kinds; ++kind)
        {
          plan.DirectRegion(rank, tile, static_cast<CompositePlan::Kind>(kind), region);
          count(tile, false);
          plan.SharedRegion(rank, tile, static_cast<CompositePlan::Kind>(kind), region);
          count(tile, true);
        }
      }
      for (int y = 0; y < scene.Viewport.Size().y; ++y)
      {
        const Footprint::Interval row = footprints[rank].Row(y);
        for (int x = 0; x < scene.Viewport.Size().x; ++x)
        {
          const int times = sent[static_cast<std::size_t>(y) * scene.Viewport.Size().x + x];
          const bool draws = rank > 0 && row.Lo <= x && x < row.Hi;
          EXPECT_TRUE(draws ? times == 1 : times <= 1) << rank << ": " << x << ", " << y;
        }
      }
    }
    // The root owns nothing, and no owner carries much more than the others.
    EXPECT_EQ(incoming[0], 0);
    if (ranks == 16)
    {
      long long all = 0;
      for (const long long pixels : incoming)
      {
        all += pixels;
      }
      EXPECT_LT(*std::max_element(incoming.begin(), incoming.end()), 2 * all / (ranks - 1));
    }
  }
}

TEST(CompositePlans, PackWherePackingPays)
{
  CompositeCosts costs;
  EXPECT_TRUE(PackingPays(costs)); // 10 Gb/s
  costs.BytesPerSecond = 12.5e9;   // 100 Gb/s, one thread
  EXPECT_FALSE(PackingPays(costs));
}

} // namespace
