// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/BrickMarcher.h"
#include "Render/Scenes.h"
#include "Targets.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

struct Tiled
{
  FloatImage Picture;
  std::int64_t Samples = 0;
  std::int64_t Ended = 0; ///< rays
};

/// Draws one brick, tile by tile, with `march(tile)`.
template <class March>
Tiled DrawTiles(const RayScene& scene, March&& march)
{
  const RayLattice lattice(scene);
  Tiled drawn;
  drawn.Picture.Rect = scene.Viewport;
  drawn.Picture.Pixels.assign(scene.Viewport.Count(), glm::vec4(0.125f, 0.0f, 0.25f, 0.75f));
  const auto tile = std::make_unique<RayTile>();
  for (int y = 0; y < scene.Viewport.Hi.y; y += RayTile::Edge)
  {
    for (int x = 0; x < scene.Viewport.Hi.x; x += RayTile::Edge)
    {
      const PixelRect rect =
        Intersection({ { x, y }, glm::ivec2(x, y) + RayTile::Edge }, scene.Viewport);
      tile->Open(lattice, rect, drawn.Picture, 1.0f - scene.OpacityLimit);
      const std::int64_t active = tile->ActiveRays;
      march(*tile);
      tile->Close(drawn.Picture);
      drawn.Samples += tile->SamplesTaken;
      drawn.Ended += active - tile->ActiveRays;
    }
  }
  return drawn;
}

struct Scenario
{
  glm::ivec3 N{ 33, 29, 31 };
  Box Cells{ { 0, 0, 0 }, { 32, 28, 30 } };
  bool Sparse = false;
  double Distance = 1.4;
  double Step = 1.0;
  float OpacityLimit = 2.0f;
  bool Parallel = false;
};

template <class T>
void ExpectPacketsGiveTheBitsOfSingleRays(const Scenario& test, std::vector<T> values)
{
  RayScene scene = scenes::Scene(test.N, { 70, 45 }, glm::dmat4(1.0), test.Distance, test.Parallel);
  scene.Transfer = scenes::Tabulate(test.Sparse ? scenes::Sparse : scenes::Smooth);
  scene.Transfer.High = std::is_integral_v<T> ? 100.0 : 1.0;
  scene.SampleDistance = test.Step;
  scene.OpacityLimit = test.OpacityLimit;
  const StepTable table(scene.Transfer, scene.SampleDistance);
  const VisibleValues visible(scene.Transfer);
  BrickView view;
  view.Values = values.data();
  view.Type = ScalarTypeOf<T>();
  view.Stride[1] = test.N.x;
  view.Stride[2] = std::ptrdiff_t{ test.N.x } * test.N.y;
  const PixelRect all = scene.Viewport;
  const Tiled plain = DrawTiles(scene,
    [&](RayTile& tile) {
      MarchBrick({ view, glm::ivec3(0), test.Cells }, table, all, tile);
    });
  EXPECT_GT(plain.Samples, 1000);

  const PackedBrick packed(view, glm::ivec3(0), test.Cells, table.Low());
  const BrickVisibility seen(packed, { 0.0, 100.0 }, visible);
  EXPECT_EQ(seen.Holes, test.Sparse);
  const Tiled unpacked = DrawTiles(
    scene, [&](RayTile& tile) { MarchUnpacked(packed, seen, table, nullptr, all, tile); });
  EXPECT_EQ(MaxDifference(unpacked.Picture, plain.Picture), 0.0);
  for (const std::int64_t target : targets::OfThisMachine())
  {
    SCOPED_TRACE(hwy::TargetName(target));
    const targets::OnlyTarget only(target);
    const Tiled drawn = DrawTiles(scene,
      [&](RayTile& tile)
      {
        ASSERT_TRUE(tile.PacketsFit);
        MarchPacked(packed, seen, table, nullptr, all, tile);
      });
    EXPECT_EQ(MaxDifference(drawn.Picture, plain.Picture), 0.0);
    EXPECT_EQ(drawn.Ended, plain.Ended);
    if (test.Sparse)
    {
      EXPECT_LE(drawn.Samples, plain.Samples);
    }
    else
    {
      EXPECT_EQ(drawn.Samples, plain.Samples);
    }
  }
}

void ExpectSameBits(const Scenario& test)
{
  ExpectPacketsGiveTheBitsOfSingleRays(test, scenes::Sampled(scenes::Standard, test.N));
}

TEST(Packets, WholeBrick)
{
  ExpectSameBits({});
}

TEST(Packets, PartOfABrick)
{
  Scenario test;
  test.Cells = { { 3, 7, 1 }, { 30, 20, 29 } };
  ExpectSameBits(test);
  test.Sparse = true;
  ExpectSameBits(test);
}

TEST(Packets, SpaceThatCannotBeSeen)
{
  Scenario test;
  test.Sparse = true;
  ExpectSameBits(test);
  test.Step = 0.3;
  ExpectSameBits(test);
}

TEST(Packets, RaysThatEnd)
{
  Scenario test;
  test.Step = 0.25;
  for (const float limit : { 0.3f, 0.5f, 0.9f })
  {
    test.OpacityLimit = limit;
    test.Sparse = false;
    ExpectSameBits(test);
    test.Sparse = true;
    ExpectSameBits(test);
  }
}

TEST(Packets, StepsOfAllSizes)
{
  Scenario test;
  for (const double step : { 0.07, 0.5, 2.9, 15.0 })
  {
    test.Step = step;
    test.Sparse = false;
    ExpectSameBits(test);
  }
}

TEST(Packets, EyeInsideAndParallel)
{
  Scenario test;
  test.Distance = 0.15;
  ExpectSameBits(test);
  test.Distance = 1.4;
  test.Parallel = true;
  ExpectSameBits(test);
}

