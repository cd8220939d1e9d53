// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CellOrder.h"

#include "Base/Error.h"
#include "Base/Morton.h"
#include "Base/ThreadPool.h"
#include "Cells/CellsTesting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace
{

using namespace banyan;

std::vector<std::uint32_t> OrderOf(const CellMesh& mesh, int threads = 2)
{
  ThreadPool pool(threads);
  const CellFacts facts = CheckCells(mesh, pool);
  return OrderOfCells(mesh, facts, LatticeOf(ExtentOf(mesh, facts, pool)), pool);
}

/// Where the corners of all cells are, in the order of cells.
std::vector<std::vector<std::array<double, 3>>> Sequence(const CellMesh& mesh, int threads)
{
  std::vector<std::vector<std::array<double, 3>>> sequence;
  for (const std::uint32_t cell : OrderOf(mesh, threads))
  {
    sequence.push_back(CornersAt(mesh, cell));
  }
  return sequence;
}

TEST(CellOrder, FollowsTheMortonCurve)
{
  const OwnMesh mesh = BoxOf(Split::Hexahedra, 13, 8, 6);
  std::vector<std::uint32_t> expected(mesh.Cells());
  std::iota(expected.begin(), expected.end(), 0u);
  const auto key = [](std::uint32_t i)
  { return KeyOf(glm::ivec3(i % 13, i / 13 % 8, i / 13 / 8)); };
  std::sort(expected.begin(), expected.end(),
    [&](std::uint32_t a, std::uint32_t b) { return key(a) < key(b); });
  EXPECT_EQ(OrderOf(mesh.View()), expected);
  // Whatever its unit is, and wherever it lies.
  for (const double scale : { 0x1p-20, 0x1p20 })
  {
    OwnMesh other = mesh;
    other.Move([&](const glm::dvec3& p) { return p * scale; });
    EXPECT_EQ(OrderOf(other.View()), expected) << scale;
  }
  OwnMesh far = mesh;
  far.Move([&](const glm::dvec3& p) { return p + 1e7; });
  const CellLattice lattice{ glm::dvec3(1e7), 1.0, glm::ivec3(13, 8, 6) };
  ThreadPool pool(1);
  EXPECT_EQ(OrderOfCells(far.View(), CheckCells(far.View(), pool), lattice, pool), expected);
}

TEST(CellOrder, NumberingAndThreadsDoNotMatter)
{
  for (const Split split : { Split::Hexahedra, Split::Wedges, Split::Tetrahedra, Split::Mixed })
  {
    OwnMesh mesh = BoxOf(split, 19, 17, 18);
    Shake(mesh, 0.2, 11);
    const auto sequence = Sequence(mesh.View(), 1);
    ASSERT_EQ(sequence.size(), mesh.Cells());
    for (const unsigned seed : { 1u, 2u, 3u })
    {
      EXPECT_EQ(Sequence(Shuffled(mesh, seed).View(), static_cast<int>(2 * seed)), sequence);
    }
  }
}

TEST(CellOrder, CellsWithOneKeyAreParted)
{
  // A box of tiny cells in a wide mesh: all of them have the same key, and no middle tells them
  // apart. Others agree in the bits that are sorted by first.
  for (const double scale : { 1e-12, 1e-5, 1e-3 })
  {
    OwnMesh mesh = BoxOf(Split::Tetrahedra, 6, 6, 6);
    mesh.Move([scale](const glm::dvec3& p) { return p * scale + 2.25; });
    const OwnMesh wide = BoxOf(Split::Hexahedra, 12, 11, 10);
    for (std::size_t cell = 0; cell < wide.Cells(); ++cell)
    {
      std::vector<glm::dvec3> corners;
      for (const std::int64_t id : wide.IdsOf(cell))
      {
        corners.push_back(wide.Point(id));
      }
      mesh.AddCellAt(12, corners);
    }
    const auto sequence = Sequence(mesh.View(), 1);
    ASSERT_EQ(sequence.size(), mesh.Cells());
    EXPECT_EQ(Sequence(Shuffled(mesh, 5).View(), 3), sequence) << scale;
    EXPECT_EQ(Sequence(Shuffled(mesh, 6).View(), 1), sequence) << scale;
  }
}

TEST(CellOrder, CornersInAnotherOrderDoNotMatter)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 9, 9, 9);
  Shake(mesh, 0.3, 2);
  OwnMesh turned = mesh;
  for (std::size_t cell = 0; cell < mesh.Cells(); ++cell)
  {
    // A quarter of a turn, and upside down.
    const std::vector<std::int64_t> ids = mesh.IdsOf(cell);
    const int turn[8] = { 5, 4, 7, 6, 1, 0, 3, 2 };
    for (std::size_t i = 0; i < 8; ++i)
    {
      turned.Ids[8 * cell + i] = ids[static_cast<std::size_t>(turn[i])];
    }
  }
  EXPECT_EQ(OrderOf(turned.View()), OrderOf(mesh.View()));
}

