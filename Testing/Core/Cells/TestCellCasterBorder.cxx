// SPDX-License-Identifier: BSD-3-Clause
// Where meshes end: rays that pass just beside them, and samples on faces that two cells have
// without having them in common.
#include "Cells/CellParts.h"
#include "Cells/RayLengths.h"
#include "Render/Cells/CellSetup.h"
#include "Render/Scene/RayLattice.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using cellmeshes::DrawnMesh;
using cellmeshes::Lengths;
using cellmeshes::OwnedCellMesh;
using cellmeshes::ShownAs;

/// Whether the bounds of a cell hold a position, by its linear part.
bool Holds(const CellSetup& cell, const glm::dvec3& position)
{
  double x[3] = {};
  for (int i = 0; i < 3; ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      const double from =
        position[axis] - cell.Middle[axis] / (1 << FractionBits) - double{ cell.Base[axis] };
      x[i] += double{ cell.Inverse[i][axis] } * from;
    }
  }
  const auto from = [&](int i, double least) { return least >= double{ cell.Least[i] }; };
  const auto upTo = [&](int i, double most) { return most <= double{ cell.Most[i] }; };
  const double h = x[2];
  switch (cell.Shape)
  {
    case CellShape::Tetrahedron:
      return from(0, x[0]) && from(1, x[1]) && from(2, x[2]) &&
             x[0] + x[1] + x[2] <= double{ cell.MostSum };
    case CellShape::Wedge:
      return from(0, x[0]) && from(1, x[1]) && from(2, x[2]) && upTo(2, x[2]) &&
             x[0] + x[1] <= double{ cell.MostSum };
    case CellShape::Pyramid:
      return from(0, x[0] + h) && from(1, x[1] + h) && from(2, h) && upTo(0, x[0] - h) &&
             upTo(1, x[1] - h) && upTo(2, h);
    default:
      return from(0, x[0]) && from(1, x[1]) && from(2, x[2]) && upTo(0, x[0]) && upTo(1, x[1]) &&
             upTo(2, x[2]);
  }
}

TEST(CellCasterBorder, BitsAreThoseOfFaces)
{
  for (const CellShape shape :
    { CellShape::Tetrahedron, CellShape::Pyramid, CellShape::Wedge, CellShape::Hexahedron })
  {
    OwnedCellMesh mesh = cellmeshes::OneCell(shape);
    cellmeshes::Turn(mesh, { 1.0, 2.0, 3.0 }, 0.7);
    const MeshCell is = mesh.View().Cell(0);
    const int count = CornersOf(shape);
    glm::dvec3 corners[8];
    glm::dvec3 middle(0.0);
    for (int i = 0; i < count; ++i)
    {
      corners[i] = mesh.View().Point(is.Points[cellmeshes::Index(i)]);
      middle += corners[i] / double(count);
    }
    const CellFaces& faces = FacesOf(shape);
    for (int beyond = 0; beyond < faces.Count; ++beyond)
    {
      const CellFace& face = faces.Faces[cellmeshes::Index(beyond)];
      glm::dvec3 at(0.0);
      for (int i = 0; i < face.Count; ++i)
      {
        at += corners[face.Corners[cellmeshes::Index(i)]] / double(face.Count);
      }
      for (int border = 0; border < faces.Count; ++border)
      {
        CellSetup cell;
        ASSERT_TRUE(cell.Set(shape, corners, 1u << border));
        EXPECT_EQ(Holds(cell, at + 0x1p-15 * (at - middle)), border != beyond)
          << int(shape) << " " << beyond << " " << border;
      }
    }
  }
}

/// Middles of a unit cube's edges of which the eye sees one face alone.
std::vector<glm::dvec3> SilhouetteOf(const glm::dmat4& fromBox, const glm::dvec3& eye)
{
  const glm::dvec3 inBox(glm::inverse(fromBox) * glm::dvec4(eye, 1.0));
  std::vector<glm::dvec3> middles;
  for (int edge = 0; edge < 12; ++edge)
  {
    const int along = edge / 4;
    glm::dvec3 middle(0.5);
    bool sees[2];
    for (int i = 0; i < 2; ++i)
    {
      const int axis = (along + 1 + i) % 3;
      middle[axis] = edge >> i & 1;
      sees[i] = middle[axis] == 0.0 ? inBox[axis] < 0.0 : inBox[axis] > 1.0;
    }
    if (sees[0] != sees[1])
    {
      middles.emplace_back(fromBox * glm::dvec4(middle, 1.0));
    }
  }
  return middles;
}

