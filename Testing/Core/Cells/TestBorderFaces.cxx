// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/BorderFaces.h"

#include "Base/ThreadPool.h"
#include "Cells/CellOrder.h"
#include "Cells/CellsTesting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace banyan
{

void PrintTo(const BorderFace& face, std::ostream* out)
{
  *out << face.Cell << '.' << int(face.Face);
}

} // namespace banyan

namespace
{

using namespace banyan;

struct Border
{
  std::vector<std::uint32_t> Order;
  std::vector<BorderFace> Faces;
};

Border BorderOf(const CellMesh& mesh, int threads = 2)
{
  ThreadPool pool(threads);
  const CellFacts facts = CheckCells(mesh, pool);
  Border border;
  border.Order = OrderOfCells(mesh, facts, LatticeOf(ExtentOf(mesh, facts, pool)), pool);
  border.Faces = BorderFacesOf(mesh, facts, border.Order, pool);
  return border;
}

/// The corners of a face, one after the other around it.
std::vector<glm::dvec3> CornersOfFace(const CellMesh& mesh, std::uint32_t cell, int number)
{
  const MeshCell is = mesh.Cell(cell);
  const CellFace& face = FacesOf(is.Shape).Faces[static_cast<std::size_t>(number)];
  std::vector<glm::dvec3> corners;
  for (int i = 0; i < face.Count; ++i)
  {
    const auto corner = static_cast<std::size_t>(face.Corners[static_cast<std::size_t>(i)]);
    corners.push_back(mesh.Point(is.Points[corner]));
  }
  return corners;
}

/// By the places themselves.
std::vector<BorderFace> SlowBorder(const CellMesh& mesh, const std::vector<std::uint32_t>& order)
{
  std::map<std::set<std::array<double, 3>>, std::vector<BorderFace>> owners;
  for (std::uint32_t place = 0; place < order.size(); ++place)
  {
    const int faces = FacesOf(mesh.Cell(order[place]).Shape).Count;
    for (int face = 0; face < faces; ++face)
    {
      std::set<std::array<double, 3>> places; // -0 compares as 0
      for (const glm::dvec3& p : CornersOfFace(mesh, order[place], face))
      {
        places.insert({ p.x, p.y, p.z });
      }
      if (places.size() > 2)
      {
        owners[places].push_back({ place, static_cast<std::uint8_t>(face) });
      }
    }
  }
  std::vector<BorderFace> border;
  for (const auto& [places, cells] : owners)
  {
    if (cells.size() % 2 == 1)
    {
      border.push_back(cells.front());
    }
  }
  std::sort(border.begin(), border.end(),
    [](const BorderFace& a, const BorderFace& b)
    { return a.Cell != b.Cell ? a.Cell < b.Cell : a.Face < b.Face; });
  return border;
}

/// @return how many faces the border has
std::size_t ExpectAsSlow(const CellMesh& mesh)
{
  const Border border = BorderOf(mesh);
  EXPECT_EQ(border.Faces, SlowBorder(mesh, border.Order));
  const std::vector<std::uint8_t> bits = BorderBitsOf(border.Faces, border.Order.size());
  std::vector<BorderFace> ofBits;
  for (std::size_t i = 0; i < 8 * bits.size(); ++i)
  {
    if ((bits[i / 8] >> i % 8 & 1) != 0)
    {
      ofBits.push_back({ static_cast<std::uint32_t>(i / 8), static_cast<std::uint8_t>(i % 8) });
    }
  }
  EXPECT_EQ(ofBits, border.Faces);
  for (const int threads : { 1, 5 })
  {
    EXPECT_EQ(BorderOf(mesh, threads).Faces, border.Faces) << threads;
  }
  return border.Faces.size();
}

double Area(const CellMesh& mesh, const Border& border)
{
  double area = 0.0;
  for (const BorderFace& face : border.Faces)
  {
    const std::vector<glm::dvec3> p = CornersOfFace(mesh, border.Order[face.Cell], face.Face);
    for (std::size_t i = 2; i < p.size(); ++i)
    {
      area += glm::length(glm::cross(p[i - 1] - p[0], p[i] - p[0])) / 2.0;
    }
  }
  return area;
}

/// Every cell with points of its own.
OwnMesh Exploded(const OwnMesh& mesh)
{
  OwnMesh result;
  for (std::size_t cell = 0; cell < mesh.Cells(); ++cell)
  {
    std::vector<glm::dvec3> corners;
    for (const std::int64_t id : mesh.IdsOf(cell))
    {
      corners.push_back(mesh.Point(id));
    }
    result.AddCellAt(mesh.Types[cell], corners);
  }
  return result;
}

CellMesh GridOf(const OwnMesh& mesh, const glm::ivec3& size)
{
  CellMesh grid = mesh.View();
  grid.Is = CellMesh::Kind::Curvilinear;
  grid.Size = size;
  grid.CellCount = std::int64_t{ size.x - 1 } * (size.y - 1) * (size.z - 1);
  return grid;
}

TEST(BorderFaces, BoxesHaveTheirSixSides)
{
  for (const Split split : { Split::Hexahedra, Split::Voxels, Split::Wedges, Split::Pyramids,
         Split::Tetrahedra, Split::Mixed })
  {
    const OwnMesh mesh = BoxOf(split, 11, 9, 7);
    EXPECT_NEAR(Area(mesh.View(), BorderOf(mesh.View())), 2 * (99 + 77 + 63), 1e-9);
    const bool halves = split == Split::Tetrahedra;
    const std::size_t sides = 2 * (99 + 77 + 63);
    const std::size_t faces = halves ? 2 * sides : split == Split::Wedges ? sides + 2 * 99 : sides;
    EXPECT_EQ(ExpectAsSlow(mesh.View()), faces) << static_cast<int>(split);
    // Larger than what pairs off nearby.
    const OwnMesh large = BoxOf(split, 40, 30, 20);
    EXPECT_NEAR(Area(large.View(), BorderOf(large.View())), 2 * (1200 + 800 + 600), 1e-9);
  }
}

TEST(BorderFaces, CellsWithPointsOfTheirOwnMeet)
{
  for (const Split split : { Split::Hexahedra, Split::Wedges, Split::Tetrahedra, Split::Mixed })
  {
    OwnMesh mesh = BoxOf(split, 7, 6, 5);
    Shake(mesh, 0.2, 4);
    const std::size_t faces = ExpectAsSlow(mesh.View());
    EXPECT_EQ(ExpectAsSlow(Exploded(mesh).View()), faces);
    EXPECT_EQ(ExpectAsSlow(Shuffled(Exploded(mesh), 3).View()), faces);
  }
}

TEST(BorderFaces, BothZerosAreOnePlace)
{
  OwnMesh mesh = Exploded(BoxOf(Split::Hexahedra, 2, 2, 2));
  mesh.Move([](const glm::dvec3& p) { return p - 1.0; });
  std::mt19937 random(1);
  for (double& x : mesh.Points)
  {
    x = x == 0.0 && random() % 2 == 0 ? -0.0 : x;
  }
  EXPECT_EQ(ExpectAsSlow(mesh.View()), 24u);
}

TEST(BorderFaces, Float32IsComparedAsFloat64)
{
  OwnMesh mesh = BoxOf(Split::Mixed, 4, 4, 4);
  Shake(mesh, 0.1, 9);
  mesh.Move([](const glm::dvec3& p) { return glm::dvec3(glm::vec<3, float>(p)); });
  const std::vector<float> points(mesh.Points.begin(), mesh.Points.end());
  CellMesh view = mesh.View();
  view.Points = points.data();
  view.PointType = ScalarType::Float32;
  EXPECT_EQ(BorderOf(view).Faces, BorderOf(mesh.View()).Faces);
  ExpectAsSlow(view);
}

TEST(BorderFaces, MirroredCellsMeetOthers)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 5, 5, 5);
  for (std::size_t cell = 0; cell < mesh.Cells(); cell += 2)
  {
    for (std::size_t i = 0; i < 4; ++i)
    {
      std::swap(mesh.Ids[8 * cell + i], mesh.Ids[8 * cell + 4 + i]);
    }
  }
  EXPECT_EQ(ExpectAsSlow(mesh.View()), 150u);
}

