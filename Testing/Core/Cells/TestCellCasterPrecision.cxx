// SPDX-License-Identifier: BSD-3-Clause
// Pictures of cells far from the origin, of all sizes, flat, wide, alone and none.
#include "Cells/CellParts.h"
#include "Cells/DrawnMesh.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;
using cellmeshes::Apart;
using cellmeshes::Cut;
using cellmeshes::DrawnMesh;
using cellmeshes::OwnedCellMesh;
using cellmeshes::ShownAs;

OwnedCellMesh BentCube(Cut cut = Cut::Mixed)
{
  OwnedCellMesh mesh = cellmeshes::Cube(5, cut, { 0.03, 0.05, false, 1 });
  cellmeshes::SetValues(mesh, scenes::Standard);
  return mesh;
}

/// @param least alpha that some pixel has
FloatImage ExpectReference(const DrawnMesh& drawn, double least = 0.05)
{
  const FloatImage image = drawn.Draw();
  const Apart apart = cellmeshes::Between(image, drawn.Reference());
  EXPECT_GE(apart.Decibels, 85.0);
  EXPECT_LE(apart.Worst, 0.2);
  float most = 0.0f;
  for (const glm::vec4& pixel : image.Pixels)
  {
    most = std::max(most, pixel.a);
  }
  EXPECT_GE(most, least);
  return image;
}

TEST(CellCasterPrecision, MeshesOfAnySizeAreDrawnAlike)
{
  const OwnedCellMesh mesh = BentCube();
  const FloatImage image = ExpectReference(DrawnMesh(mesh));
  for (const double factor : { 1e-6, 1e6 })
  {
    OwnedCellMesh scaled = mesh;
    cellmeshes::Place(scaled, glm::dvec3(factor), glm::dvec3(0.0));
    SCOPED_TRACE(factor);
    ExpectReference(DrawnMesh(scaled));
  }
  OwnedCellMesh scaled = mesh;
  cellmeshes::Place(scaled, glm::dvec3(0x1p20), glm::dvec3(0.0));
  EXPECT_LE(MaxDifference(DrawnMesh(scaled).Draw(), image), 1e-4);
}

TEST(CellCasterPrecision, FarFromTheOrigin)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Wedges, Cut::Pyramids, Cut::Tetrahedra, Cut::Mixed })
  {
    OwnedCellMesh mesh = BentCube(cut);
    const FloatImage image = DrawnMesh(mesh).Draw();
    // 10^7 edges and more: a point is known to about 4e-10 of an edge.
    cellmeshes::Place(mesh, glm::dvec3(1.0), glm::dvec3(0x1p21, -0x1p22, 0x1p21));
    SCOPED_TRACE(int(cut));
    const FloatImage far = ExpectReference(DrawnMesh(mesh));
    EXPECT_LE(MaxDifference(far, image), 1e-3);
  }
}

TEST(CellCasterPrecision, FlatMeshes)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Wedges, Cut::Pyramids, Cut::Tetrahedra, Cut::Mixed })
  {
    OwnedCellMesh mesh = BentCube(cut);
    cellmeshes::Place(mesh, { 1.0, 1.0, 1e-3 }, glm::dvec3(0.0));
    for (const double edge : { 0.125, 0x1p-12 })
    {
      SCOPED_TRACE(testing::Message() << int(cut) << " " << edge);
      ShownAs as;
      as.Edge = edge;
      as.Step = 0.002 / edge;
      DrawnMesh drawn(mesh, as);
      drawn.Scene.Transfer.UnitDistance = 0.002;
      ExpectReference(drawn, 0.03);
    }
  }
}

