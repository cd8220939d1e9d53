// SPDX-License-Identifier: BSD-3-Clause
// Pictures of coarser levels of octree meshes, and which levels plans choose.
#include "Mesh/Octree/LevelMeshes.h"
#include "Mesh/Octree/PicturesOfRanks.h"

#include "Parallel/Frame/DistributedFrame.h"
#include "Parallel/Frame/DistributedPlan.h"
#include "Render/Analytic.h"
#include "Render/Sampling/ElementsPerPixel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace
{

using namespace levels;
using analytic::OneLevel;

/// Every second tile at a level, every second one at another.
std::shared_ptr<TileSamplings> Mixed(const RayScene& scene, int first, int second)
{
  auto samplings = std::make_shared<TileSamplings>(scene.Camera.ImageSize(),
    std::vector<RaySampling>{ { first, scene.SampleDistance }, { second, scene.SampleDistance } });
  ForPoints({ samplings->Tiles(), 1 },
    [&](const glm::ivec3& tile) { samplings->SetNumber(tile, (tile.x + tile.y) % 2); });
  return samplings;
}

FloatImage DrawOnRanks(const Made& made, const RayScene& scene, int ranks)
{
  return meshes::DrawOnRanks(made, scene, { 13, 7, 7 }, ranks);
}

TEST(HexLevelPictures, LinearFieldsLookTheSameAtAllLevels)
{
  const auto linear = [](const glm::dvec3& p) { return 0.1 + 0.3 * p.x + 0.25 * p.y + 0.3 * p.z; };
  for (const auto& cubes : { Graded(), Rough() })
  {
    const Made made(cubes, linear);
    RayScene scene = made.Scene(0.5);
    const FloatImage expected = DrawOnRanks(made, scene, 1);
    EXPECT_GT(expected.At(45, 35).a, 0.2);
    scene.Samplings = Mixed(scene, 2, 5);
    EXPECT_LE(MaxDifference(DrawOnRanks(made, scene, 1), expected), OneLevel);
  }
}

TEST(HexLevelPictures, LevelsAreDrawnAsTheyAreAndByRanksAsByOne)
{
  const glm::ivec3 n = Size + 1;
  for (const auto& cubes : { Graded(), Rough() })
  {
    const Made made(cubes, scenes::Standard);
    for (const double distance : { 1.4, 0.1 })
    {
      ThreadPool pool(1);
      HexBrickSource source = made.Source(pool);
      RayScene scene = made.Scene(0.7, distance);
      // The level's own field on the finest lattice, where it is trilinear too.
      const NodalField& field = At(source, 3, scene.DomainCells).Field();
      std::vector<float> values;
      for (int i = 0; i < n.x * n.y * n.z; ++i)
      {
        values.push_back(
          static_cast<float>(field.AtPoint(glm::ivec3(i % n.x, i / n.x % n.y, i / n.x / n.y))));
      }
      const FloatImage expected = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
      scene.Samplings = Mixed(scene, 3, 3);
      const FloatImage alone = DrawOnRanks(made, scene, 1);
      EXPECT_LE(MaxDifference(alone, expected), OneLevel);
      scene.Samplings = Mixed(scene, 0, 3);
      const FloatImage mixed = DrawOnRanks(made, scene, 1);
      EXPECT_GT(MaxDifference(mixed, alone), OneLevel);
      for (const int ranks : { 2, 3 })
      {
        EXPECT_LT(MaxDifference(DrawOnRanks(made, scene, ranks), mixed), 1e-5) << ranks;
      }
    }
  }
}

TEST(HexLevelPictures, PlansKeepTheToleranceWithCoarserLevels)
{
  const auto smooth = [](const glm::dvec3& p) { return std::exp(-0.5 * glm::dot(p, p)); };
  const Made made(meshes::Leaves({ 64, 32, 32 }, 0, [](const Cube&) { return false; }), smooth);
  ThreadPool pool(1);
  HexBrickSource source = made.Source(pool);
  RayScene scene = made.Scene(1.0);
  const std::vector<Box> zones{ scene.DomainCells };
  const auto alone = MakeSelfCommunicator();
  FrameStatistics statistics;
  const FloatImage exact = [&]
  {
    RayScene close = scene;
    close.SampleDistance = 0.125;
    return DrawOnRanks(made, close, 1);
  }();
  for (const double most : { 0.0, 1e6 })
  {
    SamplingWish wish{ 8.0, scene.SampleDistance, 3 };
    wish.LeastCells = 8;
    wish.LargestPixelStride = 1;
    wish.FinestLevel = FinestLevelFor(scene, most > 0.0 ? 1.0 / most : 0.0, wish.CoarsestLevel);
    EXPECT_EQ(wish.FinestLevel, most > 0.0 ? 3 : 0);
    const SamplingPlan plan = PlanDistributed(
      *alone, scene, { &source, zones, std::uint64_t{ 1 } << 28, pool }, wish, statistics);
    ASSERT_TRUE(plan.Samplings);
    EXPECT_GT(*plan.Samplings->UsedLevels().rbegin(), 0);
    RayScene planned = scene;
    planned.Samplings = plan.Samplings;
    planned.OpacityLimit = plan.OpacityLimit;
    const double error = 255.0 * MaxDifference(DrawOnRanks(made, planned, 1), exact);
    EXPECT_LE(error, plan.EstimatedError);
    if (most == 0.0)
    {
      EXPECT_LE(error, 8.0);
    }
    else
    {
      EXPECT_GE(*plan.Samplings->UsedLevels().begin(), 2); // two levels, for the error
    }
  }
}

TEST(HexLevelPictures, FarPartsAreCoarserAndRanksDrawThePictureOfOne)
{
  const Made made(
    meshes::Leaves({ 64, 32, 32 }, 0, [](const Cube&) { return false; }), scenes::Standard);
  RayScene scene = made.Scene(1.0);
  const glm::ivec2 picture(160, 128);
  const glm::dvec3 eye(1.0, 16.0, 34.0);
  const glm::dmat4 view = glm::lookAt(eye, eye + glm::dvec3(1.0, 0.0, -0.3), glm::dvec3(0, 0, 1));
  const glm::dmat4 projection = glm::perspective(std::acos(-1.0) / 2.5, 1.25, 0.01, 200.0);
  scene.Camera = RayCamera(projection * view, picture, eye);
  scene.Viewport = { glm::ivec2(0), picture };
  SamplingWish wish{ 1.0, scene.SampleDistance, 3 };
  wish.LeastCells = 8;
  wish.LargestPixelStride = 1;
  wish.FinestLevelOfTile = FinestLevelsOfTiles(scene, 0.01, wish.CoarsestLevel);
  FloatImage alone;
  for (const int ranks : { 1, 2, 3 })
  {
    FloatImage image;
    RunOnSimulatedRanks(ranks,
      [&](Communicator& communicator)
      {
        ThreadPool pool(1);
        HexBrickSource source = made.Source(pool);
        std::vector<Box> zones;
        for (const Box& part : StaticZones({ 13, 7, 7 }, communicator.Size()))
        {
          zones.push_back(CellsOfBricks(part, 5, scene.DomainCells.Hi));
        }
        FrameStatistics statistics;
        const SamplingPlan plan = PlanDistributed(communicator, scene,
          { &source, zones, std::uint64_t{ 1 } << 28, pool }, wish, statistics);
        ASSERT_TRUE(plan.Samplings);
        for (std::size_t i = 0; i < wish.FinestLevelOfTile.size(); ++i)
        {
          const int tile = static_cast<int>(i);
          const int tilesAcross = plan.Samplings->Tiles().x;
          const int number = plan.Samplings->NumberAt({ tile % tilesAcross, tile / tilesAcross });
          EXPECT_GE(plan.Samplings->Samplings()[static_cast<std::size_t>(number)].Level,
            std::min(wish.FinestLevelOfTile[i], 2));
        }
        const std::set<int> used = plan.Samplings->UsedLevels();
        EXPECT_EQ(*used.begin(), 0);
        EXPECT_GE(*used.rbegin(), 2);
        RayScene planned = scene;
        planned.Samplings = plan.Samplings;
        planned.OpacityLimit = plan.OpacityLimit;
        const FloatImage drawn = DrawDistributed(
          communicator, planned, { &source, zones, std::uint64_t{ 1 } << 28, pool }, statistics);
        if (communicator.Rank() == 0)
        {
          image = drawn;
        }
      });
    if (ranks == 1)
    {
      alone = image;
      EXPECT_GT(alone.At(80, 40).a, 0.1);
    }
    EXPECT_LE(MaxDifference(image, alone), OneLevel) << ranks;
  }
}

TEST(HexLevelPictures, ElementsPerPixelAreCountedWhereTheMeshIsNearest)
{
  const Made made(Rough(), scenes::Standard);
  RayScene scene = made.Scene(1.0);
  // 64 x 64 pixels over 32 x 32 edges: four pixels per element; 16 x 16 elements in each of 2 x 2.
  const auto with = [&](int pixels)
  {
    const glm::dmat4 toClip = glm::ortho(0.0, 32.0, 0.0, 32.0, -100.0, 100.0);
    scene.Camera = RayCamera(toClip, glm::ivec2(pixels), glm::dvec3(0.0));
    return scene;
  };
  EXPECT_EQ(FinestLevelFor(with(64), 1.0, 5), 0);
  EXPECT_EQ(FinestLevelFor(with(2), 256.0, 5), 0);
  EXPECT_EQ(FinestLevelFor(with(2), 255.0, 5), 1);
  EXPECT_EQ(FinestLevelFor(with(2), 64.0, 5), 1);
  EXPECT_EQ(FinestLevelFor(with(2), 1.0, 5), 4);
  EXPECT_EQ(FinestLevelFor(with(2), 1.0, 3), 3);
  EXPECT_EQ(FinestLevelFor(with(2), 0.0, 5), 0);
  // An eye inside: the nearest element fills the picture.
  EXPECT_EQ(FinestLevelFor(made.Scene(1.0, 0.1), 1.0, 5), 0);
}

} // namespace