TEST(BorderFaces, CollapsedHexahedraAreWhatTheyLookLike)
{
  // A cube of six pyramids and a cube of two wedges, some of them as hexahedra.
  OwnMesh mesh = BoxOf(Split::Pyramids, 1, 1, 1);
  OwnMesh wedges = BoxOf(Split::Wedges, 1, 1, 1);
  wedges.Move([](const glm::dvec3& p) { return p + glm::dvec3(1, 0, 0); });
  OwnMesh both;
  for (std::size_t cell = 0; cell < 6; ++cell)
  {
    std::vector<glm::dvec3> p;
    for (const std::int64_t id : mesh.IdsOf(cell))
    {
      p.push_back(mesh.Point(id));
    }
    cell % 2 == 0 ? both.AddCellAt(14, p)
                  : both.AddCellAt(12, { p[0], p[1], p[2], p[3], p[4], p[4], p[4], p[4] });
  }
  for (std::size_t cell = 0; cell < 2; ++cell)
  {
    std::vector<glm::dvec3> p;
    for (const std::int64_t id : wedges.IdsOf(cell))
    {
      p.push_back(wedges.Point(id));
    }
    cell == 0 ? both.AddCellAt(13, p)
              : both.AddCellAt(12, { p[0], p[1], p[2], p[2], p[3], p[4], p[5], p[5] });
  }
  // A tetrahedron as a hexahedron, on one of two tetrahedra.
  const glm::dvec3 a(5, 0, 0);
  const glm::dvec3 b(6, 0, 0);
  const glm::dvec3 c(5, 1, 0);
  const glm::dvec3 up(5, 0, 1);
  const glm::dvec3 down(5, 0, -1);
  both.AddCellAt(10, { a, b, c, down });
  both.AddCellAt(12, { a, b, c, c, up, up, up, up });
  EXPECT_EQ(ExpectAsSlow(both.View()), 5u + 7u + 6u);
}

