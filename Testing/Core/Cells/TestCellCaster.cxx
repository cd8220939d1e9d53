// SPDX-License-Identifier: BSD-3-Clause
// Pictures of meshes of cells against the slow reference.
#include "Cells/DrawnMesh.h"

#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

using namespace banyan;
using cellmeshes::Apart;
using cellmeshes::Cut;
using cellmeshes::DrawnMesh;
using cellmeshes::OwnedCellMesh;
using cellmeshes::ShownAs;

/// Bent smoothly, and each point moved.
constexpr cellmeshes::Warp Bent{ 0.03, 0.05, false, 1 };

OwnedCellMesh BentCube(Cut cut, int n = 5, const cellmeshes::Field& field = scenes::Standard)
{
  OwnedCellMesh mesh = cellmeshes::Cube(n, cut, Bent);
  cellmeshes::SetValues(mesh, field);
  return mesh;
}

/// @param least alpha of the middle pixel, so that pictures show something
void ExpectReference(
  const DrawnMesh& drawn, const scenes::Function& function = cellmeshes::Dense, double least = 0.05)
{
  const FloatImage image = drawn.Draw();
  const Apart apart = cellmeshes::Between(image, drawn.Reference(function));
  EXPECT_GE(apart.Decibels, 85.0);
  EXPECT_LE(apart.Worst, 0.2);
  const glm::ivec2 size = drawn.Scene.Viewport.Size();
  EXPECT_GE(
    image.At(drawn.Scene.Viewport.Lo.x + size.x / 2, drawn.Scene.Viewport.Lo.y + size.y / 2).a,
    least);
}

TEST(CellCaster, EveryShapeIsAsTheReferenceHasIt)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Voxels, Cut::Tetrahedra, Cut::FiveTetrahedra,
         Cut::Wedges, Cut::Pyramids, Cut::Mixed })
  {
    for (const bool ends : { false, true })
    {
      for (const bool parallel : { false, true })
      {
        SCOPED_TRACE(testing::Message() << int(cut) << " " << ends << " " << parallel);
        ShownAs as;
        as.Ends = ends;
        as.Parallel = parallel;
        ExpectReference(DrawnMesh(BentCube(cut), as));
      }
    }
  }
}

TEST(CellCaster, CamerasOffTheAxisAndInside)
{
  DrawnMesh drawn(BentCube(Cut::Mixed));
  const double size = drawn.Diagonal();
  const glm::dvec3 centre = drawn.Centre();
  const glm::dvec3 far = centre + size * glm::dvec3(0.7, -0.4, 0.9);
  drawn.LookFrom(far, centre, glm::frustum(-0.1, 0.3, -0.05, 0.25, 0.5, 5.0));
  {
    SCOPED_TRACE("off the axis");
    ExpectReference(drawn, cellmeshes::Dense, 0.0);
    EXPECT_GT(drawn.Draw().At(15, 12).a, 0.05f);
  }
  drawn.LookFrom(far, centre, glm::perspective(0.6, 1.0, 1.2 * size, 1.3 * size));
  {
    SCOPED_TRACE("across both planes");
    ExpectReference(drawn, cellmeshes::Dense, 0.01);
  }
  const glm::dvec3 inside = centre + 0.05 * size * glm::dvec3(1.0, 0.3, -0.6);
  for (const double near : { 1e-4, 0.1 })
  {
    for (const glm::dvec3& to : { glm::dvec3(1.0, 0.2, 0.3), glm::dvec3(-0.3, -1.0, 0.5) })
    {
      SCOPED_TRACE(testing::Message() << "inside " << near);
      drawn.LookFrom(inside, inside + to, glm::perspective(1.5, 1.0, near * size, 4.0 * size));
      ExpectReference(drawn, cellmeshes::Dense, 0.005);
    }
  }
  drawn.LookFrom(centre, centre + glm::dvec3(0.3, 0.2, 1.0),
    glm::ortho(-0.5, 0.5, -0.5, 0.5, -0.2 * size, 0.1 * size));
  {
    SCOPED_TRACE("parallel, inside");
    ExpectReference(drawn, cellmeshes::Dense, 0.04);
  }
}

