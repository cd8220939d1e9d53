// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CheckMesh.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Cells/CellsTesting.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>

namespace
{

using namespace banyan;

CellFacts Check(const CellMesh& mesh, int threads = 2)
{
  ThreadPool pool(threads);
  return CheckCells(mesh, pool);
}

std::int64_t Of(const CellFacts& facts, CellShape shape)
{
  return facts.PerShape[static_cast<std::size_t>(shape)];
}

TEST(CheckMesh, CountsShapes)
{
  const CellFacts facts = Check(BoxOf(Split::Mixed, 3, 3, 2).View());
  EXPECT_EQ(Of(facts, CellShape::Hexahedron), 12);
  EXPECT_EQ(Of(facts, CellShape::Pyramid), 36);
  EXPECT_EQ(facts.Drawn(), 48);
  EXPECT_TRUE(facts.LeftOut.empty());
  EXPECT_TRUE(facts.Remarks().empty());
  EXPECT_EQ(Of(Check(BoxOf(Split::Wedges, 2, 2, 2).View()), CellShape::Wedge), 16);
  EXPECT_EQ(Of(Check(BoxOf(Split::Tetrahedra, 2, 2, 2).View()), CellShape::Tetrahedron), 48);
}

TEST(CheckMesh, RefusesPointsThatAreNotThere)
{
  OwnMesh mesh = BoxOf(Split::Tetrahedra, 20, 20, 20);
  const std::int64_t points = static_cast<std::int64_t>(mesh.Points.size() / 3);
  mesh.Ids[4 * 30000 + 2] = -1;
  mesh.Ids[4 * 20000 + 3] = points;
  mesh.Ids[4 * 40000] = std::numeric_limits<std::int64_t>::max();
  for (const int threads : { 1, 4 })
  {
    try
    {
      Check(mesh.View(), threads);
      FAIL();
    }
    catch (const Error& error)
    {
      EXPECT_EQ(std::string(error.what()), "Cell 20000 refers to point " + std::to_string(points) +
                                             ", and the mesh has " + std::to_string(points) +
                                             " points");
    }
  }
  // What is hidden may refer to anything.
  std::vector<std::uint8_t> hidden(mesh.Cells());
  hidden[20000] = hidden[30000] = hidden[40000] = 1;
  CellMesh view = mesh.View();
  view.Hidden = hidden.data();
  EXPECT_EQ(Check(view).Drawn(), view.CellCount - 3);
  // Each is found by itself.
  for (const std::size_t cell : { 20000u, 30000u, 40000u })
  {
    hidden[cell] = 0;
    EXPECT_THROW(Check(view), Error) << cell;
    hidden[cell] = 1;
  }
}

TEST(CheckMesh, LeavesOutWhatCannotBeComputed)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 3, 1, 1);
  const double inf = std::numeric_limits<double>::infinity();
  for (const double bad : { double(NAN), inf, -inf, 1.1e150, -1e200 })
  {
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      OwnMesh broken = mesh;
      broken.Points[3 * 15 + axis] = bad; // the last corner of cell 2
      const CellFacts facts = Check(broken.View());
      EXPECT_EQ(facts.NotFinite.Count, 1);
      EXPECT_EQ(facts.NotFinite.First, 2);
      EXPECT_EQ(facts.Drawn(), 2);
      EXPECT_TRUE(facts.Draws(0) && facts.Draws(1) && !facts.Draws(2));
      ASSERT_EQ(facts.Remarks().size(), 1u);
    }
  }
  mesh.Move([](const glm::dvec3& p) { return p * 1e149; });
  EXPECT_EQ(Check(mesh.View()).Drawn(), 3);
  mesh.Move([](const glm::dvec3& p) { return p * 1e-149 * 1e-149; });
  EXPECT_EQ(Check(mesh.View()).Drawn(), 3);
}