TEST(BorderFaces, HangingNodesLeaveBothSides)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 2, 2, 2);
  mesh.AddCellAt(12, { { 2, 0, 0 }, { 4, 0, 0 }, { 4, 2, 0 }, { 2, 2, 0 }, { 2, 0, 2 }, { 4, 0, 2 },
                       { 4, 2, 2 }, { 2, 2, 2 } });
  EXPECT_EQ(ExpectAsSlow(mesh.View()), 24u + 6u);
}

TEST(BorderFaces, AQuadrilateralIsNoTriangle)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 1, 1, 1);
  mesh.AddCell(10, { 0, 1, 2, 7 });
  mesh.AddCell(14, { 0, 1, 3, 2, mesh.AddPoint({ 0.5, 0.5, -1 }) });
  EXPECT_EQ(ExpectAsSlow(mesh.View()), 5u + 4u + 4u);
}

TEST(BorderFaces, OfRepeatedCellsTheBorderIsThatOfOne)
{
  for (const int times : { 2, 3, 4, 5 })
  {
    const OwnMesh once = BoxOf(Split::Mixed, 4, 4, 4);
    OwnMesh mesh = once;
    for (int i = 1; i < times; ++i)
    {
      for (std::size_t cell = 0; cell < once.Cells(); ++cell)
      {
        mesh.AddCell(once.Types[cell], once.IdsOf(cell));
      }
    }
    EXPECT_EQ(ExpectAsSlow(mesh.View()), 96u);
  }
}

TEST(BorderFaces, OwnersFarFromEachOtherInTheOrder)
{
  // Pyramids on faces that two cells have, with their tips far away: their middles, and so their
  // places in the order, are, too. One of four is there twice.
  OwnMesh mesh = BoxOf(Split::Hexahedra, 40, 30, 20);
  const std::int64_t tip = mesh.AddPoint({ 300, 290, 280 });
  std::mt19937 random(3);
  for (int i = 0; i < 200; ++i)
  {
    const std::int64_t first = static_cast<std::int64_t>(random() % 40) +
                               41 * (static_cast<std::int64_t>(random() % 30) +
                                      31 * static_cast<std::int64_t>(1 + random() % 19));
    for (int times = i % 4 == 0 ? 2 : 1; times > 0; --times)
    {
      mesh.AddCell(14, { first, first + 1, first + 42, first + 41, tip });
    }
  }
  const Border border = BorderOf(mesh.View());
  EXPECT_EQ(border.Faces, SlowBorder(mesh.View(), border.Order));
  EXPECT_EQ(BorderOf(mesh.View(), 1).Faces, border.Faces);
}