TEST(Packets, LargeBricks)
{
  Scenario test;
  test.N = { 70, 11, 129 };
  test.Cells = { glm::ivec3(0), test.N - 1 };
  ExpectSameBits(test);
  test.Sparse = true;
  ExpectSameBits(test);
}

TEST(Packets, ValuesThatAreNotFinite)
{
  Scenario test;
  std::vector<float> values = scenes::Sampled(scenes::Standard, test.N);
  std::mt19937 random(3);
  const float special[] = { NAN, INFINITY, -INFINITY, 3e38f, -3e38f };
  for (int i = 0; i < 200; ++i)
  {
    values[random() % values.size()] = special[i % 5];
  }
  ExpectPacketsGiveTheBitsOfSingleRays(test, values);
  test.Sparse = true;
  ExpectPacketsGiveTheBitsOfSingleRays(test, values);
}

TEST(Packets, IntegersAndDoubles)
{
  const Scenario test;
  ExpectPacketsGiveTheBitsOfSingleRays(
    test, scenes::Sampled<std::uint8_t>(scenes::Standard, test.N, 100.0));
  ExpectPacketsGiveTheBitsOfSingleRays(
    test, scenes::Sampled<std::int32_t>(scenes::Standard, test.N, 100.0));
  ExpectPacketsGiveTheBitsOfSingleRays(test, scenes::Sampled<double>(scenes::Standard, test.N));
}

/// Shaded packets against shaded single rays.
void ExpectSameBitsShaded(const Scenario& test, std::vector<float> values, float specular)
{
  RayScene scene = scenes::Scene(test.N, { 70, 45 }, glm::dmat4(1.0), test.Distance, test.Parallel);
  scene.Transfer = scenes::Tabulate(test.Sparse ? scenes::Sparse : scenes::Smooth);
  scene.SampleDistance = test.Step;
  scene.OpacityLimit = test.OpacityLimit;
  scene.Shading = { true, 0.2f, 0.6f, specular, 7.5f };
  glm::dmat3 toIndex(1.0);
  toIndex[1][0] = 0.25;
  toIndex[2][2] = 0.5;
  const ShadingTable shading(scene.Shading, toIndex);
  const StepTable table(scene.Transfer, scene.SampleDistance);
  BrickView view{ values.data(), ScalarType::Float32, { 1, test.N.x, test.N.x * test.N.y }, {} };
  const PackedBrick packed(view, { glm::ivec3(0), test.N }, test.Cells, table.Low(), 4.0f);
  const BrickVisibility seen(packed, { 0.0, 100.0 }, VisibleValues(scene.Transfer));
  const auto march = [&](auto&& function)
  {
    return DrawTiles(scene,
      [&](RayTile& tile) {
        function(packed, seen, table, &shading, scene.Viewport, tile, SampleInterpolation::Linear);
      });
  };
  const Tiled plain = march(MarchUnpacked);
  for (const std::int64_t target : targets::OfThisMachine())
  {
    SCOPED_TRACE(hwy::TargetName(target));
    const targets::OnlyTarget only(target);
    const Tiled drawn = march(MarchPacked);
    EXPECT_EQ(MaxDifference(drawn.Picture, plain.Picture), 0.0);
    EXPECT_EQ(drawn.Ended, plain.Ended);
  }
}

TEST(Packets, ShadedSamples)
{
  Scenario test;
  std::vector<float> values = scenes::Sampled(scenes::Standard, test.N);
  ExpectSameBitsShaded(test, values, 0.0f);
  ExpectSameBitsShaded(test, values, 0.5f);
  test.Cells = { { 3, 7, 1 }, { 30, 20, 29 } };
  test.Sparse = true;
  test.OpacityLimit = 0.6f;
  ExpectSameBitsShaded(test, values, 0.5f);
  std::mt19937 random(3);
  const float special[] = { NAN, INFINITY, -INFINITY, 3e38f, -3e38f };
  for (int i = 0; i < 200; ++i)
  {
    values[random() % values.size()] = special[i % 5];
  }
  ExpectSameBitsShaded(test, values, 0.5f);
}

TEST(Packets, MacroCellsHaveTheExtremesOfTheirCorners)
{
  const glm::ivec3 n(38, 9, 65);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  BrickView view{ values.data(), ScalarType::Float32, { 1, n.x, n.x * n.y }, {} };
  const Box cells{ { 2, 0, 1 }, n - 1 };
  const PackedBrick packed(view, glm::ivec3(0), cells, 0.0);
  const int edge = 1 << packed.MacroShift();
  EXPECT_EQ(edge, 8);
  const glm::ivec3 macros = packed.Macros();
  EXPECT_EQ(macros, glm::ivec3(5, 1, 8));
  for (int i = 0; i < macros.x * macros.y * macros.z; ++i)
  {
    const glm::ivec3 macro(i % macros.x, i / macros.x % macros.y, i / macros.x / macros.y);
    const glm::ivec3 first = cells.Lo + macro * edge;
    const glm::ivec3 last = glm::min(first + edge, cells.Hi);
    ValueRange expected;
    for (int z = first.z; z <= last.z; ++z)
    {
      for (int y = first.y; y <= last.y; ++y)
      {
        for (int x = first.x; x <= last.x; ++x)
        {
          expected.Include(values[x + n.x * (y + n.y * z)]);
        }
      }
    }
    EXPECT_EQ(packed.RangeOfMacro(macro).Low, expected.Low);
    EXPECT_EQ(packed.RangeOfMacro(macro).High, expected.High);
  }
}

} // namespace
