// SPDX-License-Identifier: BSD-3-Clause
// Cells that are not as they should be.
#include "Base/Error.h"
#include "Cells/CellParts.h"
#include "Cells/RayLengths.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

namespace
{

using namespace banyan;
using cellmeshes::Apart;
using cellmeshes::Cut;
using cellmeshes::DrawnMesh;
using cellmeshes::Index;
using cellmeshes::OwnedCellMesh;
using cellmeshes::ShownAs;

/// The slow reference, within its bounds.
/// @param least pixels with something in them
void ExpectReference(
  const DrawnMesh& drawn, double decibels = 85.0, double worst = 0.2, int least = 5)
{
  const FloatImage image = drawn.Draw();
  const Apart apart = cellmeshes::Between(image, drawn.Reference());
  EXPECT_GE(apart.Decibels, decibels);
  EXPECT_LE(apart.Worst, worst);
  EXPECT_GT(std::count_if(image.Pixels.begin(), image.Pixels.end(),
              [](const glm::vec4& pixel) { return pixel.a > 0.02f; }),
    least - 1);
}

OwnedCellMesh BentCube(Cut cut = Cut::Mixed, int n = 4)
{
  OwnedCellMesh mesh = cellmeshes::Cube(n, cut, { 0.03, 0.05, false, 1 });
  cellmeshes::SetValues(mesh, scenes::Standard);
  return mesh;
}

TEST(CellCasterFailures, FlatCellsHaveNoSamples)
{
  const FloatImage image = DrawnMesh(BentCube()).Draw();
  for (const CellShape shape :
    { CellShape::Tetrahedron, CellShape::Pyramid, CellShape::Wedge, CellShape::Hexahedron })
  {
    for (const glm::dvec3& size : { glm::dvec3(0.4, 0.4, 0.0), glm::dvec3(0.0, 0.4, 0.4),
           glm::dvec3(0.4, 0.0, 0.0), glm::dvec3(0.0) })
    {
      OwnedCellMesh mesh = BentCube();
      OwnedCellMesh flat = cellmeshes::OneCell(shape);
      cellmeshes::Place(flat, size, glm::dvec3(0.31, 0.29, 0.33));
      cellmeshes::SetValues(flat, [](const glm::dvec3&) { return 1.0; });
      Append(mesh, flat);
      EXPECT_LE(MaxDifference(DrawnMesh(mesh).Draw(), image), 1e-3)
        << int(shape) << " " << size.x << size.y << size.z;
    }
  }
}

TEST(CellCasterFailures, CollapsedHexahedraAreTheCellsThatTheyAre)
{
  struct Collapsed
  {
    CellShape As;
    std::vector<std::int64_t> Corners; ///< of a hexahedron, as VTK has them
  };
  // Corners of OneCell.
  for (const Collapsed& collapsed : { Collapsed{ CellShape::Wedge, { 0, 1, 2, 2, 4, 5, 6, 6 } },
         Collapsed{ CellShape::Pyramid, { 0, 1, 3, 2, 8, 8, 8, 8 } },
         Collapsed{ CellShape::Tetrahedron, { 0, 1, 2, 2, 4, 4, 4, 4 } } })
  {
    for (const bool ends : { false, true })
    {
      OwnedCellMesh mesh = cellmeshes::OneCell(collapsed.As);
      cellmeshes::SetValues(mesh, scenes::Linear);
      OwnedCellMesh hexahedron = mesh;
      hexahedron.Types.clear();
      hexahedron.Ids.clear();
      hexahedron.Offsets.clear();
      hexahedron.AddCell(cellmeshes::Hexahedron, collapsed.Corners);
      ShownAs as;
      as.Ends = ends;
      as.Step = 0.1;
      as.Edge = 1.0;
      const Apart apart =
        cellmeshes::Between(DrawnMesh(hexahedron, as).Draw(), DrawnMesh(mesh, as).Draw());
      EXPECT_GE(apart.Decibels, 70.0) << int(collapsed.As) << " " << ends;
      EXPECT_LE(apart.Worst, 1.5) << int(collapsed.As) << " " << ends;
    }
  }
}

TEST(CellCasterFailures, FoldedCells)
{
  for (const bool ends : { false, true })
  {
    OwnedCellMesh mesh = cellmeshes::FoldedCell();
    cellmeshes::SetValues(mesh, scenes::Linear);
    ShownAs as;
    as.Ends = ends;
    as.Step = 0.1;
    as.Edge = 1.0;
    DrawnMesh drawn(mesh, as);
    drawn.Scene.Transfer.UnitDistance = 0.2;
    ExpectReference(drawn, 70.0, 3.0);
  }
  OwnedCellMesh mesh = cellmeshes::Cube(4, Cut::Hexahedra, { 0.03, 0.45, false, 1 });
  cellmeshes::SetValues(mesh, scenes::Standard);
  ExpectReference(DrawnMesh(mesh), 70.0, 3.0);
}

TEST(CellCasterFailures, DuplicatesChangeNothing)
{
  ShownAs as;
  as.Ends = false;
  OwnedCellMesh mesh = BentCube();
  const FloatImage image = DrawnMesh(mesh, as).Draw();
  cellmeshes::Append(mesh, BentCube());
  EXPECT_EQ(MaxDifference(DrawnMesh(mesh, as).Draw(), image), 0.0);
}

TEST(CellCasterFailures, OfCellsThatOverlapTheLastInTheOrderWins)
{
  for (const bool ends : { false, true })
  {
    OwnedCellMesh mesh = cellmeshes::Cube(2, Cut::Mixed, { 0.03, 0.05, false, 1 });
    mesh.Values.assign(Index(mesh.PointCount()), 0.2f);
    OwnedCellMesh other = cellmeshes::Cube(3, Cut::Hexahedra, { 0.03, 0.05, false, 2 });
    cellmeshes::Place(other, glm::dvec3(0.8), { 0.45, 0.3, 0.2 });
    other.Values.assign(Index(other.PointCount()), 0.9f);
    Append(mesh, other);
    ShownAs as;
    as.Ends = ends;
    DrawnMesh drawn(mesh, as);
    ExpectReference(drawn);
    const FloatImage image = drawn.Draw();
    DrawnCells cells = *drawn.Field.Cells;
    std::reverse(cells.Order.begin(), cells.Order.end());
    drawn.SetCells(cells);
    ExpectReference(drawn);
    EXPECT_GT(MaxDifference(drawn.Draw(), image), 0.01);
  }
}

TEST(CellCasterFailures, HangingNodesLeaveNoHoleAndNothingTwice)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Wedges, Cut::Tetrahedra, Cut::Pyramids })
  {
    OwnedCellMesh mesh = cellmeshes::Cube(1, Cut::Hexahedra);
    cellmeshes::Place(mesh, { 0.5, 1.0, 1.0 }, glm::dvec3(0.0));
    OwnedCellMesh fine = cellmeshes::Cube(3, cut, { 0.03, 0.05, true, 1 });
    cellmeshes::Place(fine, { 0.5, 1.0, 1.0 }, { 0.5, 0.0, 0.0 });
    Append(mesh, fine);
    cellmeshes::SetValues(mesh, scenes::Linear);
    const glm::dmat4 toBox = TurnAndFlatten(mesh, glm::dvec3(1.0));
    for (const double step : { 0.4, 3.0 })
    {
      ShownAs as;
      as.Picture = { 80, 80 };
      as.Zoom = 2.5;
      as.Edge = 0.25;
      as.Step = step;
      SCOPED_TRACE(testing::Message() << int(cut) << " " << step);
      DrawnMesh drawn(mesh, as);
      ExpectLengths(drawn, toBox);
    }
  }
}

