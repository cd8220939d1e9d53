// SPDX-License-Identifier: BSD-3-Clause
// Values of cells at points, against a search through all cells, and on fields that are known.
#include "Mesh/Octree/TinyMeshes.h"

#include "Mesh/Octree/CellNodes.h"

#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace banyan;
using meshes::Cube;

NodeArray ArrayOf(const std::vector<double>& values, int components = 1, int component = 0)
{
  NodeArray array;
  array.Values = values.data();
  array.Type = ScalarType::Float64;
  array.Components = components;
  array.Component = component;
  return array;
}

double Noise(const glm::ivec3& p)
{
  return std::sin(12.9898 * p.x + 78.233 * p.y + 37.719 * p.z) * 10.0;
}

double Linear(const glm::dvec3& p)
{
  return 3.0 + 0.5 * p.x - 0.25 * p.y + 2.0 * p.z;
}

/// The cube of a cell, from its points.
Cube CubeOf(const meshes::OwnMesh<double, std::int64_t>& mesh, std::size_t cell)
{
  glm::ivec3 low(1 << 20), high(-1);
  for (std::size_t corner = 0; corner < 8; ++corner)
  {
    const glm::ivec3 p = mesh.Places[static_cast<std::size_t>(mesh.Ids[8 * cell + corner])];
    low = glm::min(low, p);
    high = glm::max(high, p);
  }
  return { low, static_cast<int>(std::lround(std::log2(high.x - low.x))) };
}

template <class Function>
std::vector<double> OfCells(
  const meshes::OwnMesh<double, std::int64_t>& mesh, const Function& function)
{
  std::vector<double> values;
  for (std::size_t cell = 0; cell < mesh.Ids.size() / 8; ++cell)
  {
    values.push_back(function(CubeOf(mesh, cell)));
  }
  return values;
}

double AtCentre(const Cube& cube)
{
  return Linear(glm::dvec3(cube.Corner) + 0.5 * (1 << cube.Level));
}

bool Touches(const Cube& cube, const glm::ivec3& p)
{
  const int edge = 1 << cube.Level;
  bool touches = true;
  for (int axis = 0; axis < 3; ++axis)
  {
    touches = touches && p[axis] >= cube.Corner[axis] && p[axis] <= cube.Corner[axis] + edge;
  }
  return touches;
}

bool IsCorner(const Cube& cube, const glm::ivec3& p)
{
  const glm::ivec3 in = p - cube.Corner;
  const int edge = 1 << cube.Level;
  return Touches(cube, p) && in.x % edge == 0 && in.y % edge == 0 && in.z % edge == 0;
}

/// The definition, by a search through all cells: points that hang take what the largest cell has.
double Slow(const std::vector<Cube>& cubes, const std::vector<double>& values, const glm::ivec3& p)
{
  const Cube* largest = nullptr;
  double sum = 0.0, weights = 0.0;
  for (std::size_t i = 0; i < cubes.size(); ++i)
  {
    if (!Touches(cubes[i], p))
    {
      continue;
    }
    if (!IsCorner(cubes[i], p))
    {
      largest = largest && largest->Level >= cubes[i].Level ? largest : &cubes[i];
    }
    sum += values[i] / (1 << cubes[i].Level);
    weights += 1.0 / (1 << cubes[i].Level);
  }
  if (!largest)
  {
    return sum / weights;
  }
  double corners[8];
  const int edge = 1 << largest->Level;
  for (int i = 0; i < 8; ++i)
  {
    corners[i] =
      Slow(cubes, values, largest->Corner + edge * glm::ivec3(i & 1, i >> 1 & 1, i >> 2));
  }
  return NodalField::Interpolate(corners, glm::dvec3(p - largest->Corner) / double(edge));
}

std::vector<Cube> WithHoles(std::vector<Cube> cubes)
{
  std::vector<Cube> kept;
  for (std::size_t i = 0; i < cubes.size(); ++i)
  {
    if (i % 7 != 3)
    {
      kept.push_back(cubes[i]);
    }
  }
  return kept;
}

std::vector<std::vector<Cube>> Meshes()
{
  return { meshes::Ball({ 1, 2, 1 }, 3), meshes::Wild({ 2, 1, 1 }, 3, 5),
    WithHoles(meshes::Wild({ 1, 1, 2 }, 3, 8)), { Cube{ { 0, 0, 0 }, 0 } } };
}