TEST(CheckMesh, NamesTypesThatAreNotDrawn)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 1, 1, 1);
  mesh.AddCell(5, { 0, 1, 2 });
  mesh.AddCell(3, { 0, 1 });
  mesh.AddCell(0, {});
  const CellFacts facts = Check(mesh.View());
  EXPECT_EQ(facts.OtherTypes.Count, 3);
  EXPECT_EQ(facts.OtherTypes.First, 1);
  EXPECT_EQ(facts.FirstOtherType, 5);
  ASSERT_EQ(facts.Remarks().size(), 1u);
  EXPECT_EQ(facts.Remarks()[0],
    "3 cells, the first of which is 1, are left out: type 5 of VTK is not drawn");
}

TEST(CheckMesh, CountsPointsThatTypesHave)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 1, 1, 1);
  mesh.AddCell(12, { 0, 1, 2, 3, 4, 5, 6 });
  CellFacts facts = Check(mesh.View());
  EXPECT_EQ(facts.OtherCounts.Count, 1);
  EXPECT_EQ(facts.OtherTypes.Count, 0);
  EXPECT_EQ(facts.Drawn(), 1);
  ASSERT_EQ(facts.Remarks().size(), 1u);
  EXPECT_EQ(facts.Remarks()[0], "Cell 1 is left out: it has 7 points in place of 8");
  mesh.AddCell(10, { 0, 1, 2 });
  mesh.AddCell(14, { 0, 1, 2, 3, 4, 5 });
  mesh.AddCell(13, {});
  mesh.AddCell(22, { 0, 1, 2 });
  facts = Check(mesh.View());
  EXPECT_EQ(facts.OtherCounts.Count, 4);
  EXPECT_EQ(facts.OtherTypes.Count, 1);
  ASSERT_EQ(facts.Remarks().size(), 2u);
  EXPECT_EQ(facts.Remarks()[1],
    "4 cells, the first of which is 1, are left out: that one has 7 points in place of 8");
  // All cells of a list without offsets.
  const OwnMesh box = BoxOf(Split::Hexahedra, 2, 1, 1);
  CellMesh view = box.View();
  view.Offsets = nullptr;
  view.PerCell = 6;
  facts = Check(view);
  EXPECT_EQ(facts.OtherCounts.Count, 2);
  EXPECT_EQ(facts.FirstCount, 6);
  EXPECT_EQ(facts.FirstCorners, 8);
}

TEST(CheckMesh, FactsDoNotDependOnThreads)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 40, 40, 40);
  for (const std::size_t cell : { 63999u, 50000u, 33333u, 20001u })
  {
    mesh.Types[cell] = static_cast<std::uint8_t>(cell % 7); // none that is drawn
  }
  for (const std::size_t cell : { 60001u, 21001u })
  {
    mesh.Types[cell] = static_cast<std::uint8_t>(cell > 30000 ? 10 : 13); // with 8 points
  }
  for (const int threads : { 1, 2, 7 })
  {
    const CellFacts facts = Check(mesh.View(), threads);
    EXPECT_EQ(facts.OtherTypes.Count, 4);
    EXPECT_EQ(facts.OtherTypes.First, 20001);
    EXPECT_EQ(facts.FirstOtherType, 20001 % 7);
    EXPECT_EQ(facts.OtherCounts.First, 21001);
    EXPECT_EQ(facts.FirstCorners, 6);
    EXPECT_EQ(facts.Drawn(), 64000 - 6);
  }
}

/// One cell of each shape, whose corners p -> f(p).
void ForShapes(const std::function<glm::dvec3(const glm::dvec3&)>& f,
  const std::function<void(const CellMesh&, CellShape)>& look)
{
  for (const Split split :
    { Split::Hexahedra, Split::Voxels, Split::Wedges, Split::Pyramids, Split::Tetrahedra })
  {
    OwnMesh mesh = BoxOf(split, 1, 1, 1);
    mesh.Move(f);
    look(mesh.View(), mesh.View().Cell(0).Shape);
  }
}