TEST(CellCaster, NothingIsDrawnBehindTheEyeAndBesideThePicture)
{
  DrawnMesh drawn(BentCube(Cut::Mixed));
  const glm::dvec3 centre = drawn.Centre();
  const glm::dvec3 eye = centre + 2.0 * drawn.Diagonal() * glm::dvec3(0.0, 0.0, 1.0);
  const auto expectNothing = [&](const glm::dvec3& to)
  {
    drawn.LookFrom(eye, eye + to, glm::perspective(0.5, 1.0, 0.01, 10.0));
    RayStatistics statistics;
    const FloatImage image = drawn.Draw(1, &statistics);
    EXPECT_EQ(image.Pixels.size(), 48u * 48u);
    for (const glm::vec4& pixel : image.Pixels)
    {
      EXPECT_EQ(pixel, glm::vec4(0.0f));
    }
    EXPECT_EQ(statistics.SamplesTaken, 0);
    EXPECT_EQ(statistics.BricksSkipped, drawn.Mesh->CellCount());
  };
  expectNothing({ 0.0, 0.0, 1.0 });
  expectNothing({ 1.0, 0.0, -0.1 });
}

TEST(CellCaster, ClipPlanesAndDepthCutIntervals)
{
  for (const bool parallel : { false, true })
  {
    ShownAs as;
    as.Parallel = parallel;
    DrawnMesh drawn(BentCube(Cut::Mixed), as);
    const glm::dvec3 centre = drawn.Centre();
    const auto plane = [&](const glm::dvec3& normal, double away) {
      drawn.Scene.ClipPlanes.push_back({ normal, away - glm::dot(normal, centre) });
    };
    plane({ 0.5, 0.2, -0.9 }, 0.21);
    plane({ -1.0, 0.4, 0.3 }, 0.3);
    plane({ 0.1, 0.2, 2.0 }, 0.4);
    {
      SCOPED_TRACE(testing::Message() << "planes " << parallel);
      ExpectReference(drawn);
    }
    for (int i = 0; i < 48 * 48; ++i)
    {
      // About the middle of the mesh; some rays have none.
      drawn.Scene.Depth.push_back(
        i % 7 == 0 ? 1.0f : (parallel ? 0.4f : 0.6f) + 0.0001f * float(i % 400));
    }
    {
      SCOPED_TRACE(testing::Message() << "planes and depth " << parallel);
      ExpectReference(drawn, cellmeshes::Dense, 0.01);
    }
    drawn.Scene.ClipPlanes.clear();
    {
      SCOPED_TRACE(testing::Message() << "depth " << parallel);
      ExpectReference(drawn, cellmeshes::Dense, 0.01);
    }
  }
}

/// Two planes leave less than an interval: no ray has a whole one.
TEST(CellCaster, SlicesThinnerThanAnInterval)
{
  DrawnMesh drawn(BentCube(Cut::Mixed));
  const glm::dvec3 normal = glm::normalize(glm::dvec3(0.4, 0.5, 0.8));
  const double middle = glm::dot(normal, drawn.Centre());
  drawn.Scene.ClipPlanes = { { normal, 0.03 - middle }, { -normal, 0.03 + middle } };
  ExpectReference(drawn, cellmeshes::Dense, 0.01);
}

TEST(CellCaster, ActorsTurnScaleShearAndMirror)
{
  glm::dmat4 shear(1.0);
  shear[1][0] = 0.5;
  shear[2][1] = -0.3;
  const glm::dmat4 turn = glm::rotate(glm::dmat4(1.0), 1.1, glm::dvec3(1.0, 2.0, -0.5));
  const glm::dmat4 scale = glm::scale(glm::dmat4(1.0), glm::dvec3(30.0, 12.0, 20.0));
  const glm::dmat4 mirror = glm::scale(glm::dmat4(1.0), glm::dvec3(-1.0, 1.0, 1.0));
  const glm::dmat4 move = glm::translate(glm::dmat4(1.0), glm::dvec3(100.0, -50.0, 7.0));
  for (const glm::dmat4& actor : { turn, scale, shear, mirror, move * turn * scale * shear })
  {
    for (const bool parallel : { false, true })
    {
      ShownAs as;
      as.Actor = actor;
      as.Parallel = parallel;
      ExpectReference(DrawnMesh(BentCube(Cut::Mixed), as));
    }
  }
}

TEST(CellCaster, MirroredCellsAreAsGoodAsOthers)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Wedges, Cut::Pyramids, Cut::Tetrahedra, Cut::Mixed })
  {
    OwnedCellMesh mesh = BentCube(cut);
    const FloatImage image = DrawnMesh(mesh).Draw();
    cellmeshes::MirrorCells(mesh);
    const DrawnMesh mirrored(mesh);
    SCOPED_TRACE(int(cut));
    ExpectReference(mirrored);
    EXPECT_GE(cellmeshes::Between(mirrored.Draw(), image).Decibels, 90.0);
  }
}

TEST(CellCaster, Grids)
{
  for (OwnedCellMesh grid :
    { cellmeshes::Sector({ 4, 9, 5 }), cellmeshes::Rectilinear({ 7, 5, 6 }) })
  {
    cellmeshes::SetValues(grid, scenes::Standard);
    const DrawnMesh drawn(grid);
    ExpectReference(drawn, cellmeshes::Dense, 0.02);
    EXPECT_EQ(MaxDifference(DrawnMesh(cellmeshes::AsCells(grid)).Draw(), drawn.Draw()), 0.0);
  }
}

