// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/LevelZones.h"
#include "Parallel/Balance/Zones.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

const glm::ivec3 Samples{ 101, 65, 33 };
constexpr int CoarsestLevel = 3;

/// Two zones that meet at a plane across x.
std::vector<Box> Halves(int plane)
{
  const glm::ivec3 cells = Samples - 1;
  return { { glm::ivec3(0), { plane, cells.y, cells.z } }, { { plane, 0, 0 }, cells } };
}

/// Seen from straight before a place on the x axis.
RayScene SeenFrom(double x)
{
  RayScene scene = scenes::Scene(Samples, { 64, 64 }, glm::dmat4(1.0), 1.4, false);
  const glm::dvec3 eye(x, 32.0, 200.0);
  const glm::dmat4 view = glm::lookAt(eye, glm::dvec3(x, 32.0, 0.0), glm::dvec3(0.0, 1.0, 0.0));
  const glm::dmat4 projection = glm::perspective(0.8, 1.0, 10.0, 400.0);
  scene.Camera = RayCamera(projection * view, { 64, 64 }, eye);
  return scene;
}

TEST(LevelZones, AreOfCellsThatBeginInTheZone)
{
  const Box domain{ glm::ivec3(0), Samples - 1 };
  const Box zone{ { 3, 8, 0 }, { 50, 64, 32 } };
  EXPECT_EQ(ZoneAtLevel(zone, glm::ivec3(1), domain), zone);
  EXPECT_EQ(ZoneAtLevel(zone, glm::ivec3(4), domain), (Box{ { 4, 8, 0 }, { 52, 64, 32 } }));
  EXPECT_EQ(ZoneAtLevel({ { 97, 0, 0 }, { 100, 64, 32 } }, glm::ivec3(8), domain), Box{});
  EXPECT_EQ(ZoneAtLevel({ { 90, 0, 0 }, { 100, 64, 32 } }, glm::ivec3(8), domain),
    (Box{ { 96, 0, 0 }, { 100, 64, 32 } }));
  EXPECT_EQ(ZoneAtLevel(Box{}, glm::ivec3(2), domain), Box{});
}

TEST(LevelZones, CoverTheGridOnceAtEveryLevel)
{
  const Box domain{ glm::ivec3(0), Samples - 1 };
  for (const int plane : { 1, 7, 48, 53, 99 })
  {
    for (int level = 0; level <= CoarsestLevel; ++level)
    {
      std::int64_t cells = 0;
      for (const Box& zone : Halves(plane))
      {
        cells += ZoneAtLevel(zone, glm::ivec3(1 << level), domain).Count();
      }
      EXPECT_EQ(cells, domain.Count()) << plane << ", level " << level;
    }
  }
}

TEST(LevelZones, HaveAnotherOrderWhereTheEyeIsBesideTheirBorder)
{
  // Cells of 8 that begin before 50 end at 56.
  for (const double x : { 10.0, 49.0, 57.0, 90.0 })
  {
    EXPECT_TRUE(LevelsHaveOneOrder(SeenFrom(x), Halves(50), CoarsestLevel)) << x;
  }
  EXPECT_FALSE(LevelsHaveOneOrder(SeenFrom(53.0), Halves(50), CoarsestLevel));
  EXPECT_TRUE(LevelsHaveOneOrder(SeenFrom(53.0), Halves(50), 1)) << "level 1 ends at 50";
  EXPECT_TRUE(LevelsHaveOneOrder(SeenFrom(53.0), Halves(48), CoarsestLevel));
}

TEST(LevelZones, AreOrderedAtTheLevelThatIsDrawn)
{
  RayScene scene = SeenFrom(53.0);
  EXPECT_EQ(OrderAsDrawn(scene, Halves(50)), (std::vector<int>{ 1, 0 }));
  scene.Samplings = std::make_shared<const TileSamplings>(
    scene.Camera.ImageSize(), std::vector{ RaySampling{ 3, 1.0 } });
  EXPECT_EQ(OrderAsDrawn(scene, Halves(50)), (std::vector<int>{ 0, 1 }));
  EXPECT_EQ(ZonesAsDrawn(scene, Halves(50))[0].Hi.x, 56);
}

} // namespace