/// The same cells, each with points of its own.
meshes::OwnMesh<double, std::int64_t> Apart(const meshes::OwnMesh<double, std::int64_t>& mesh)
{
  meshes::OwnMesh<double, std::int64_t> apart;
  for (std::size_t i = 0; i < mesh.Ids.size(); ++i)
  {
    const auto point = static_cast<std::size_t>(mesh.Ids[i]);
    apart.Ids.push_back(static_cast<std::int64_t>(i));
    apart.Places.push_back(mesh.Places[point]);
    apart.Points.insert(apart.Points.end(), mesh.Points.begin() + 3 * static_cast<long>(point),
      mesh.Points.begin() + 3 * static_cast<long>(point) + 3);
  }
  return apart;
}

class CellNodesTest : public testing::Test
{
protected:
  ThreadPool Pool{ 2 };

  NodalField FieldOf(const meshes::OwnMesh<double, std::int64_t>& mesh,
    const std::vector<double>& values, ValuesOn where = ValuesOn::Cells)
  {
    this->Tree = meshes::Find(mesh.Mesh());
    const CellNodes nodes(*this->Tree, ArrayOf(values), where, this->Pool);
    return { this->Tree, nodes.Nodes(), this->Pool };
  }

  std::shared_ptr<const ElementOctree> Tree;
};

TEST_F(CellNodesTest, AreWeightedMeansOfTheCellsAround)
{
  for (const std::vector<Cube>& cubes : Meshes())
  {
    const auto mesh = meshes::Make(cubes, glm::dvec3(1.0, -2.0, 3.0), glm::dvec3(0.5, 1.0, 2.0), 4);
    const auto values = OfCells(mesh, [](const Cube& cube) { return Noise(cube.Corner); });
    std::vector<Cube> order;
    for (std::size_t cell = 0; cell < values.size(); ++cell)
    {
      order.push_back(CubeOf(mesh, cell));
    }
    const NodalField field = this->FieldOf(mesh, values);
    for (std::size_t point = 0; point < mesh.Places.size(); ++point)
    {
      ASSERT_NEAR(field.AtNode(static_cast<std::int64_t>(point)),
        Slow(order, values, mesh.Places[point]), 1e-11)
        << "point " << point << " of " << cubes.size() << " cells";
    }
  }
}

TEST_F(CellNodesTest, KeepLinearFieldsInsideWhateverTheSizesAre)
{
  const auto near = [](const Cube& cube)
  {
    const double edge = 1 << cube.Level;
    const glm::dvec3 away = glm::dvec3(cube.Corner) + 0.5 * edge - 11.0;
    return cube.Level == 3 || glm::length(away) < 1.8 * edge;
  };
  for (const auto& cubes :
    { meshes::Leaves({ 3, 3, 3 }, 3, near), meshes::Wild({ 3, 3, 3 }, 3, 6) })
  {
    const auto mesh = meshes::Make(cubes, glm::dvec3(0.0), glm::dvec3(1.0), 9);
    const NodalField field = this->FieldOf(mesh, OfCells(mesh, AtCentre));
    ASSERT_EQ(this->Tree->CoarsestLevel(), 2);
    int inside = 0;
    for (std::size_t point = 0; point < mesh.Places.size(); ++point)
    {
      // Points that hang follow corners up to 4 away, which may hang in their turn, but not on
      // cells at the border.
      const glm::ivec3 p = mesh.Places[point];
      if (glm::all(glm::greaterThanEqual(p, glm::ivec3(7))) &&
          glm::all(glm::lessThanEqual(p, glm::ivec3(17))))
      {
        ++inside;
        ASSERT_NEAR(field.AtNode(static_cast<std::int64_t>(point)), Linear(glm::dvec3(p)), 1e-11);
      }
    }
    EXPECT_GT(inside, 100);
  }
}

TEST_F(CellNodesTest, DependNeitherOnTheOrderNorOnSharedPoints)
{
  const std::vector<Cube> cubes = meshes::Wild({ 2, 1, 1 }, 3, 7);
  const auto value = [](const Cube& cube) { return Noise(cube.Corner); };
  const auto mesh = meshes::Make(cubes);
  const NodalField expected = this->FieldOf(mesh, OfCells(mesh, value));
  const auto shuffled = meshes::Make(cubes, glm::dvec3(0.0), glm::dvec3(1.0), 3);
  for (const auto& other : { shuffled, Apart(mesh), Apart(shuffled) })
  {
    const NodalField field = this->FieldOf(other, OfCells(other, value));
    for (const glm::ivec3& p : mesh.Places)
    {
      ASSERT_EQ(field.AtPoint(p), expected.AtPoint(p)); // to the last bit
    }
  }
}