TEST(CellCasterFailures, ManyCellsUnderAPixel)
{
  ShownAs as;
  as.Picture = { 40, 40 };
  as.Distance = 5.0;
  for (const double step : { 1.0, 40.0 })
  {
    as.Step = step;
    DrawnMesh drawn(BentCube(Cut::Mixed, 8), as);
    drawn.Scene.Transfer.UnitDistance = 0.1;
    SCOPED_TRACE(step);
    ExpectReference(drawn);
  }
}

TEST(CellCasterFailures, AMeshInAFewPixels)
{
  ShownAs as;
  as.Picture = { 9, 9 };
  as.Distance = 8.0;
  DrawnMesh drawn(BentCube(Cut::Hexahedra, 20), as);
  drawn.Scene.Transfer.UnitDistance = 0.1;
  ExpectReference(drawn, 85.0, 0.2, 1);
}

/// The cells of a mesh that are drawn when it is checked, seen as another one.
DrawnMesh Checked(const OwnedCellMesh& mesh, const OwnedCellMesh& seenAs)
{
  ThreadPool pool(2);
  CellFacts facts;
  DrawnMesh drawn(seenAs);
  DrawnCells cells = *DrawnCells::Of(mesh.View(), facts, pool);
  cells.Lattice = drawn.Field.Cells->Lattice;
  drawn.SetCells(cells);
  return drawn;
}

/// @return the sentence that it is refused with, or none
std::string RefusalOf(const OwnedCellMesh& mesh)
{
  ThreadPool pool(2);
  CellFacts facts;
  try
  {
    DrawnCells::Of(mesh.View(), facts, pool);
    return "";
  }
  catch (const Error& error)
  {
    return error.what();
  }
}

