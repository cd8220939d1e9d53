// SPDX-License-Identifier: BSD-3-Clause
// Lengths of rays in meshes of cells, and cells that are not as they should be.
#include "Cells/CellParts.h"
#include "Cells/DrawnMesh.h"

#include <glm/ext/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace banyan;
using cellmeshes::Apart;
using cellmeshes::Cut;
using cellmeshes::DrawnMesh;
using cellmeshes::Index;
using cellmeshes::OwnedCellMesh;
using cellmeshes::ShownAs;

/// How long the rays of a picture are in a mesh, against those in a box.
struct Lengths
{
  int Rays = 0; ///< that meet the box
  int Off = 0;  ///< by more than 1e-3 intervals
  double Worst = 0.0;
};

/// @param toBox takes the world to a space where the box is [0, 1]^3
Lengths Compare(DrawnMesh& drawn, const glm::dmat4& toBox)
{
  drawn.Scene.Transfer = cellmeshes::Tiny(drawn.Scene);
  const FloatImage image = drawn.Draw();
  Lengths lengths;
  for (int y = 0; y < image.Rect.Hi.y; ++y)
  {
    for (int x = 0; x < image.Rect.Hi.x; ++x)
    {
      const Ray ray = drawn.Scene.Camera.RayOf(x, y);
      const glm::dvec3 origin(toBox * glm::dvec4(ray.Origin, 1.0));
      const glm::dvec3 way(toBox * glm::dvec4(ray.Direction, 0.0));
      glm::dvec2 chord(-1e300, 1e300);
      for (int axis = 0; axis < 3; ++axis)
      {
        const double a = -origin[axis] / way[axis];
        const double b = (1.0 - origin[axis]) / way[axis];
        chord = { std::max(chord.x, std::min(a, b)), std::min(chord.y, std::max(a, b)) };
      }
      const double length = std::max(0.0, chord.y - chord.x) / drawn.Scene.SampleDistance;
      const double off = std::abs(cellmeshes::LengthIn(drawn.Scene, image.At(x, y)) - length);
      lengths.Rays += length > 0.0 ? 1 : 0;
      lengths.Off += off > 1e-3 ? 1 : 0;
      lengths.Worst = std::max(lengths.Worst, off);
    }
  }
  return lengths;
}

void ExpectLengths(DrawnMesh& drawn, const glm::dmat4& toBox)
{
  const Lengths lengths = Compare(drawn, toBox);
  EXPECT_GT(lengths.Rays, 1000);
  EXPECT_LE(lengths.Off, lengths.Rays / 1000);
  EXPECT_LE(lengths.Worst, 1.0);
}

/// Turned in the lattice.
glm::dmat4 TurnAndFlatten(OwnedCellMesh& mesh, const glm::dvec3& size)
{
  const glm::dvec3 axis(1.0, 2.0, 3.0);
  cellmeshes::Place(mesh, size, glm::dvec3(0.0));
  cellmeshes::Turn(mesh, axis, 0.7);
  return glm::scale(glm::dmat4(1.0), 1.0 / size) * glm::rotate(glm::dmat4(1.0), -0.7, axis);
}

TEST(CellCasterEnds, LengthsInATurnedCube)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Voxels, Cut::Tetrahedra, Cut::FiveTetrahedra,
         Cut::Wedges, Cut::Pyramids, Cut::Mixed })
  {
    for (const bool parallel : { false, true })
    {
      OwnedCellMesh mesh = cellmeshes::Cube(4, cut, { 0.04, 0.1, true, 1 });
      cellmeshes::SetValues(mesh, scenes::Linear);
      const glm::dmat4 toBox = TurnAndFlatten(mesh, glm::dvec3(1.0));
      ShownAs as;
      as.Picture = { 80, 80 };
      as.Parallel = parallel;
      as.Zoom = 2.5;
      as.Edge = 0.125;
      as.Step = 1.6;
      SCOPED_TRACE(testing::Message() << int(cut) << " " << parallel);
      DrawnMesh drawn(mesh, as);
      ExpectLengths(drawn, toBox);
      drawn.Scene.SampleDistance *= 5.0;
      ExpectLengths(drawn, toBox);
      drawn.Scene.SampleDistance *= 5.0;
      ExpectLengths(drawn, toBox);
    }
  }
}