TEST(CellCasterPrecision, WideCells)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Wedges, Cut::Pyramids, Cut::Tetrahedra })
  {
    // A small mesh beside one cell, or a few, of 200 lattice edges.
    OwnedCellMesh mesh = cellmeshes::Cube(1, cut, { 0.03, 0.05, false, 3 });
    cellmeshes::SetValues(mesh, scenes::Radial);
    OwnedCellMesh small = BentCube(cut);
    cellmeshes::Place(small, glm::dvec3(5.0 / 200), glm::dvec3(1.1, 0.4, 0.4));
    cellmeshes::Append(mesh, small);
    for (const double step : { 0.7, 9.0 })
    {
      SCOPED_TRACE(testing::Message() << int(cut) << " " << step);
      ShownAs as;
      as.Edge = 1.0 / 256;
      as.Step = step;
      as.Picture = { 32, 32 };
      DrawnMesh drawn(mesh, as);
      drawn.Scene.Transfer.UnitDistance = 0.1;
      ExpectReference(drawn);
      // Close to the small ones.
      const glm::dvec3 at(1.11, 0.41, 0.41);
      drawn.LookFrom(at + glm::dvec3(0.08, 0.05, 0.1), at, glm::perspective(0.6, 1.0, 1e-3, 3.0));
      ExpectReference(drawn, 0.02);
    }
  }
}

/// Cells that are bent so much that their places reach far beyond them, and samples far away.
TEST(CellCasterPrecision, StronglyBentCellsWithLongSteps)
{
  OwnedCellMesh mesh = cellmeshes::OneCell(CellShape::Hexahedron);
  // The upper face is turned by nearly half a turn: hardly any volume in the middle.
  for (int i = 4; i < 8; ++i)
  {
    const double angle = 2.9;
    const glm::dvec3 p = cellmeshes::PointOf(mesh, i) - 0.5;
    const double x = std::cos(angle) * p.x - std::sin(angle) * p.y + 0.5;
    const double y = std::sin(angle) * p.x + std::cos(angle) * p.y + 0.5;
    mesh.Points[cellmeshes::Index(3 * i)] = x;
    mesh.Points[cellmeshes::Index(3 * i + 1)] = y;
  }
  cellmeshes::SetValues(mesh, scenes::Linear);
  ShownAs as;
  as.Edge = 1.0 / 50;
  as.Ends = false;
  as.Step = 7.9;
  DrawnMesh drawn(mesh, as);
  drawn.Scene.DomainCells = { glm::ivec3(-400), glm::ivec3(500) };
  drawn.LookFrom(drawn.Centre() + glm::dvec3(8.0, 5.0, 20.0), drawn.Centre(),
    glm::perspective(0.7, 1.0, 0.1, 60.0));
  drawn.Scene.Transfer.UnitDistance = 0.1;
  const FloatImage image = drawn.Draw();
  // Nothing but where the cell is.
  for (int y = 0; y < 48; ++y)
  {
    for (int x = 0; x < 48; ++x)
    {
      if (x < 20 || x > 27 || y < 20 || y > 27)
      {
        ASSERT_EQ(image.At(x, y).a, 0.0f) << x << " " << y;
      }
    }
  }
}

TEST(CellCasterPrecision, OneCellAlone)
{
  for (const CellShape shape :
    { CellShape::Tetrahedron, CellShape::Pyramid, CellShape::Wedge, CellShape::Hexahedron })
  {
    for (const bool ends : { false, true })
    {
      OwnedCellMesh mesh = cellmeshes::OneCell(shape);
      cellmeshes::SetValues(mesh, scenes::Linear);
      ShownAs as;
      as.Ends = ends;
      as.Step = 0.11;
      SCOPED_TRACE(testing::Message() << int(shape) << " " << ends);
      DrawnMesh drawn(mesh, as);
      drawn.Scene.Transfer.UnitDistance = 0.2;
      ExpectReference(drawn);
    }
  }
}

TEST(CellCasterPrecision, NoCells)
{
  OwnedCellMesh mesh;
  mesh.Offsets = { 0 };
  RayStatistics statistics;
  const FloatImage image = DrawnMesh(mesh).Draw(2, &statistics);
  EXPECT_EQ(image.Pixels.size(), 48u * 48u);
  for (const glm::vec4& pixel : image.Pixels)
  {
    EXPECT_EQ(pixel, glm::vec4(0.0f));
  }
  EXPECT_EQ(statistics.SamplesTaken, 0);
}

} // namespace