TEST(BorderFaces, CurvilinearGridsHaveTheirSides)
{
  for (const glm::ivec3& size : { glm::ivec3(2, 2, 2), glm::ivec3(9, 2, 5), glm::ivec3(12, 9, 8) })
  {
    OwnMesh mesh = BoxOf(Split::Hexahedra, size.x - 1, size.y - 1, size.z - 1);
    Shake(mesh, 0.2, 1);
    const CellMesh grid = GridOf(mesh, size);
    const std::size_t faces = ExpectAsSlow(grid);
    EXPECT_EQ(
      faces, 2u * static_cast<unsigned>((size.x - 1) * (size.y - 1) + (size.y - 1) * (size.z - 1) +
                                        (size.z - 1) * (size.x - 1)));
    EXPECT_EQ(BorderOf(grid).Faces, BorderOf(mesh.View()).Faces);
  }
}

TEST(BorderFaces, RingsHaveNoSeam)
{
  // Around the axis: x fastest is the angle, then the radius, then the height. From the axis on the
  // innermost faces are none.
  for (const double inner : { 1.0, 0.0 })
  {
    const int around = 16;
    OwnMesh mesh = BoxOf(Split::Hexahedra, around, 3, 4);
    mesh.Move(
      [=](const glm::dvec3& p)
      {
        const double angle = 2.0 * 3.14159265358979 / around * std::fmod(p.x, around);
        return glm::dvec3((inner + p.y) * std::cos(angle), (inner + p.y) * std::sin(angle), p.z);
      });
    const CellMesh grid = GridOf(mesh, { around + 1, 4, 5 });
    const std::size_t mantles = inner > 0.0 ? 2 : 1;
    EXPECT_EQ(ExpectAsSlow(grid), 2u * around * 3 + mantles * around * 4);
    EXPECT_EQ(BorderOf(grid).Faces, BorderOf(mesh.View()).Faces);
  }
}

TEST(BorderFaces, HiddenCellsOfGridsLeaveHoles)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 6, 5, 4);
  Shake(mesh, 0.2, 1);
  CellMesh grid = GridOf(mesh, { 7, 6, 5 });
  std::vector<std::uint8_t> hidden(static_cast<std::size_t>(grid.CellCount));
  grid.Hidden = hidden.data();
  EXPECT_EQ(ExpectAsSlow(grid), 2u * (30 + 20 + 24));
  hidden[1 + 6 * (1 + 5 * 1)] = 1;
  EXPECT_EQ(ExpectAsSlow(grid), 2u * (30 + 20 + 24) + 6);
  hidden[0] = 1;
  EXPECT_EQ(ExpectAsSlow(grid), 2u * (30 + 20 + 24) + 6);
}

TEST(BorderFaces, RectilinearGridsHaveTheirSides)
{
  const std::vector<double> axes[3] = { { 0, 1, 2, 2.5, 3, 5, 9 }, { 7, 6, 5, 3 }, { -1, 0, 2 } };
  CellMesh grid;
  grid.Is = CellMesh::Kind::Rectilinear;
  grid.PointType = ScalarType::Float64;
  grid.Axes = { axes[0].data(), axes[1].data(), axes[2].data() };
  grid.Size = { 7, 4, 3 };
  grid.PointCount = 84;
  grid.CellCount = 36;
  EXPECT_EQ(ExpectAsSlow(grid), 2u * (18 + 6 + 12));
  EXPECT_NEAR(Area(grid, BorderOf(grid)), 2 * (9 * 4 + 4 * 3 + 9 * 3), 1e-12);
  std::vector<std::uint8_t> hidden(36);
  hidden[7] = 1; // it has a face at the end of the third axis
  grid.Hidden = hidden.data();
  EXPECT_EQ(ExpectAsSlow(grid), 2u * (18 + 6 + 12) + 4);
}

TEST(BorderFaces, NoCellsHaveNoBorder)
{
  ThreadPool pool(2);
  const OwnMesh mesh = BoxOf(Split::Hexahedra, 0, 0, 0);
  EXPECT_TRUE(BorderFacesOf(mesh.View(), CheckCells(mesh.View(), pool), {}, pool).empty());
}

} // namespace