TEST(CellCasterEnds, WithoutThemLengthsAreOff)
{
  OwnedCellMesh mesh = cellmeshes::Cube(4, Cut::Hexahedra, { 0.04, 0.1, true, 1 });
  cellmeshes::SetValues(mesh, scenes::Linear);
  const glm::dmat4 toBox = TurnAndFlatten(mesh, glm::dvec3(1.0));
  ShownAs as;
  as.Ends = false;
  DrawnMesh drawn(mesh, as);
  const Lengths lengths = Compare(drawn, toBox);
  EXPECT_GT(lengths.Off, lengths.Rays * 9 / 10);
  EXPECT_LE(lengths.Worst, 1.01);
}

TEST(CellCasterEnds, ThinShellsKeepTheirThickness)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Tetrahedra, Cut::Wedges, Cut::Pyramids })
  {
    OwnedCellMesh mesh = cellmeshes::Cube(1, cut);
    cellmeshes::SetValues(mesh, scenes::Linear);
    const glm::dmat4 toBox = TurnAndFlatten(mesh, { 1.0, 1.0, 0.02 });
    ShownAs as;
    as.Picture = { 80, 80 };
    as.Zoom = 2.5;
    as.Edge = 0.125;
    as.Step = 1.6; // ten times as long as it is thick
    DrawnMesh drawn(mesh, as);
    SCOPED_TRACE(int(cut));
    ExpectLengths(drawn, toBox);
  }
}

TEST(CellCasterEnds, CurvedShells)
{
  OwnedCellMesh mesh = cellmeshes::Sector({ 1, 20, 5 }, 0.98, 4.0);
  cellmeshes::SetValues(mesh, scenes::Linear);
  ShownAs as;
  as.Edge = 0.125;
  as.Step = 1.6;
  as.Zoom = 2.0;
  DrawnMesh drawn(mesh, as);
  drawn.Scene.Transfer.UnitDistance = 0.01;
  const FloatImage image = drawn.Draw();
  const Apart apart = cellmeshes::Between(image, drawn.Reference());
  EXPECT_GE(apart.Decibels, 85.0);
  EXPECT_LE(apart.Worst, 0.2);
  EXPECT_GT(std::count_if(image.Pixels.begin(), image.Pixels.end(),
              [](const glm::vec4& pixel) { return pixel.a > 0.05f; }),
    300);
}

/// The slow reference, within its bounds.
void ExpectReference(const DrawnMesh& drawn, double decibels = 85.0, double worst = 0.2)
{
  const FloatImage image = drawn.Draw();
  const Apart apart = cellmeshes::Between(image, drawn.Reference());
  EXPECT_GE(apart.Decibels, decibels);
  EXPECT_LE(apart.Worst, worst);
  EXPECT_GT(std::count_if(image.Pixels.begin(), image.Pixels.end(),
              [](const glm::vec4& pixel) { return pixel.a > 0.02f; }),
    4);
}

OwnedCellMesh BentCube(Cut cut = Cut::Mixed, int n = 4)
{
  OwnedCellMesh mesh = cellmeshes::Cube(n, cut, { 0.03, 0.05, false, 1 });
  cellmeshes::SetValues(mesh, scenes::Standard);
  return mesh;
}

/// Adds the cells and points of another mesh.
void Append(OwnedCellMesh& mesh, const OwnedCellMesh& other)
{
  const std::int64_t first = mesh.PointCount();
  mesh.Points.insert(mesh.Points.end(), other.Points.begin(), other.Points.end());
  mesh.Values.insert(mesh.Values.end(), other.Values.begin(), other.Values.end());
  for (std::int64_t cell = 0; cell < other.CellCount(); ++cell)
  {
    std::vector<std::int64_t> corners;
    for (std::int64_t i = other.Offsets[Index(cell)]; i < other.Offsets[Index(cell + 1)]; ++i)
    {
      corners.push_back(first + other.Ids[Index(i)]);
    }
    mesh.AddCell(other.Types[Index(cell)], corners);
  }
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
  Append(mesh, BentCube());
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

} // namespace