/// A cube of few cells, turned, and seen from near its silhouette: pixels are 2^-14 of an edge.
TEST(CellCasterBorder, RaysBesideACubeDoNotMeetIt)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Tetrahedra, Cut::FiveTetrahedra, Cut::Wedges,
         Cut::Pyramids, Cut::Mixed })
  {
    OwnedCellMesh mesh = cellmeshes::Cube(cut == Cut::Mixed ? 2 : 1, cut);
    cellmeshes::SetValues(mesh, scenes::Linear);
    const glm::dmat4 toBox = cellmeshes::TurnAndFlatten(mesh, glm::dvec3(1.0));
    ShownAs as;
    as.Picture = { 80, 80 };
    as.Edge = 0.125;
    as.Step = 0.3;
    DrawnMesh drawn(mesh, as);
    const glm::dvec3 eye = drawn.Centre() + glm::dvec3(1.1, 1.7, 2.3);
    const std::vector<glm::dvec3> middles = SilhouetteOf(glm::inverse(toBox), eye);
    ASSERT_EQ(middles.size(), 6u);
    Lengths all;
    for (const glm::dvec3& middle : middles)
    {
      const double angle = 80.0 * 0x1p-14 / glm::length(middle - eye);
      drawn.LookFrom(eye, middle, glm::perspective(angle, 1.0, 0.1, 10.0));
      const Lengths lengths = cellmeshes::LengthsOf(drawn, toBox);
      EXPECT_GT(lengths.Rays, 1000);
      EXPECT_LT(lengths.Rays, 5400);
      all.Off += lengths.Off;
      all.Worst = std::max(all.Worst, lengths.Worst);
    }
    // Of 480 rays along six edges. With a margin of 2^-13 they were 107 to 427.
    EXPECT_LE(all.Off, 8) << int(cut);
  }
}

/// A cube that is mostly round: all of a ball would have cells without an angle at their edges.
OwnedCellMesh Ball(int n, Cut cut)
{
  OwnedCellMesh mesh = cellmeshes::Cube(n, cut);
  for (std::int64_t i = 0; i < mesh.PointCount(); ++i)
  {
    const glm::dvec3 p = 2.0 * cellmeshes::PointOf(mesh, i) - 1.0;
    const double radius = std::max({ std::abs(p.x), std::abs(p.y), std::abs(p.z) });
    const glm::dvec3 round = p * (0.3 + 0.7 * radius / std::max(glm::length(p), 1e-9));
    std::copy_n(&round.x, 3, mesh.Points.data() + 3 * i);
  }
  cellmeshes::SetValues(mesh, [](const glm::dvec3&) { return 0.5; });
  return mesh;
}

/// Faces are flat, so that the mesh ends where its faces are.
TEST(CellCasterBorder, ABallHasTheSilhouetteOfItsFaces)
{
  for (const Cut cut : { Cut::FiveTetrahedra, Cut::Tetrahedra })
  {
    OwnedCellMesh mesh = Ball(4, cut);
    cellmeshes::Turn(mesh, { 1.0, 2.0, 3.0 }, 0.7);
    ShownAs as;
    as.Picture = { 1024, 1024 };
    as.Zoom = 1.6;
    as.Edge = 0.25;
    as.Step = 0.5;
    DrawnMesh drawn(mesh, as);
    drawn.Scene.Transfer = cellmeshes::Tiny(drawn.Scene);
    const FloatImage image = drawn.Draw(2);
    const RayScene scene = drawn.Scene;
    drawn.Scene.SampleDistance /= 16.0;
    const FloatImage fine = drawn.Draw(2);
    int met = 0;
    double worst = 0.0;
    for (std::size_t i = 0; i < image.Pixels.size(); ++i)
    {
      const double length = cellmeshes::LengthIn(scene, fine.Pixels[i]);
      met += length > 0.0 ? 1 : 0;
      worst = std::max(worst, std::abs(cellmeshes::LengthIn(scene, image.Pixels[i]) - length));
    }
    EXPECT_GT(met, 150000);
    // With a margin of 2^-13 it was 0.96, in a dozen pixels.
    EXPECT_LE(worst, 0.1) << int(cut);
  }
}

TEST(CellCasterBorder, ABallIsAsTheReferenceHasIt)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Wedges, Cut::Pyramids, Cut::Tetrahedra })
  {
    OwnedCellMesh mesh = Ball(3, cut);
    cellmeshes::Turn(mesh, { 1.0, 2.0, 3.0 }, 0.7);
    ShownAs as;
    as.Picture = { 160, 160 };
    as.Zoom = 1.6;
    as.Edge = 0.25;
    DrawnMesh drawn(mesh, as);
    const cellmeshes::Apart apart = cellmeshes::Between(drawn.Draw(), drawn.Reference());
    EXPECT_GE(apart.Decibels, 85.0) << int(cut);
    EXPECT_LE(apart.Worst, 0.2) << int(cut);
  }
}

/// Rays cross a bent face as four triangles, so the cell has to end there, too: otherwise rays that
/// pass between them and the bilinear face stand for whole intervals.
TEST(CellCasterBorder, BentFacesEndWhereTheyAreCrossed)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Wedges, Cut::Pyramids })
  {
    OwnedCellMesh mesh = cellmeshes::Cube(8, cut, { 0.03, 0.1, false, 1 });
    cellmeshes::SetValues(mesh, scenes::Linear);
    ShownAs as;
    as.Picture = { 600, 600 };
    as.Zoom = 2.0;
    as.Edge = 0.125;
    as.Step = 0.3;
    DrawnMesh drawn(mesh, as);
    drawn.Scene.Transfer = cellmeshes::Tiny(drawn.Scene);
    const FloatImage image = drawn.Draw(2);
    const RayScene scene = drawn.Scene;
    drawn.Scene.SampleDistance /= 16.0;
    const FloatImage fine = drawn.Draw(2);
    int off = 0;
    for (std::size_t i = 0; i < image.Pixels.size(); ++i)
    {
      const double length = cellmeshes::LengthIn(scene, fine.Pixels[i]);
      off += std::abs(cellmeshes::LengthIn(scene, image.Pixels[i]) - length) > 0.1 ? 1 : 0;
    }
    // Of 192,807. With bilinear faces they were 2,655 of hexahedra.
    EXPECT_LE(off, 8) << int(cut);
  }
}

