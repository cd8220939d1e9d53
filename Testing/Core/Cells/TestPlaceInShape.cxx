// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CellMeshes.h"
#include "Cells/PlaceInShape.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <vector>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using cellmeshes::Numbers;
using cellmeshes::OwnedCellMesh;

const std::vector<CellShape> AllShapes{ CellShape::Tetrahedron, CellShape::Pyramid,
  CellShape::Wedge, CellShape::Hexahedron };

CellCorners CornersIn(const CellMesh& mesh, std::int64_t number)
{
  const MeshCell cell = mesh.Cell(number);
  CellCorners corners{};
  for (int i = 0; i < CornersOf(cell.Shape); ++i)
  {
    corners[i] = mesh.Point(cell.Points[i]);
  }
  return corners;
}

/// A cell of size 1 whose corners are off by up to a part of that.
CellCorners RandomCell(CellShape shape, double off, Numbers& numbers)
{
  CellCorners corners = CornersIn(cellmeshes::OneCell(shape).View(), 0);
  for (glm::dvec3& corner : corners)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      corner[axis] += numbers.Between(-off, off);
    }
  }
  return corners;
}

/// A place inside, whose distance from the border is at least a part of the cell.
glm::dvec3 RandomPlace(CellShape shape, double margin, Numbers& numbers)
{
  for (;;)
  {
    glm::dvec3 place;
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = numbers.Between(margin, 1.0 - margin);
    }
    const bool prism = shape == CellShape::Wedge && place.x + place.y > 1.0 - margin;
    const bool simplex =
      shape == CellShape::Tetrahedron && place.x + place.y + place.z > 1.0 - margin;
    if (!prism && !simplex)
    {
      return place;
    }
  }
}

/// Where the corners are in VTK's parametric coordinates.
std::vector<glm::dvec3> PlacesOfCorners(CellShape shape)
{
  switch (shape)
  {
    case CellShape::Tetrahedron:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    case CellShape::Pyramid:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0.5, 0.5, 1 } };
    case CellShape::Wedge:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 }, { 0, 1, 1 } };
    default:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 1, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
        { 0, 1, 1 }, { 1, 1, 1 } };
  }
}

double DistanceOf(const glm::dvec3& a, const glm::dvec3& b)
{
  const glm::dvec3 off = glm::abs(a - b);
  return std::max({ off.x, off.y, off.z });
}

/// Places to positions and back.
/// @param change makes the cell to test of one of size 1
/// @return the largest difference, in parts of the cell
template <class Change>
double RoundTrip(CellShape shape, double off, const Change& change)
{
  Numbers numbers(7);
  double worst = 0.0;
  for (int i = 0; i < 100; ++i)
  {
    CellCorners corners = RandomCell(shape, off, numbers);
    std::transform(corners.begin(), corners.end(), corners.begin(), change);
    for (int k = 0; k < 20; ++k)
    {
      const glm::dvec3 place = RandomPlace(shape, 1e-5, numbers);
      glm::dvec3 found;
      if (!FindPlace(shape, corners, PositionAt(shape, corners, place), 1e-6, found))
      {
        return std::numeric_limits<double>::infinity();
      }
      // So far from each other are they in the cell, which is narrow at the apex of a pyramid.
      const double width = shape == CellShape::Pyramid ? 1.0 - place.z : 1.0;
      worst = std::max(worst,
        DistanceOf(place * glm::dvec3(width, width, 1.0), found * glm::dvec3(width, width, 1.0)));
    }
  }
  return worst;
}

TEST(PlaceInShape, WeightsAreOneAtTheirCorners)
{
  Numbers numbers(3);
  for (const CellShape shape : AllShapes)
  {
    const std::vector<glm::dvec3> places = PlacesOfCorners(shape);
    for (std::size_t i = 0; i < places.size(); ++i)
    {
      const std::array<double, 8> weights = WeightsAt(shape, places[i]);
      for (std::size_t k = 0; k < 8; ++k)
      {
        EXPECT_EQ(weights[k], i == k ? 1.0 : 0.0) << int(shape) << " " << i << " " << k;
      }
    }
    for (int i = 0; i < 100; ++i)
    {
      const auto weights = WeightsAt(shape, RandomPlace(shape, 0.0, numbers));
      EXPECT_NEAR(std::accumulate(weights.begin(), weights.end(), 0.0), 1.0, 1e-15);
      EXPECT_GE(*std::min_element(weights.begin(), weights.end()), 0.0);
    }
  }
}

TEST(PlaceInShape, LinearFieldsAreExact)
{
  Numbers numbers(4);
  const auto field = cellmeshes::LinearField({ 0.3, -0.7, 1.1 }, 5.0);
  for (const CellShape shape : AllShapes)
  {
    for (int i = 0; i < 200; ++i)
    {
      const CellCorners corners = RandomCell(shape, 0.15, numbers);
      const glm::dvec3 position = PositionAt(shape, corners, RandomPlace(shape, 0.0, numbers));
      glm::dvec3 place;
      ASSERT_TRUE(FindPlace(shape, corners, position, 1e-9, place));
      const std::array<double, 8> weights = WeightsAt(shape, place);
      double value = 0.0;
      for (int k = 0; k < CornersOf(shape); ++k)
      {
        value += weights[k] * field(corners[k]);
      }
      EXPECT_NEAR(value, field(position), 1e-11) << int(shape);
    }
  }
}