TEST(CellCasterFailures, PointsThatAreNoNumbersTakeTheirCellsWithThem)
{
  const OwnedCellMesh good = BentCube(Cut::Mixed);
  const FloatImage whole = Checked(good, good).Draw();
  const std::int64_t point = good.Ids.back();
  std::vector<std::uint8_t> hidden(Index(good.CellCount()), 0);
  for (std::int64_t cell = 0; cell < good.CellCount(); ++cell)
  {
    hidden[Index(cell)] = std::count(good.Ids.begin() + good.Offsets[Index(cell)],
                            good.Ids.begin() + good.Offsets[Index(cell + 1)], point) > 0
                            ? 1
                            : 0;
  }
  DrawnMesh without = Checked(good, good);
  DrawnCells cells = *without.Field.Cells;
  cells.Order.erase(std::remove_if(cells.Order.begin(), cells.Order.end(),
                      [&](std::uint32_t cell) { return hidden[cell] != 0; }),
    cells.Order.end());
  without.SetCells(cells);
  const FloatImage expected = without.Draw();
  EXPECT_GT(MaxDifference(expected, whole), 0.01);
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : { double(NAN), infinity, -infinity, 1e200 })
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      OwnedCellMesh mesh = good;
      mesh.Points[Index(3 * point + axis)] = bad;
      EXPECT_EQ(MaxDifference(Checked(mesh, good).Draw(), expected), 0.0) << bad << " " << axis;
    }
  }
}

/// The lattice takes them all, and what lies near each other falls into one place of it.
TEST(CellCasterFailures, OneHugeCellBesideAllOthers)
{
  for (const double size : { 1e8, 1e30, 1e149 })
  {
    OwnedCellMesh mesh = BentCube();
    OwnedCellMesh other = cellmeshes::OneCell(CellShape::Hexahedron);
    cellmeshes::Place(other, glm::dvec3(size), glm::dvec3(2.0));
    other.Values.assign(Index(other.PointCount()), 0.5f);
    cellmeshes::Append(mesh, other);
    ThreadPool pool(2);
    CellFacts facts;
    const auto cells = DrawnCells::Of(mesh.View(), facts, pool);
    EXPECT_EQ(facts.Drawn(), mesh.CellCount());
    const CellLattice& lattice = cells->Lattice;
    DrawnMesh drawn(BentCube());
    drawn.Field.Cells = cells;
    drawn.Field.Values = mesh.Values;
    drawn.Scene.IndexToWorld =
      glm::scale(glm::translate(glm::dmat4(1.0), lattice.Origin / lattice.Edge), glm::dvec3(1.0));
    drawn.Scene.DomainCells = { glm::ivec3(0), lattice.Size };
    drawn.Scene.SampleDistance = 1e4;
    drawn.Scene.Transfer.UnitDistance = 1e5;
    const double diagonal = drawn.Diagonal();
    drawn.LookFrom(drawn.Centre() + 1.4 * diagonal * glm::dvec3(0.48, 0.36, 0.8), drawn.Centre(),
      glm::perspective(0.6, 1.0, 0.1 * diagonal, 4.0 * diagonal));
    const FloatImage image = drawn.Draw();
    for (const glm::vec4& pixel : image.Pixels)
    {
      ASSERT_TRUE(pixel.a >= 0.0f && pixel.a <= 1.0f) << size;
    }
    EXPECT_GT(image.At(24, 24).a, 0.05f) << size;
  }
}

TEST(CellCasterFailures, RepeatedPointsDrawNothing)
{
  const OwnedCellMesh good = BentCube(Cut::Hexahedra);
  const FloatImage image = Checked(good, good).Draw();
  for (const std::vector<std::int64_t>& corners :
    { std::vector<std::int64_t>{ 3, 3, 3, 3, 3, 3, 3, 3 }, { 3, 3, 3, 3, 60, 60, 60, 60 },
      { 0, 1, 2, 3, 0, 1, 2, 3 } })
  {
    OwnedCellMesh mesh = good;
    mesh.AddCell(cellmeshes::Hexahedron, corners);
    EXPECT_EQ(MaxDifference(Checked(mesh, good).Draw(), image), 0.0) << corners[4];
  }
}

TEST(CellCasterFailures, CellsThatAreNotDrawnChangeNothing)
{
  const OwnedCellMesh good = BentCube(Cut::Mixed);
  const FloatImage image = Checked(good, good).Draw();
  OwnedCellMesh mesh = good;
  mesh.AddCell(5, { 0, 1, 40 });
  mesh.AddCell(3, { 0, 40 });
  mesh.AddCell(1, { 7 });
  mesh.AddCell(0, {});
  mesh.AddCell(cellmeshes::Hexahedron, { 0, 1, 2, 30, 31, 32, 40 });
  EXPECT_EQ(MaxDifference(Checked(mesh, good).Draw(), image), 0.0);
}

TEST(CellCasterFailures, MeshesWithoutCellsToDrawAreRefused)
{
  OwnedCellMesh mesh;
  mesh.Offsets = { 0 };
  EXPECT_EQ(RefusalOf(mesh), "The mesh has no cells that can be drawn");
  mesh.Points = { 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 1.0, 1.0, 0.0 };
  mesh.AddCell(5, { 0, 1, 2 });
  mesh.AddCell(3, { 0, 1 });
  mesh.AddCell(cellmeshes::Tetrahedron, { 0, 1, 2, 3 });
  EXPECT_EQ(RefusalOf(mesh), "The mesh has no cells that can be drawn");
  mesh.AddCell(cellmeshes::Tetrahedron, { 0, 1, 2, 4 });
  EXPECT_EQ(RefusalOf(mesh), "Cell 3 refers to point 4, and the mesh has 4 points");
}

} // namespace