/// Two blocks with a plane between them in which no face of one is one of the other.
/// @param bend of the cells; faces of the blocks stay as they are
OwnedCellMesh HangingBlocks(Cut cut, double bend)
{
  const double plane = 0.37;
  OwnedCellMesh mesh = cellmeshes::Cube(2, Cut::Hexahedra, { bend, 2.0 * bend, true, 1 });
  cellmeshes::Place(mesh, { plane, 1.0, 1.0 }, glm::dvec3(0.0));
  OwnedCellMesh fine = cellmeshes::Cube(3, cut, { bend, 2.0 * bend, true, 2 });
  cellmeshes::Place(fine, { 1.0 - plane, 1.0, 1.0 }, { plane, 0.0, 0.0 });
  cellmeshes::Append(mesh, fine);
  cellmeshes::SetValues(mesh, scenes::Linear);
  return mesh;
}

/// How the blocks lie in the lattice, and are moved.
struct Lying
{
  glm::dvec3 Size{ 1.0 };
  int Turn = 0; ///< one of many, or 0 for none
  double Factor = 1.0;
  double Offset = 0.0; ///< in edges of the box
};

/// Lengths of rays in the plane between the blocks, along the z axis of the box.
Lengths InPlane(Cut cut, double bend, const Lying& lying)
{
  OwnedCellMesh mesh = HangingBlocks(cut, bend);
  const glm::dvec3 axis(1.0 + lying.Turn, 2.0, 3.0 - 0.3 * lying.Turn);
  const double angle = lying.Turn == 0 ? 0.0 : 0.2 + 0.3 * lying.Turn;
  const glm::dvec3 far = lying.Factor * lying.Offset * glm::dvec3(1.0, -0.7, 1.3);
  cellmeshes::Place(mesh, lying.Size, glm::dvec3(0.0));
  cellmeshes::Turn(mesh, axis, angle);
  cellmeshes::Place(mesh, glm::dvec3(lying.Factor), far);
  glm::dmat4 toBox = glm::scale(glm::dmat4(1.0), 1.0 / (lying.Factor * lying.Size));
  toBox = glm::translate(glm::rotate(toBox, -angle, axis), -far);
  ShownAs as;
  as.Picture = { 1, 97 };
  DrawnMesh drawn(mesh, as);
  drawn.Scene.SampleDistance = 0.01 * lying.Factor;
  const glm::dvec3 middle(0.37, 0.503, 0.5);
  const glm::dmat4 view =
    glm::lookAt(middle + glm::dvec3(0.0, 0.0, 5.0), middle, glm::dvec3(0.0, 1.0, 0.0));
  const double half = 0.48;
  const glm::dvec3 anchor(glm::inverse(toBox) * glm::dvec4(middle, 1.0));
  drawn.Scene.Camera =
    RayCamera(glm::ortho(-0.01, 0.01, -half, half, 1.0, 10.0) * view * toBox, as.Picture, anchor);
  return cellmeshes::LengthsOf(drawn, toBox);
}

/// Each sample is on the border of both blocks, or beside it by what rounding makes: a margin of 0
/// loses up to a tenth of them, and a fixed one of 2^-20 those of the flat cells.
TEST(CellCasterBorder, NoSampleInThePlaneOfHangingFacesIsLost)
{
  std::vector<Lying> all;
  for (const double factor : { 1e-6, 1.0, 1e6 })
  {
    for (const double offset : { 0.0, 1e5 })
    {
      all.push_back({ glm::dvec3(1.0), 0, factor, offset });
    }
  }
  for (int turn = 1; turn < 12; ++turn)
  {
    all.push_back({ glm::dvec3(1.0), turn });
    all.push_back({ glm::dvec3(0.001, 1.0, 1.0), turn });
  }
  for (const Cut cut : { Cut::Hexahedra, Cut::Wedges, Cut::Pyramids, Cut::Tetrahedra })
  {
    for (const double bend : { 0.0, 0.01, 0.08 })
    {
      for (const Lying& lying : all)
      {
        const Lengths lengths = InPlane(cut, bend, lying);
        EXPECT_EQ(lengths.Rays, 97);
        EXPECT_LE(lengths.Worst, 0.1) << int(cut) << " " << bend << " " << lying.Size.x << " "
                                      << lying.Turn << " " << lying.Factor << " " << lying.Offset;
      }
    }
  }
}

} // namespace