TEST(CellOrder, OfDuplicatesTheLastCounts)
{
  OwnMesh mesh = BoxOf(Split::Mixed, 5, 5, 5);
  const std::vector<std::uint32_t> once = OrderOf(mesh.View());
  const std::size_t cells = mesh.Cells();
  for (std::size_t cell = 0; cell < cells; ++cell)
  {
    mesh.AddCell(mesh.Types[cell], mesh.IdsOf(cell));
  }
  const std::vector<std::uint32_t> order = OrderOf(mesh.View());
  ASSERT_EQ(order.size(), once.size());
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    EXPECT_EQ(order[i], once[i] + cells);
  }
}

TEST(CellOrder, HasDrawnCellsAlone)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 30, 30, 30);
  std::vector<std::uint8_t> hidden(mesh.Cells());
  for (std::size_t cell = 0; cell < hidden.size(); ++cell)
  {
    hidden[cell] = cell % 7 == 3 || (cell > 17000 && cell < 22000) ? 1 : 0;
  }
  mesh.Types[100] = 3;
  CellMesh view = mesh.View();
  view.Hidden = hidden.data();
  std::vector<std::uint32_t> expected;
  for (const std::uint32_t cell : OrderOf(mesh.View()))
  {
    if (hidden[cell] == 0 && cell != 100)
    {
      expected.push_back(cell);
    }
  }
  EXPECT_EQ(OrderOf(view, 3), expected);
}

TEST(CellOrder, GridsAreInTheOrderOfTheirCells)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 7, 6, 9);
  std::vector<float> points;
  Shake(mesh, 0.2, 7);
  mesh.Move([](const glm::dvec3& p) { return glm::dvec3(glm::vec<3, float>(p)); });
  std::copy(mesh.Points.begin(), mesh.Points.end(), std::back_inserter(points));
  CellMesh grid;
  grid.Is = CellMesh::Kind::Curvilinear;
  grid.Points = points.data();
  grid.Size = { 8, 7, 10 };
  grid.PointCount = mesh.View().PointCount;
  grid.CellCount = mesh.View().CellCount;
  EXPECT_EQ(OrderOf(grid), OrderOf(mesh.View()));

  const std::vector<double> axes[3] = { { 0, 1, 2, 2.5, 3, 5, 9, 10 }, { 7, 6, 5, 3, 2, 1, 0.5 },
    { 0, 1, 2, 3, 4, 5, 6, 7, 8, 9 } };
  OwnMesh boxes = BoxOf(Split::Hexahedra, 7, 6, 9);
  boxes.Move(
    [&](const glm::dvec3& p)
    {
      return glm::dvec3(axes[0][static_cast<std::size_t>(p.x)],
        axes[1][static_cast<std::size_t>(p.y)], axes[2][static_cast<std::size_t>(p.z)]);
    });
  grid.Is = CellMesh::Kind::Rectilinear;
  grid.PointType = ScalarType::Float64;
  grid.Axes = { axes[0].data(), axes[1].data(), axes[2].data() };
  EXPECT_EQ(OrderOf(grid), OrderOf(boxes.View()));
}

TEST(CellOrder, RefusesMoreCellsThanItCanNumber)
{
  CellMesh mesh;
  mesh.CellCount = std::int64_t{ 1 } << 32;
  ThreadPool pool(1);
  EXPECT_THROW(OrderOfCells(mesh, {}, {}, pool), Error);
}

} // namespace