TEST(PlaceInShape, PlacesAreFoundAgain)
{
  for (const CellShape shape : AllShapes)
  {
    const auto same = [](const glm::dvec3& p) { return p; };
    EXPECT_LE(RoundTrip(shape, 0.0, same), 1e-12) << int(shape);
    EXPECT_LE(RoundTrip(shape, 0.15, same), 1e-9) << int(shape);
  }
}

TEST(PlaceInShape, AlsoInMirroredScaledMovedAndFlatCells)
{
  const double far = 1e7;
  for (const CellShape shape : AllShapes)
  {
    const auto mirrored = [](const glm::dvec3& p) { return glm::dvec3(-p.x, p.y, p.z); };
    EXPECT_LE(RoundTrip(shape, 0.15, mirrored), 1e-9) << int(shape);
    const auto flat = [](const glm::dvec3& p) { return glm::dvec3(p.x, p.y, 0.001 * p.z); };
    EXPECT_LE(RoundTrip(shape, 0.15, flat), 1e-8) << int(shape);
    for (const double scale : { 1e-6, 1e6 })
    {
      const auto scaled = [&](const glm::dvec3& p) { return scale * p; };
      EXPECT_LE(RoundTrip(shape, 0.15, scaled), 1e-9) << int(shape) << " " << scale;
      const auto moved = [&](const glm::dvec3& p) { return scale * (p + far); };
      // Positions are rounded to 2e-9 of the cell.
      EXPECT_LE(RoundTrip(shape, 0.15, moved), 1e-6) << int(shape) << " " << scale;
    }
  }
}

TEST(PlaceInShape, InsideEndsAtTheTolerance)
{
  constexpr double tolerance = 0x1p-13;
  Numbers numbers(5);
  for (const CellShape shape : AllShapes)
  {
    const CellCorners corners = RandomCell(shape, 0.1, numbers);
    // In the middle of the face t = 0, which all shapes have. Tolerances are of lengths of 2 there
    // but in tetrahedra and pyramids.
    const bool whole = shape == CellShape::Tetrahedron || shape == CellShape::Pyramid;
    const double edge = whole ? tolerance : 0.5 * tolerance;
    for (const double out : { -0.01, 0.0, 0.9 * edge, 1.1 * edge, 0.01 })
    {
      const glm::dvec3 place(0.3, 0.3, -out);
      const glm::dvec3 position = PositionAt(shape, corners, place);
      glm::dvec3 found;
      EXPECT_EQ(FindPlace(shape, corners, position, tolerance, found), out <= edge)
        << int(shape) << " " << out;
      EXPECT_EQ(FindPlace(shape, corners, position, 1e-12, found), out <= 0.0)
        << int(shape) << " " << out;
    }
  }
}

/// Each face has its own tolerance.
TEST(PlaceInShape, TolerancesAreThoseOfFaces)
{
  Numbers numbers(8);
  for (const CellShape shape : AllShapes)
  {
    const CellCorners corners = RandomCell(shape, 0.1, numbers);
    const CellFaces& faces = FacesOf(shape);
    glm::dvec3 middle(0.0);
    for (int i = 0; i < CornersOf(shape); ++i)
    {
      middle += corners[static_cast<std::size_t>(i)] / double(CornersOf(shape));
    }
    for (int face = 0; face < faces.Count; ++face)
    {
      // The middle of a bilinear face lies on it, too.
      const CellFace& is = faces.Faces[static_cast<std::size_t>(face)];
      glm::dvec3 at(0.0);
      for (int i = 0; i < is.Count; ++i)
      {
        const int corner = is.Corners[static_cast<std::size_t>(i)];
        at += corners[static_cast<std::size_t>(corner)] / double(is.Count);
      }
      const glm::dvec3 outside = at + 1e-3 * (at - middle);
      for (int wide = 0; wide < faces.Count; ++wide)
      {
        FaceTolerances tolerances{};
        tolerances[static_cast<std::size_t>(wide)] = 0.01;
        glm::dvec3 found;
        EXPECT_EQ(FindPlace(shape, corners, outside, tolerances, found), wide == face)
          << int(shape) << " " << face << " " << wide;
      }
    }
  }
}

