// SPDX-License-Identifier: BSD-3-Clause
// Cells are looked at once for all pictures that a camera takes, and pictures are the same bits.
#include "Cells/DrawnMesh.h"
#include "Render/Cells/CellBins.h"
#include "Render/Cells/CellSource.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using cellmeshes::DrawnMesh;
using cellmeshes::OwnedCellMesh;
using cellmeshes::ShownAs;

DrawnMesh BentCube()
{
  OwnedCellMesh mesh = cellmeshes::Cube(6, Cut::Mixed, { 0.03, 0.05, false, 1 });
  cellmeshes::SetValues(mesh, scenes::Standard);
  ShownAs as;
  as.Picture = { 75, 70 };
  as.Step = 0.37;
  return DrawnMesh(std::move(mesh), as);
}

FloatImage DrawnFrom(CellSource& source, const RayScene& scene, ThreadPool& pool)
{
  RayStatistics unused;
  return CastViewport(scene, source, scene.DomainCells, 1 << 30, pool, unused);
}

/// The scene in a picture of another size, with samples further apart and rays in some pixels only.
RayScene Probe(const RayScene& scene, const glm::ivec2& size, double times, int stride)
{
  RayScene probe = scene;
  probe.Camera = scene.Camera.WithSize(size);
  probe.Viewport = { glm::ivec2(0), size };
  probe.Samplings = std::make_shared<const TileSamplings>(
    size, std::vector{ RaySampling{ 0, times * scene.SampleDistance, stride } });
  probe.Probe = true;
  return probe;
}

TEST(SeenCells, PicturesTakeTheMemoryOfThoseBefore)
{
  const DrawnMesh drawn = BentCube();
  ThreadPool pool(1);
  LargeMemory::Trim();
  CellSource source(drawn.Field, pool);
  const FloatImage first = DrawnFrom(source, drawn.Scene, pool);
  const std::size_t kept = LargeMemory::KeptBytes();
  EXPECT_GT(kept, sizeof(SampleSlab) + sizeof(RayTile)) << "of a thread";
  const FloatImage second = DrawnFrom(source, drawn.Scene, pool);
  EXPECT_EQ(LargeMemory::KeptBytes(), kept);
}

TEST(SeenCells, AreLookedAtOnceForAllPicturesOfACamera)
{
  const DrawnMesh drawn = BentCube();
  ThreadPool pool(2);
  CellSource source(drawn.Field, pool);
  EXPECT_EQ(source.SeenBytes(), 0u);
  for (const int size : { 9, 20, 75 })
  {
    for (const double times : { 1.0, 4.0, 16.0 })
    {
      for (const int stride : { 1, 4 })
      {
        const RayScene probe = Probe(drawn.Scene, { size, size - 2 }, times, stride);
        CellSource other(drawn.Field, pool);
        const FloatImage image = DrawnFrom(source, probe, pool);
        EXPECT_EQ(MaxDifference(image, DrawnFrom(other, probe, pool)), 0.0);
        EXPECT_EQ(other.TimesSeen(), 1);
      }
    }
  }
  EXPECT_EQ(source.TimesSeen(), 1);
  EXPECT_GE(source.SeenBytes(), drawn.Field.Cells->Order.size() * sizeof(PlacedCell));
}