TEST(CheckMesh, LeavesOutFlatCells)
{
  const glm::dvec3 a(0.3, 0.5, 0.7);
  const glm::dvec3 b(-0.1, 0.9, 0.2);
  const std::function<glm::dvec3(const glm::dvec3&)> flats[] = { [](const glm::dvec3& p)
    { return glm::dvec3(p.x, p.y, 0); },
    [](const glm::dvec3& p) { return glm::dvec3(7, p.y + p.x / 3, p.z); },
    [&](const glm::dvec3& p) { return p.x * a + p.y * b + p.z * (a + b) / 3.0; },
    [&](const glm::dvec3& p) { return a * 1e5 + p.x * a + p.y * b + p.z * (a + b) / 3.0; },
    [&](const glm::dvec3& p) { return p.x * a; }, [&](const glm::dvec3&) { return a; } };
  for (const auto& flat : flats)
  {
    ForShapes(flat,
      [](const CellMesh& mesh, CellShape shape)
      {
        const CellFacts facts = Check(mesh);
        EXPECT_EQ(facts.WithoutVolume.Count, mesh.CellCount) << static_cast<int>(shape);
        EXPECT_EQ(facts.Drawn(), 0);
        EXPECT_EQ(facts.Folded.Count, 0);
      });
  }
}

TEST(CheckMesh, DrawsThinMirroredSmallAndFarCells)
{
  const std::function<glm::dvec3(const glm::dvec3&)> good[] = { [](const glm::dvec3& p)
    { return glm::dvec3(p.x, p.y, 1e-6 * p.z); },
    [](const glm::dvec3& p) { return glm::dvec3(p.x, 1e-6 * p.y, 1e-6 * p.z + p.x); },
    [](const glm::dvec3& p) { return glm::dvec3(-p.x, p.y, p.z); },
    [](const glm::dvec3& p) { return p * 1e-6; }, [](const glm::dvec3& p) { return p * 1e6; },
    [](const glm::dvec3& p) { return p + 1e7; },
    [](const glm::dvec3& p) { return glm::dvec3(p.x + 1e7, p.y, p.z * 1e-3); } };
  for (const auto& f : good)
  {
    ForShapes(f,
      [](const CellMesh& mesh, CellShape shape)
      {
        const CellFacts facts = Check(mesh);
        EXPECT_EQ(Of(facts, shape), mesh.CellCount) << static_cast<int>(shape);
        EXPECT_TRUE(facts.Remarks().empty());
      });
  }
}

TEST(CheckMesh, DrawsCollapsedHexahedra)
{
  const OwnMesh box = BoxOf(Split::Hexahedra, 1, 1, 1);
  const std::vector<std::int64_t> whole = box.IdsOf(0);
  const auto collapsed = [&](std::initializer_list<std::pair<int, int>> onto)
  {
    OwnMesh mesh = box;
    mesh.Ids = whole;
    for (const auto& [from, to] : onto)
    {
      mesh.Ids[static_cast<std::size_t>(from)] = whole[static_cast<std::size_t>(to)];
    }
    return Check(mesh.View());
  };
  // To a wedge, a pyramid, a tetrahedron; and to one whose opposite edges are collapsed faces: the
  // determinant is zero at all eight corners.
  EXPECT_EQ(Of(collapsed({ { 3, 2 }, { 7, 6 } }), CellShape::Hexahedron), 1);
  EXPECT_EQ(Of(collapsed({ { 5, 4 }, { 6, 4 }, { 7, 4 } }), CellShape::Hexahedron), 1);
  EXPECT_EQ(Of(collapsed({ { 3, 2 }, { 5, 4 }, { 6, 4 }, { 7, 4 } }), CellShape::Hexahedron), 1);
  EXPECT_EQ(Of(collapsed({ { 3, 0 }, { 2, 1 }, { 5, 4 }, { 6, 7 } }), CellShape::Hexahedron), 1);
  // To a face.
  EXPECT_EQ(collapsed({ { 4, 0 }, { 5, 1 }, { 6, 2 }, { 7, 3 } }).WithoutVolume.Count, 1);
}

