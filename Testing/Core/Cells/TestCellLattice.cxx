// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CellLattice.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Cells/CellsTesting.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace banyan;

CellLattice LatticeAround(const CellMesh& mesh, int threads = 2)
{
  ThreadPool pool(threads);
  return LatticeOf(ExtentOf(mesh, CheckCells(mesh, pool), pool));
}

bool IsPowerOfTwo(double x)
{
  int exponent = 0;
  return std::frexp(x, &exponent) == 0.5;
}

/// All that a lattice promises.
void ExpectAround(const CellLattice& lattice, const OwnMesh& mesh)
{
  EXPECT_TRUE(IsPowerOfTwo(lattice.Edge)) << lattice.Edge;
  glm::dvec3 low(1e300);
  for (std::size_t i = 0; i < mesh.Points.size() / 3; ++i)
  {
    const glm::dvec3 p = mesh.Point(static_cast<std::int64_t>(i));
    low = glm::min(low, p);
    const glm::dvec3 at = lattice.ToLattice(p);
    for (int axis = 0; axis < 3; ++axis)
    {
      ASSERT_GE(at[axis], 0.0);
      ASSERT_LE(at[axis], lattice.Size[axis]);
    }
    const glm::dvec3 back = lattice.ToWorld(at);
    ASSERT_LE(glm::length(back - p), 1e-15 * (glm::length(p) + lattice.Edge * 1e6));
  }
  for (int axis = 0; axis < 3; ++axis)
  {
    EXPECT_EQ(std::floor(lattice.Origin[axis] / lattice.Edge), lattice.Origin[axis] / lattice.Edge);
    EXPECT_LT(low[axis] - lattice.Origin[axis], lattice.Edge);
    EXPECT_GE(lattice.Size[axis], 1);
    EXPECT_LE(lattice.Size[axis], CellLattice::MostEdges);
  }
}

TEST(CellLattice, TakesThePowerOfTwoNextToTheMedian)
{
  // Between 2^(k - 1/2) and 2^(k + 1/2).
  for (const double edge : { 1.0, 0.75, 1.4, 1.42, 3.0, 2.8, 2.83, 1e-6, 1e6, 1e-100, 1e100 })
  {
    OwnMesh mesh = BoxOf(Split::Hexahedra, 5, 4, 3);
    mesh.Move([edge](const glm::dvec3& p) { return p * edge; });
    const CellLattice lattice = LatticeAround(mesh.View());
    EXPECT_EQ(lattice.Edge, std::exp2(std::round(std::log2(edge)))) << edge;
    ExpectAround(lattice, mesh);
  }
}

TEST(CellLattice, FewLongCellsDoNotMatter)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 8, 8, 8);
  mesh.Move([](const glm::dvec3& p) { return glm::dvec3(p.x > 7.5 ? 1000.0 : p.x, p.y, p.z); });
  const CellLattice lattice = LatticeAround(mesh.View());
  EXPECT_EQ(lattice.Edge, 1.0);
  EXPECT_EQ(lattice.Size, glm::ivec3(1000, 8, 8));
}

TEST(CellLattice, CollapsedEdgesDoNotMatter)
{
  // A tetrahedron as a hexahedron: five edges have no length, one is short, and six are long.
  OwnMesh mesh;
  const glm::dvec3 c(0, 0.9, 0);
  const glm::dvec3 up(0, 0, 1);
  mesh.AddCellAt(12, { { 0, 0, 0 }, { 1.0 / 16, 0, 0 }, c, c, up, up, up, up });
  EXPECT_EQ(LatticeAround(mesh.View()).Edge, 1.0);
}

TEST(CellLattice, FollowsMeshesAnywhere)
{
  for (const Split split : { Split::Hexahedra, Split::Wedges, Split::Pyramids, Split::Tetrahedra })
  {
    for (const double scale : { 1e-6, 1.0, 1e6 })
    {
      for (const double moved : { 0.0, -0.3, 1e7, -1e7 })
      {
        OwnMesh mesh = BoxOf(split, 6, 5, 4);
        Shake(mesh, 0.2, 3);
        mesh.Move([=](const glm::dvec3& p) { return (p + moved) * scale; });
        const CellLattice lattice = LatticeAround(mesh.View());
        ExpectAround(lattice, mesh);
        // Cubes split otherwise have other edges, but none twice as long.
        EXPECT_GT(lattice.Edge, 0.5 * scale);
        EXPECT_LT(lattice.Edge, 2.0 * scale);
        EXPECT_GE(lattice.Size.x, 3);
        EXPECT_LE(lattice.Size.x, 14);
      }
    }
  }
}