TEST(PlaceInShape, PyramidsAreSmoothAtTheirApex)
{
  Numbers numbers(6);
  for (int i = 0; i < 100; ++i)
  {
    const CellCorners corners = RandomCell(CellShape::Pyramid, 0.2, numbers);
    glm::dvec3 found;
    ASSERT_TRUE(FindPlace(CellShape::Pyramid, corners, corners[4], 1e-12, found));
    EXPECT_NEAR(WeightsAt(CellShape::Pyramid, found)[4], 1.0, 1e-12);
    for (const double below : { 1e-2, 1e-3, 1e-4, 1e-6, 1e-9 })
    {
      glm::dvec3 place = RandomPlace(CellShape::Pyramid, 0.01, numbers);
      place.z = 1.0 - below;
      const glm::dvec3 position = PositionAt(CellShape::Pyramid, corners, place);
      ASSERT_TRUE(FindPlace(CellShape::Pyramid, corners, position, 1e-12, found)) << below;
      EXPECT_LE(DistanceOf(found, place), 1e-11 / below) << below;
    }
  }
}

TEST(PlaceInShape, WeightsHaveBoundsBesideAnApex)
{
  constexpr double tolerance = 0x1p-13;
  Numbers numbers(8);
  int inside = 0;
  for (int i = 0; i < 5000; ++i)
  {
    const CellCorners corners = RandomCell(CellShape::Pyramid, 0.2, numbers);
    glm::dvec3 position = corners[4];
    for (int axis = 0; axis < 3; ++axis)
    {
      position[axis] += numbers.Between(-tolerance, tolerance);
    }
    glm::dvec3 found;
    if (FindPlace(CellShape::Pyramid, corners, position, tolerance, found))
    {
      ++inside;
      for (const double weight : WeightsAt(CellShape::Pyramid, found))
      {
        EXPECT_GE(weight, -1e-12);
        EXPECT_LE(weight, 1.0 + 1e-12);
      }
    }
  }
  EXPECT_GT(inside, 500);
}

TEST(PlaceInShape, EveryPointOfACubeIsInOneCell)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Tetrahedra, Cut::FiveTetrahedra, Cut::Wedges,
         Cut::Pyramids, Cut::Mixed })
  {
    OwnedCellMesh mesh = cellmeshes::Cube(4, cut, { 0.05, 0.15, true });
    if (cut == Cut::Mixed)
    {
      cellmeshes::MirrorCells(mesh);
    }
    const CellMesh view = mesh.View();
    Numbers numbers(9);
    for (int i = 0; i < 200; ++i)
    {
      const glm::dvec3 point = RandomPlace(CellShape::Hexahedron, 1e-6, numbers);
      int cells = 0;
      for (std::int64_t cell = 0; cell < view.CellCount; ++cell)
      {
        glm::dvec3 place;
        const CellShape shape = view.Cell(cell).Shape;
        cells += FindPlace(shape, CornersIn(view, cell), point, 1e-10, place) ? 1 : 0;
      }
      EXPECT_EQ(cells, 1) << int(cut) << " " << i;
    }
  }
}

TEST(PlaceInShape, CellsWithoutVolumeOrNumbersHoldNothing)
{
  Numbers numbers(10);
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  glm::dvec3 found;
  for (const CellShape shape : AllShapes)
  {
    CellCorners corners = RandomCell(shape, 0.1, numbers);
    const glm::dvec3 middle = PositionAt(shape, corners, { 0.3, 0.3, 0.3 });
    EXPECT_TRUE(FindPlace(shape, corners, middle, 0.1, found));
    EXPECT_FALSE(FindPlace(shape, corners, { nothing, 0.0, 0.0 }, 0.1, found));
    CellCorners broken = corners;
    broken[3].y = nothing;
    EXPECT_FALSE(FindPlace(shape, broken, middle, 0.1, found));
    // In a plane, but for rounding.
    for (int i = 0; i < 100; ++i)
    {
      corners = RandomCell(shape, 0.1, numbers);
      for (glm::dvec3& corner : corners)
      {
        corner.z = 0.3 * corner.x - 0.1 * corner.y + 0.7;
      }
      const glm::dvec3 inPlane = PositionAt(shape, corners, { 0.3, 0.3, 0.3 });
      EXPECT_FALSE(FindPlace(shape, corners, inPlane, 0.1, found)) << int(shape);
    }
  }
  EXPECT_FALSE(FindPlace(CellShape::None, {}, glm::dvec3(0.0), 0.1, found));
}

TEST(PlaceInShape, WhatIsFoundInAFoldedCellIsThere)
{
  const OwnedCellMesh mesh = cellmeshes::FoldedCell();
  const CellCorners corners = CornersIn(mesh.View(), 0);
  Numbers numbers(11);
  int found = 0;
  for (int i = 0; i < 2000; ++i)
  {
    const glm::dvec3 point = RandomPlace(CellShape::Hexahedron, 0.0, numbers);
    glm::dvec3 place;
    if (FindPlace(CellShape::Hexahedron, corners, point, 0.0, place))
    {
      ++found;
      EXPECT_LE(DistanceOf(PositionAt(CellShape::Hexahedron, corners, place), point), 1e-11);
    }
  }
  EXPECT_GT(found, 200);
  EXPECT_LT(found, 1800);
}

} // namespace
