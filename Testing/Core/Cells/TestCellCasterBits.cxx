// SPDX-License-Identifier: BSD-3-Clause
// What must not change a bit of a picture of cells.
#include "Cells/DrawnMesh.h"
#include "Render/Cells/CellSource.h"
#include "Render/Scene/PictureCaster.h"
#include "Targets.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using cellmeshes::DrawnMesh;
using cellmeshes::OwnedCellMesh;
using cellmeshes::ShownAs;

OwnedCellMesh BentCube(Cut cut = Cut::Mixed, double offset = 0.05)
{
  OwnedCellMesh mesh = cellmeshes::Cube(6, cut, { 0.03, offset, false, 1 });
  cellmeshes::SetValues(mesh, scenes::Standard);
  return mesh;
}

/// Several tiles, with ends of rays, shaded and not.
DrawnMesh Scenario(const OwnedCellMesh& mesh, bool shaded)
{
  ShownAs as;
  as.Picture = { 75, 70 };
  as.Step = 0.37;
  DrawnMesh drawn(mesh, as);
  drawn.Scene.Shading.On = shaded;
  drawn.Scene.Shading.Specular = 0.3f;
  const glm::dvec3 normal(-0.6, 0.3, -0.7);
  drawn.Scene.ClipPlanes = { { normal, 0.5 - glm::dot(normal, drawn.Centre()) } };
  drawn.Scene.OpacityLimit = 0.8f;
  return drawn;
}

void ExpectSomething(const FloatImage& image)
{
  const auto seen = [](const glm::vec4& pixel) { return pixel.a > 0.02f; };
  EXPECT_GT(std::count_if(image.Pixels.begin(), image.Pixels.end(), seen), 200);
}

TEST(CellCasterBits, Threads)
{
  for (const bool shaded : { false, true })
  {
    const DrawnMesh drawn = Scenario(BentCube(), shaded);
    const FloatImage image = drawn.Draw();
    ExpectSomething(image);
    for (const int threads : { 2, 3 })
    {
      EXPECT_EQ(MaxDifference(drawn.Draw(threads), image), 0.0) << threads;
    }
  }
}

TEST(CellCasterBits, Probes)
{
  DrawnMesh drawn = Scenario(BentCube(), false);
  const FloatImage image = drawn.Draw();
  drawn.Scene.Probe = true;
  EXPECT_EQ(MaxDifference(drawn.Draw(), image), 0.0);
}

TEST(CellCasterBits, ViewportsAreCutouts)
{
  // Cells that overlap, too: who owns a sample depends on no viewport.
  for (const double offset : { 0.05, 0.6 })
  {
    DrawnMesh drawn = Scenario(BentCube(Cut::Mixed, offset), false);
    const FloatImage image = drawn.Draw();
    ExpectSomething(image);
    for (const PixelRect& viewport : { PixelRect{ { 10, 5 }, { 43, 50 } },
           PixelRect{ { 33, 30 }, { 34, 31 } }, PixelRect{ { 0, 35 }, { 75, 36 } } })
    {
      drawn.Scene.Viewport = viewport;
      const FloatImage cutout = drawn.Draw();
      for (int y = viewport.Lo.y; y < viewport.Hi.y; ++y)
      {
        for (int x = viewport.Lo.x; x < viewport.Hi.x; ++x)
        {
          ASSERT_EQ(cutout.At(x, y), image.At(x, y)) << x << " " << y;
        }
      }
    }
  }
}

TEST(CellCasterBits, SetsOfInstructions)
{
  OwnedCellMesh wide = BentCube();
  for (const bool shaded : { false, true })
  {
    for (const BlendMode mode : { BlendMode::Composite, BlendMode::Maximum, BlendMode::Average })
    {
      DrawnMesh drawn = Scenario(wide, shaded);
      drawn.Scene.Blend.Mode = mode;
      const FloatImage image = drawn.Draw();
      ExpectSomething(image);
      for (const std::int64_t target : targets::OfThisMachine())
      {
        const targets::OnlyTarget only(target);
        EXPECT_EQ(MaxDifference(drawn.Draw(), image), 0.0)
          << hwy::TargetName(target) << " " << shaded << " " << int(mode);
      }
    }
  }
}

TEST(CellCasterBits, WideCellsOnSetsOfInstructions)
{
  ShownAs as;
  as.Edge = 1.0 / 1024; // cells of about 170 edges
  as.Step = 20.3;
  DrawnMesh drawn(BentCube(), as);
  drawn.Scene.Transfer.UnitDistance = 0.1;
  const FloatImage image = drawn.Draw();
  ExpectSomething(image);
  for (const std::int64_t target : targets::OfThisMachine())
  {
    const targets::OnlyTarget only(target);
    EXPECT_EQ(MaxDifference(drawn.Draw(), image), 0.0) << hwy::TargetName(target);
  }
}

TEST(CellCasterBits, OrdersOfCellsAndPointsInMemory)
{
  for (const bool shaded : { false, true })
  {
    OwnedCellMesh mesh = BentCube();
    const FloatImage image = Scenario(mesh, shaded).Draw();
    cellmeshes::Shuffle(mesh);
    EXPECT_EQ(MaxDifference(Scenario(mesh, shaded).Draw(), image), 0.0);
  }
}

TEST(CellCasterBits, SkippedPixelsChangeNoOther)
{
  DrawnMesh drawn = Scenario(BentCube(), false);
  const FloatImage image = drawn.Draw();
  for (const int stride : { 2, 4 })
  {
    drawn.Scene.Samplings = std::make_shared<const TileSamplings>(drawn.Scene.Camera.ImageSize(),
      std::vector{ RaySampling{ 0, drawn.Scene.SampleDistance, stride } });
    const FloatImage skipped = drawn.Draw();
    int rays = 0;
    for (int y = 0; y < 70; ++y)
    {
      for (int x = 0; x < 75; ++x)
      {
        const bool has = x % stride == 0 && y % stride == 0;
        ASSERT_EQ(skipped.At(x, y), has ? image.At(x, y) : glm::vec4(0.0f)) << x << " " << y;
        rays += has && skipped.At(x, y).a > 0.02f ? 1 : 0;
      }
    }
    EXPECT_GT(rays, 200 / stride / stride);
  }
}

TEST(CellCaster, DrawsNoPartOfTheIndexSpace)
{
  const DrawnMesh drawn = Scenario(BentCube(), false);
  ThreadPool pool(1);
  CellSource source(drawn.Field, pool);
  RayStatistics unused;
  Box part = drawn.Scene.DomainCells;
  part.Hi.x -= 1;
  for (const int level : { 0, 1 })
  {
    EXPECT_THROW(
      source.AtLevel(level, drawn.Scene.DomainCells)->MakeCaster(drawn.Scene, part, pool, unused),
      Error);
  }
}

} // namespace