TEST(CellCaster, FloatPointsAndSmallIds)
{
  OwnedCellMesh mesh = BentCube(Cut::Mixed);
  cellmeshes::RoundPoints(mesh);
  DrawnMesh drawn(mesh);
  ExpectReference(drawn);
  const FloatImage image = drawn.Draw();
  const std::vector<std::int32_t> ids(mesh.Ids.begin(), mesh.Ids.end());
  const std::vector<std::int32_t> offsets(mesh.Offsets.begin(), mesh.Offsets.end());
  DrawnCells cells = *drawn.Field.Cells;
  cells.Mesh.IdType = ScalarType::Int32;
  cells.Mesh.Connectivity = ids.data();
  cells.Mesh.Offsets = offsets.data();
  drawn.SetCells(cells);
  EXPECT_EQ(MaxDifference(drawn.Draw(), image), 0.0);
}

TEST(CellCaster, HiddenCellsLeaveHoles)
{
  DrawnMesh drawn(BentCube(Cut::Mixed));
  const FloatImage whole = drawn.Draw();
  std::vector<std::uint8_t> hidden(static_cast<std::size_t>(drawn.Mesh->CellCount()));
  for (std::size_t i = 0; i < hidden.size(); ++i)
  {
    hidden[i] = i % 3 == 0 ? 32 : 0;
  }
  DrawnCells cells = *drawn.Field.Cells;
  cells.Mesh.Hidden = hidden.data();
  cells.Order = cellmeshes::GeometricOrder(cells.Mesh);
  drawn.SetCells(cells);
  EXPECT_LT(cells.Order.size(), hidden.size());
  ExpectReference(drawn, cellmeshes::Dense, 0.02);
  EXPECT_GT(MaxDifference(drawn.Draw(), whole), 0.02);
}

TEST(CellCaster, CellsWithValuesThatAreNotFiniteAreLeftOut)
{
  OwnedCellMesh mesh = BentCube(Cut::Mixed);
  const FloatImage whole = DrawnMesh(mesh).Draw();
  mesh.Values[20] = std::numeric_limits<float>::quiet_NaN();
  mesh.Values[57] = std::numeric_limits<float>::infinity();
  mesh.Values[100] = -std::numeric_limits<float>::infinity();
  const DrawnMesh drawn(mesh);
  ExpectReference(drawn, cellmeshes::Dense, 0.02);
  EXPECT_GT(MaxDifference(drawn.Draw(), whole), 0.01);
}

TEST(CellCaster, RelativeValuesKeepTheirPrecision)
{
  constexpr double base = 1e6;
  DrawnMesh drawn(BentCube(Cut::Mixed));
  const FloatImage near = drawn.Draw();
  drawn.Field.Base = base;
  drawn.Scene.Transfer.Low = base;
  drawn.Scene.Transfer.High = base + 1.0;
  ExpectReference(drawn, [](double value) { return cellmeshes::Dense(value - base); });
  EXPECT_LE(MaxDifference(drawn.Draw(), near), 2e-4);
  drawn.Scene.Transfer.Low = base + 0.25;
  drawn.Scene.Transfer.High = base + 0.75;
  ExpectReference(
    drawn, [](double value) { return cellmeshes::Dense((value - base - 0.25) * 2.0); });
}

TEST(CellCaster, ValuesOfCellsAreStepsOfColour)
{
  for (const bool ends : { false, true })
  {
    OwnedCellMesh mesh = BentCube(Cut::Mixed);
    mesh.Values.clear();
    OwnedCellMesh apart = mesh;
    cellmeshes::SeparatePoints(apart);
    cellmeshes::Numbers numbers(7);
    for (std::int64_t cell = 0; cell < mesh.CellCount(); ++cell)
    {
      mesh.Values.push_back(static_cast<float>(numbers.Between(0.0, 1.0)));
      const auto first = static_cast<std::size_t>(apart.Offsets[static_cast<std::size_t>(cell)]);
      const auto last = static_cast<std::size_t>(apart.Offsets[static_cast<std::size_t>(cell) + 1]);
      apart.Values.insert(apart.Values.end(), last - first, mesh.Values.back());
    }
    ShownAs as;
    as.Ends = ends;
    const DrawnMesh reference(apart, as);
    ExpectReference(reference);
    as.OfCells = true;
    EXPECT_EQ(MaxDifference(DrawnMesh(mesh, as).Draw(), reference.Draw()), 0.0);
  }
}

} // namespace