TEST(SeenCells, AreLookedAtAgainWhereTheSceneIsAnother)
{
  DrawnMesh drawn = BentCube();
  ThreadPool pool(1);
  CellSource source(drawn.Field, pool);
  const auto draw = [&](int times)
  {
    CellSource other(drawn.Field, pool);
    const FloatImage image = DrawnFrom(source, drawn.Scene, pool);
    EXPECT_EQ(MaxDifference(image, DrawnFrom(other, drawn.Scene, pool)), 0.0);
    EXPECT_EQ(source.TimesSeen(), times);
  };
  draw(1);
  draw(1);
  const glm::dmat4 toTheSide = glm::translate(glm::dmat4(1.0), glm::dvec3(0.2, 0.0, 0.0));
  drawn.Scene.Camera = RayCamera(toTheSide * drawn.Scene.Camera.WorldToClipMatrix(),
    drawn.Scene.Camera.ImageSize(), drawn.Scene.Camera.AnchorPoint());
  draw(2);
  drawn.Scene.IndexToWorld = drawn.Scene.IndexToWorld * toTheSide;
  draw(3);
  // Another function shows other values.
  for (std::size_t i = 0; i < drawn.Scene.Transfer.Entries.size() / 2; ++i)
  {
    drawn.Scene.Transfer.Entries[i].a = 0.0f;
  }
  draw(4);
  // All values count in projections.
  drawn.Scene.Blend.Mode = BlendMode::Maximum;
  draw(5);
  draw(5);
}

/// A cell in front of a camera that looks along z from (0, 0, -4).
PlacedCell PlacedCube(double low, double high)
{
  OwnedCellMesh mesh = cellmeshes::Cube(1, Cut::Hexahedra, {});
  for (double& coordinate : mesh.Points)
  {
    coordinate = glm::mix(low, high, coordinate);
  }
  mesh.Values.assign(8, 0.5f);
  DrawnMesh drawn(std::move(mesh));
  drawn.LookFrom(
    { 0, 0, -4 }, glm::dvec3(0.0), glm::perspective(std::atan(0.5) * 2.0, 1.0, 0.1, 100.0));
  ThreadPool pool(1);
  const SeenCells seen(drawn.Scene, drawn.Field, SeenCells::Kind::All, nullptr, pool);
  return seen.Placed().empty() ? PlacedCell() : seen.Placed().front();
}

TEST(SeenCells, HaveDistancesOfTheirCorners)
{
  const PlacedCell cell = PlacedCube(-0.5, 0.5);
  EXPECT_NEAR(cell.Near, 3.5f, 0.01f) << "its face is nearer than its corners";
  EXPECT_LE(cell.Near, 3.5f);
  EXPECT_NEAR(cell.Far, std::sqrt(0.5 + 4.5 * 4.5), 0.01);
  EXPECT_GE(cell.Far, std::sqrt(0.5 + 4.5 * 4.5));
}

TEST(SeenCells, HoldSamplesWhereTheMiddleOfAnIntervalIsBetween)
{
  PlacedCell cell;
  cell.Near = 3.6f;
  cell.Far = 4.4f;
  EXPECT_FALSE(cell.HoldsSamples(1.0)) << "samples at 3.5 and 4.5";
  EXPECT_TRUE(cell.HoldsSamples(1.0 / 1.2)) << "a sample at 4.2";
  EXPECT_FALSE(cell.HoldsSamples(1.0 / 3.0)) << "samples at 1.5 and 4.5";
  cell.Far = 4.5f;
  EXPECT_TRUE(cell.HoldsSamples(1.0 / 3.0));
}

TEST(SeenCells, LieOverPixelsWhoseCentresTheyMayHold)
{
  const PlacedCell cell = PlacedCube(-0.5, 0.5);
  // The near face goes from -0.5 / 3.5 of half the picture times 2 to the same above.
  const PixelRect pixels = cell.PixelsIn(glm::vec2(70.0f), { { 0, 0 }, { 70, 70 } });
  EXPECT_EQ(pixels.Lo, glm::ivec2(25));
  EXPECT_EQ(pixels.Hi, glm::ivec2(45));
  EXPECT_EQ(cell.PixelsIn(glm::vec2(70.0f), { { 30, 0 }, { 40, 27 } }).Lo, glm::ivec2(30, 25));
  EXPECT_TRUE(cell.PixelsIn(glm::vec2(70.0f), { { 45, 0 }, { 70, 70 } }).Empty());
  EXPECT_TRUE(cell.PixelsIn(glm::vec2(2.0f), { { 0, 0 }, { 2, 2 } }).Empty())
    << "between the centres of large pixels";
}

} // namespace
