// SPDX-License-Identifier: BSD-3-Clause
// Cells of a mesh as leaves of trees: the same cells, in as few trees as wanted.
#include "Mesh/Series/StoredMeshes.h"

#include "Mesh/Series/MeanOfChildren.h"
#include "Mesh/Series/MeshLevel.h"
#include "Mesh/Series/TreeCells.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <tuple>

namespace
{

using namespace banyan;
using meshes::Cube;

using Leaf = std::tuple<int, int, int, int>;

std::vector<Cube> Moved(std::vector<Cube> cubes, const glm::ivec3& by)
{
  for (Cube& cube : cubes)
  {
    cube.Corner += by;
  }
  return cubes;
}

std::set<Leaf> LeavesOf(const TreeCells& cells)
{
  std::set<Leaf> leaves;
  for (std::size_t i = 0; i < cells.Leaves.Keys.size(); ++i)
  {
    const glm::ivec3 at = PositionOfKey(cells.Leaves.Keys[i]);
    leaves.insert({ at.x, at.y, at.z, cells.Leaves.Levels[i] });
  }
  return leaves;
}

/// Each leaf lies in one tree of the grid, in order, with its own points at the corners.
void Check(const StoredMesh& mesh, const TreeCells& cells)
{
  ASSERT_EQ(cells.Corners.size(), 8 * cells.Leaves.Keys.size());
  const auto* points = reinterpret_cast<const double*>(mesh.Points.data());
  for (std::size_t i = 0; i < cells.Leaves.Keys.size(); ++i)
  {
    const glm::ivec3 at = PositionOfKey(cells.Leaves.Keys[i]);
    const int edge = 1 << cells.Leaves.Levels[i];
    ASSERT_LE(cells.Leaves.Levels[i], cells.RootLevel);
    ASSERT_TRUE(i == 0 || cells.Leaves.Keys[i - 1] < cells.Leaves.Keys[i]);
    const glm::ivec3 root = at / (1 << cells.RootLevel);
    for (int axis = 0; axis < 3; ++axis)
    {
      ASSERT_GE(root[axis], cells.FirstRoot[axis]);
      ASSERT_LT(root[axis], cells.FirstRoot[axis] + cells.Roots[axis]);
      for (int corner = 0; corner < 8; ++corner)
      {
        const auto point = cells.Corners[8 * i + static_cast<std::size_t>(corner)];
        const int place = at[axis] + edge * (corner >> axis & 1);
        ASSERT_DOUBLE_EQ(points[3 * point + axis], mesh.Origin[axis] + place * mesh.Edge[axis]);
      }
    }
  }
}

TEST(TreeCellsTest, AreTheCellsOfTheMesh)
{
  for (const std::vector<Cube>& cubes :
    { meshes::Ball({ 2, 1, 1 }, 3), meshes::WithHoles(meshes::Wild({ 1, 2, 1 }, 3, 4)),
      Moved(meshes::Wild({ 1, 1, 1 }, 2, 4), { 4, 8, 12 }) })
  {
    const auto made = meshes::Make(cubes, glm::dvec3(1, 2, 3), glm::dvec3(0.5, 1.0, 0.25), 6);
    const auto mesh = meshes::Store(made.Mesh());
    const TreeCells cells = TreeCellsOf(*mesh, 0);
    Check(*mesh, cells);
    std::set<Leaf> expected;
    const glm::ivec3 zero =
      glm::ivec3(glm::round((glm::dvec3(1, 2, 3) - mesh->Origin) / mesh->Edge));
    for (const Cube& cube : cubes)
    {
      const glm::ivec3 at = cube.Corner + zero;
      expected.insert({ at.x, at.y, at.z, cube.Level });
    }
    EXPECT_EQ(LeavesOf(cells), expected);
  }
}

TEST(TreeCellsTest, OfCoarserMeshesAreTheirs)
{
  const auto made = meshes::Make(meshes::WithHoles(meshes::Wild({ 2, 1, 1 }, 3, 2)));
  const auto mesh = meshes::Store(made.Mesh());
  for (const int level : { 1, 2, 3 })
  {
    const TreeCells cells = TreeCellsOf(*mesh, level);
    Check(*mesh, cells);
    EXPECT_EQ(cells.Corners, CoarserCells(*mesh, level).Connectivity);
  }
}

TEST(TreeCellsTest, AreInLargeTreesWhereTheMeshEndsWithThem)
{
  // 16 x 16 x 16 cells of one size: trees of 4 cells along an axis are 64.
  const auto whole = meshes::Make(meshes::Leaves({ 2, 2, 2 }, 3, [](const Cube&) { return true; }));
  const TreeCells large = TreeCellsOf(*meshes::Store(whole.Mesh()), 0);
  EXPECT_EQ(large.RootLevel, 2);
  EXPECT_EQ(large.Roots, glm::ivec3(4));
  // 17 cells along an axis end within any larger cube.
  std::vector<Cube> cubes;
  for (int i = 0; i < 17 * 17 * 17; ++i)
  {
    cubes.push_back({ glm::ivec3(i % 17, i / 17 % 17, i / 289), 0 });
  }
  const auto odd = meshes::Make(cubes);
  const TreeCells small = TreeCellsOf(*meshes::Store(odd.Mesh()), 0);
  EXPECT_EQ(small.RootLevel, 0);
  EXPECT_EQ(small.Roots, glm::ivec3(17));
  // A mesh that ends within the cube of its largest cell, which lies inside.
  std::vector<Cube> ragged = { { { 2, 2, 2 }, 1 } };
  for (int x = 1; x < 6; ++x)
  {
    ragged.push_back({ { x, 1, 1 }, 0 });
  }
  const auto made = meshes::Make(ragged);
  const auto mesh = meshes::Store(made.Mesh());
  const TreeCells part = TreeCellsOf(*mesh, 0);
  EXPECT_EQ(part.RootLevel, 1);
  Check(*mesh, part);
}

TEST(TreeCellsTest, ValuesAtCentresAreMeansOfCorners)
{
  const double corners[8] = { 1, 2, 3, 4, 5, 6, 7, 9 };
  EXPECT_EQ(ValueAtCentre(corners, FillSet<double>({})), 37.0 / 8.0);
  EXPECT_EQ(ValueAtCentre(corners, FillSet<double>({ -1.0, 7.0 })), 7.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double special[8] = { 1, 2, 3, nan, 5, 6, 7, 9 };
  EXPECT_TRUE(std::isnan(ValueAtCentre(special, FillSet<double>({}))));
  const std::int8_t bytes[8] = { 127, 127, 127, 127, 127, 127, 127, 126 };
  EXPECT_EQ(ValueAtCentre(bytes, FillSet<std::int8_t>({})), 126.875);
  const double most = std::numeric_limits<double>::max();
  const double large[8] = { most, most, most, most, most, most, most, most };
  EXPECT_EQ(ValueAtCentre(large, FillSet<double>({})), most);
  bool fill = true;
  (void)ValueAtCentre(large, FillSet<double>({ -1.0 }), &fill);
  EXPECT_FALSE(fill);
  (void)ValueAtCentre(large, FillSet<double>({ most }), &fill);
  EXPECT_TRUE(fill);
}

TEST(TreeCellsTest, CoarseCellsHaveTheMeanOfTheirs)
{
  const double most = std::numeric_limits<double>::max();
  MeanOfChildren none;
  EXPECT_EQ(none.Value(), 0.0);
  for (int count = 1; count <= 8; ++count)
  {
    MeanOfChildren mean, large;
    double sum = 0.0;
    for (int i = 0; i < count; ++i)
    {
      mean.Add(0.1 * i * i, false);
      large.Add(-most, false);
      sum += 0.1 * i * i;
    }
    EXPECT_EQ(mean.Value(), sum / count); // to the bit: eighths change no digit
    EXPECT_FALSE(mean.IsFill());
    EXPECT_NEAR(large.Value() / -most, 1.0, 1e-15) << count;
    mean.Add(-9999.0, true);
    mean.Add(1.0, false);
    EXPECT_EQ(mean.Value(), -9999.0);
    EXPECT_TRUE(mean.IsFill());
    mean.Add(-1.0, true);
    EXPECT_EQ(mean.Value(), -1.0);
  }
  MeanOfChildren nan;
  nan.Add(std::numeric_limits<double>::quiet_NaN(), false);
  nan.Add(1.0, false);
  EXPECT_TRUE(std::isnan(nan.Value()));
}

} // namespace