TEST_F(CellNodesTest, OfCornersThatAgreeAreTheirs)
{
  const auto mesh = Apart(meshes::Make(meshes::Ball({ 1, 1, 1 }, 3)));
  const auto values = mesh.Sampled([](const glm::dvec3& p) { return Linear(p); });
  const NodalField field = this->FieldOf(mesh, values, ValuesOn::CellCorners);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    ASSERT_NEAR(field.AtNode(static_cast<std::int64_t>(i)), values[i], 1e-13);
  }
}

TEST_F(CellNodesTest, OfCornersThatDifferAreWeightedMeans)
{
  // Two cells of edge 1 and one of edge 2 (with a hole beside them) meet in (2, 0, 0) and
  // elsewhere.
  const std::vector<Cube> cubes{ { { 0, 0, 0 }, 1 }, { { 2, 0, 0 }, 0 }, { { 3, 0, 0 }, 0 } };
  const auto mesh = Apart(meshes::Make(cubes));
  std::vector<double> values;
  for (std::size_t i = 0; i < mesh.Places.size(); ++i)
  {
    values.push_back(i < 8 ? 10.0 : i < 16 ? 40.0 : 70.0);
  }
  const NodalField field = this->FieldOf(mesh, values, ValuesOn::CellCorners);
  EXPECT_DOUBLE_EQ(field.AtPoint({ 2, 0, 0 }), (10.0 * 0.5 + 40.0) / 1.5);
  EXPECT_DOUBLE_EQ(field.AtPoint({ 3, 1, 0 }), 55.0);
  EXPECT_DOUBLE_EQ(field.AtPoint({ 0, 2, 0 }), 10.0);
}

TEST_F(CellNodesTest, OfVectorsAreMeansOfLengths)
{
  const auto mesh = meshes::Make({ Cube{ { 0, 0, 0 }, 0 }, Cube{ { 1, 0, 0 }, 0 } });
  const std::vector<double> values{ 3.0, 4.0, 0.0, -5.0 };
  const auto tree = meshes::Find(mesh.Mesh());
  const auto at = [&](int component)
  {
    const CellNodes nodes(*tree, ArrayOf(values, 2, component), ValuesOn::Cells, this->Pool);
    return NodalField(tree, nodes.Nodes(), this->Pool).AtPoint({ 1, 0, 0 });
  };
  EXPECT_DOUBLE_EQ(at(NodeArray::Magnitude), 5.0);
  EXPECT_DOUBLE_EQ(at(0), 1.5);
  EXPECT_DOUBLE_EQ(at(1), -0.5);
  EXPECT_THROW(at(2), Error);
}

TEST_F(CellNodesTest, WithoutValueSpreadToTheCorners)
{
  const auto mesh = meshes::Make({ Cube{ { 0, 0, 0 }, 0 }, Cube{ { 1, 0, 0 }, 0 } });
  const NodalField field = this->FieldOf(mesh, { std::nan(""), 1.0 });
  EXPECT_TRUE(std::isnan(field.AtPoint({ 0, 0, 0 })));
  EXPECT_TRUE(std::isnan(field.AtPoint({ 1, 1, 1 })));
  EXPECT_EQ(field.AtPoint({ 2, 0, 0 }), 1.0);
}

TEST_F(CellNodesTest, OfSmallTypesAreFloats)
{
  const auto mesh = meshes::Make({ Cube{ { 0, 0, 0 }, 0 } });
  const auto tree = meshes::Find(mesh.Mesh());
  const std::int16_t value = -7;
  NodeArray array;
  array.Values = &value;
  array.Type = ScalarType::Int16;
  const CellNodes nodes(*tree, array, ValuesOn::Cells, this->Pool);
  EXPECT_EQ(nodes.Nodes().Type, ScalarType::Float32);
  EXPECT_EQ(static_cast<const float*>(nodes.Nodes().Values)[3], -7.0f);
}

} // namespace