TEST(CellLattice, HasNoMoreEdgesThanItMay)
{
  // Tiny cells all around, and one far away.
  OwnMesh mesh = BoxOf(Split::Hexahedra, 4, 4, 4);
  mesh.AddCellAt(10, { { 3e6, 0, 0 }, { 3e6 + 1, 0, 0 }, { 3e6, 1, 0 }, { 3e6, 0, 1 } });
  const CellLattice lattice = LatticeAround(mesh.View());
  EXPECT_EQ(lattice.Edge, 4.0);
  ExpectAround(lattice, mesh);
  OwnMesh wide = BoxOf(Split::Hexahedra, 4, 4, 4);
  wide.AddCellAt(
    10, { { -1e150, 0, 0 }, { -1e150, 1e148, 0 }, { -1e150, 0, 1e148 }, { 1e150, 0, 0 } });
  ExpectAround(LatticeAround(wide.View()), wide);
  // Exactly as many as allowed.
  OwnMesh full = BoxOf(Split::Hexahedra, 4, 4, 4);
  const double last = CellLattice::MostEdges;
  full.AddCellAt(
    10, { { last, 0, 0 }, { last - 1, 0, 0 }, { last - 1, 1, 0 }, { last - 1, 0, 1 } });
  EXPECT_EQ(LatticeAround(full.View()).Edge, 1.0);
  EXPECT_EQ(LatticeAround(full.View()).Size.x, CellLattice::MostEdges);
}

TEST(CellLattice, PointsOfCellsThatAreNotDrawnDoNotMatter)
{
  OwnMesh mesh = BoxOf(Split::Tetrahedra, 2, 2, 2);
  const CellLattice alone = LatticeAround(mesh.View());
  mesh.AddPoint({ 1e6, 1e6, 1e6 });
  mesh.AddCellAt(10, { { 50, 0, 0 }, { 60, 0, 0 }, { 50, 60, 0 }, { 60, 60, 0 } });
  mesh.AddCellAt(9, { { 80, 0, 0 }, { 90, 0, 0 }, { 80, 70, 0 }, { 60, 60, 3 } });
  mesh.AddCellAt(10, { { NAN, 0, 0 }, { 60, 0, 0 }, { 50, 60, 0 }, { 60, 60, 0 } });
  mesh.AddCellAt(10, { { 100, 0, 0 }, { 101, 0, 0 }, { 100, 1, 0 }, { 100, 0, 1 } });
  std::vector<std::uint8_t> hidden(mesh.Cells());
  hidden.back() = 1;
  CellMesh view = mesh.View();
  view.Hidden = hidden.data();
  const CellLattice lattice = LatticeAround(view);
  EXPECT_EQ(lattice.Origin, alone.Origin);
  EXPECT_EQ(lattice.Edge, alone.Edge);
  EXPECT_EQ(lattice.Size, alone.Size);
}

TEST(CellLattice, OrderThreadsAndPiecesDoNotMatter)
{
  OwnMesh mesh = BoxOf(Split::Mixed, 30, 30, 29);
  Shake(mesh, 0.3, 8);
  mesh.Move([](const glm::dvec3& p) { return p * (1.0 + 0.01 * p.x * p.x); });
  const CellLattice lattice = LatticeAround(mesh.View(), 1);
  const OwnMesh shuffled = Shuffled(mesh, 4);
  ThreadPool pool(3);
  CellMesh piece = shuffled.View();
  const auto half = static_cast<std::size_t>(piece.CellCount / 3);
  piece.CellCount = static_cast<std::int64_t>(half);
  CellExtent pieces = ExtentOf(piece, CheckCells(piece, pool), pool);
  piece = shuffled.View();
  piece.CellCount -= static_cast<std::int64_t>(half);
  piece.Offsets = shuffled.Offsets.data() + half;
  piece.Types += half;
  pieces.Include(ExtentOf(piece, CheckCells(piece, pool), pool));
  for (const CellLattice& other : { LatticeAround(shuffled.View(), 5), LatticeOf(pieces) })
  {
    EXPECT_EQ(other.Origin, lattice.Origin);
    EXPECT_EQ(other.Edge, lattice.Edge);
    EXPECT_EQ(other.Size, lattice.Size);
  }
}

TEST(CellLattice, IsAnEdgeThickAtLeast)
{
  CellExtent flat;
  flat.Low = { 0, 0, 3 };
  flat.High = { 5, 0.5, 3 };
  flat.Edges[static_cast<std::size_t>(-CellExtent::LowestExponent)] = 1;
  EXPECT_EQ(LatticeOf(flat).Size, glm::ivec3(5, 1, 1));
}

TEST(CellLattice, SaysThatNothingCanBeDrawn)
{
  OwnMesh mesh;
  EXPECT_THROW(LatticeAround(mesh.View()), Error);
  mesh.AddCellAt(10, { { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 }, { 0, 0, 0 } });
  EXPECT_THROW(LatticeAround(mesh.View()), Error);
  // The thinnest cell is enough.
  mesh.AddCellAt(10, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1e-12 } });
  EXPECT_EQ(LatticeAround(mesh.View()).Size, glm::ivec3(1));
}

} // namespace