TEST(CheckMesh, FindsFoldedCells)
{
  const auto folded = [](Split split, std::size_t point, const glm::dvec3& to)
  {
    OwnMesh mesh = BoxOf(split, 1, 1, 1);
    std::copy_n(&to.x, 3, mesh.Points.data() + 3 * point);
    return Check(mesh.View());
  };
  const CellFacts hexahedron = folded(Split::Hexahedra, 7, { 0.2, 0.2, 0.2 });
  EXPECT_EQ(hexahedron.Folded.Count, 1);
  EXPECT_EQ(hexahedron.Folded.First, 0);
  EXPECT_EQ(hexahedron.Drawn(), 1);
  EXPECT_EQ(hexahedron.Remarks().size(), 1u);
  EXPECT_EQ(folded(Split::Hexahedra, 7, { 0.8, 0.8, 0.8 }).Folded.Count, 0);
  // Both wedges have corner 7, which goes below their other triangle.
  EXPECT_EQ(folded(Split::Wedges, 7, { 1, 1, -0.5 }).Folded.Count, 2);
  // The base of the pyramid above is an arrowhead; that beside it only bends.
  EXPECT_GT(folded(Split::Pyramids, 7, { 0.3, 0.3, 1 }).Folded.Count, 0);
  EXPECT_EQ(folded(Split::Tetrahedra, 7, { 0.2, 0.2, 0.2 }).Folded.Count, 0);
}

TEST(CheckMesh, HiddenCellsAreNotCounted)
{
  OwnMesh mesh = BoxOf(Split::Hexahedra, 4, 1, 1);
  mesh.Types[1] = 9;
  const std::vector<std::uint8_t> hidden{ 0, 1, 8, 0 };
  CellMesh view = mesh.View();
  view.Hidden = hidden.data();
  const CellFacts facts = Check(view);
  EXPECT_EQ(facts.Drawn(), 2);
  EXPECT_TRUE(facts.Remarks().empty());
  EXPECT_TRUE(facts.Draws(0) && !facts.Draws(1) && !facts.Draws(2) && facts.Draws(3));
}

TEST(CheckMesh, RefusesListsThatAreNotThere)
{
  const auto refused = [](const CellMesh& mesh)
  {
    try
    {
      Check(mesh);
      return std::string();
    }
    catch (const Error& error)
    {
      return std::string(error.what());
    }
  };
  const OwnMesh good = BoxOf(Split::Hexahedra, 4, 1, 1);
  EXPECT_EQ(refused(good.View()), "");
  OwnMesh mesh = good;
  mesh.Offsets[3] += 1; // cell 2 has nine points, and cell 3 seven
  EXPECT_EQ(Check(mesh.View()).OtherCounts.Count, 2);
  mesh = good;
  mesh.Offsets[4] = 1000;
  EXPECT_EQ(refused(mesh.View()),
    "Cell 3 has its points from number 24 to 1000 of the connectivity, which has 32");
  mesh = good;
  mesh.Offsets[2] = -5;
  EXPECT_NE(
    refused(mesh.View()).find("Cell 1 has its points from number 8 to -5"), std::string::npos);
  CellMesh view = good.View();
  view.Offsets = nullptr;
  view.PerCell = 8;
  EXPECT_EQ(refused(view), "");
  view.ConnectivityCount = 31;
  EXPECT_NE(refused(view).find("Cell 3 has its points from number 24 to 32"), std::string::npos);
}

TEST(CheckMesh, RefusesGridsOfOtherSizes)
{
  const std::vector<double> axis{ 0, 1, 2 };
  CellMesh grid;
  grid.Is = CellMesh::Kind::Rectilinear;
  grid.PointType = ScalarType::Float64;
  grid.Axes = { axis.data(), axis.data(), axis.data() };
  grid.Size = { 3, 3, 3 };
  grid.PointCount = 27;
  grid.CellCount = 8;
  EXPECT_EQ(Of(Check(grid), CellShape::Hexahedron), 8);
  grid.CellCount = 9;
  EXPECT_THROW(Check(grid), Error);
  grid.Size = { 3, 3, 1 };
  grid.PointCount = 9;
  grid.CellCount = 0;
  EXPECT_THROW(Check(grid), Error);
}

} // namespace
