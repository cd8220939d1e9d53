// SPDX-License-Identifier: BSD-3-Clause
// Meshes of general hexahedra as boxes of an octree.
#include "Mesh/Sampling/WarpedMeshes.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <limits>

namespace
{

using namespace banyan;
using warped::Mesh;

struct Shape
{
  const char* Name;
  Mesh Cells;
};

std::vector<Shape> Shapes()
{
  return { { "warped", warped::Grid({ 5, 4, 4 }, warped::Warp({ 5, 4, 4 })) },
    { "graded, in any order", warped::Grid({ 6, 5, 7 }, warped::Graded, 5) },
    { "bent", warped::Grid({ 8, 5, 4 }, warped::Bent) },
    { "a mountain", warped::Grid({ 7, 7, 6 }, warped::Mountain) } };
}

std::vector<double> Linear(const Mesh& mesh)
{
  std::vector<double> values;
  for (std::size_t i = 0; i < mesh.Points.size() / 3; ++i)
  {
    const glm::dvec3 p = mesh.PointAt(i);
    values.push_back(0.3 + 0.5 * p.x - 0.25 * p.y + 0.125 * p.z);
  }
  return values;
}

std::vector<double> Noise(const Mesh& mesh)
{
  std::mt19937 random(7);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::vector<double> values(mesh.Points.size() / 3);
  for (double& value : values)
  {
    value = part(random);
  }
  return values;
}

NodeArray ArrayOf(const std::vector<double>& values)
{
  NodeArray array;
  array.Values = values.data();
  array.Type = ScalarType::Float64;
  return array;
}

glm::dvec3 BoxPoint(const SampledMesh& sampled, std::int64_t point)
{
  return static_cast<const glm::dvec3*>(sampled.Boxes().Points)[point];
}

double VolumeOf(const SampledMesh& sampled)
{
  double volume = 0.0;
  const auto* ids = static_cast<const std::int32_t*>(sampled.Boxes().Connectivity);
  for (std::int64_t box = 0; box < sampled.Boxes().CellCount; ++box)
  {
    const glm::dvec3 size = BoxPoint(sampled, ids[8 * box + 7]) - BoxPoint(sampled, ids[8 * box]);
    volume += size.x * size.y * size.z;
  }
  return volume;
}

/// By the divergence theorem's discrete cousin: many small parts of each cell.
double VolumeOf(const CellShapes& shapes)
{
  double volume = 0.0;
  constexpr int parts = 6;
  for (std::int64_t cell = 0; cell < shapes.Count(); ++cell)
  {
    const TrilinearCell& shape = shapes.Shape(cell);
    for (int i = 0; i < parts * parts * parts; ++i)
    {
      const glm::dvec3 part =
        (glm::dvec3(i % parts, i / parts % parts, i / parts / parts) + 0.5) / double(parts);
      volume += std::abs(glm::determinant(shape.JacobianAt(part))) / (parts * parts * parts);
    }
  }
  return volume * shapes.Edge().x * shapes.Edge().y * shapes.Edge().z;
}

TEST(TrilinearCell, PlacesAreFoundAgain)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  std::uniform_real_distribution<double> off(-0.25, 0.25);
  for (int trial = 0; trial < 200; ++trial)
  {
    std::array<glm::dvec3, 8> corners;
    for (int corner = 0; corner < 8; ++corner)
    {
      corners[static_cast<std::size_t>(corner)] =
        glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2) +
        glm::dvec3(off(random), off(random), off(random));
    }
    const TrilinearCell cell(corners);
    const glm::dvec3 at(part(random), part(random), part(random));
    glm::dvec3 found(0.5);
    ASSERT_TRUE(cell.Find(cell.At(at), found)) << trial;
    EXPECT_LT(glm::length(found - at), 1e-9) << trial;
  }
}

TEST(SampledMesh, BoxesAreAnOctree)
{
  for (const Shape& shape : Shapes())
  {
    const auto sampled = warped::Sample(shape.Cells);
    const auto tree = meshes::Find(sampled->Boxes());
    EXPECT_EQ(tree->LeafCount(), sampled->Boxes().CellCount) << shape.Name;
  }
}

/// Points of boxes that lie in the mesh have the value of the mesh there.
TEST(SampledMesh, PointsHaveTheValuesOfTheMesh)
{
  for (const Shape& shape : Shapes())
  {
    ThreadPool pool(2);
    const CellShapes shapes(shape.Cells.Mesh(), MeshSampling::FinestPart, pool);
    const std::vector<double> values = Noise(shape.Cells);
    const auto sampled = warped::Sample(shape.Cells);
    const SampledMesh::Values boxes = sampled->Sample(ArrayOf(values), pool);
    ASSERT_EQ(boxes.Doubles.size(), static_cast<std::size_t>(sampled->Boxes().PointCount));
    std::int64_t inside = 0;
    for (std::int64_t point = 0; point < sampled->Boxes().PointCount; point += 17)
    {
      double expected;
      if (warped::SlowValue(shapes, values, BoxPoint(*sampled, point), expected))
      {
        ++inside;
        EXPECT_NEAR(boxes.Doubles[static_cast<std::size_t>(point)], expected, 1e-5)
          << shape.Name << " point " << point;
      }
    }
    EXPECT_GT(inside, sampled->Boxes().PointCount / 50) << shape.Name;
  }
}

/// The promise of CubeDeviation: between the points of boxes the drawn field differs by no more
/// than the deviation times the spread of all values.
TEST(SampledMesh, FieldsStayWithinTheDeviation)
{
  for (const Shape& shape : Shapes())
  {
    for (const double tolerance : { 0.5, 0.3 })
    {
      MeshSampling sampling;
      sampling.Tolerance = tolerance;
      ThreadPool pool(2);
      const CellShapes shapes(shape.Cells.Mesh(), MeshSampling::FinestPart, pool);
      const std::vector<double> values = Noise(shape.Cells);
      const auto sampled = warped::Sample(shape.Cells, sampling);
      const SampledMesh::Values boxes = sampled->Sample(ArrayOf(values), pool);
      const auto* ids = static_cast<const std::int32_t*>(sampled->Boxes().Connectivity);
      double worst = 0.0;
      for (std::int64_t box = 0; box < sampled->Boxes().CellCount; box += 31)
      {
        double corners[8];
        for (int corner = 0; corner < 8; ++corner)
        {
          corners[corner] = boxes.Doubles[static_cast<std::size_t>(ids[8 * box + corner])];
        }
        const glm::dvec3 low = BoxPoint(*sampled, ids[8 * box]);
        const glm::dvec3 high = BoxPoint(*sampled, ids[8 * box + 7]);
        for (int i = 0; i < 27; ++i)
        {
          const glm::dvec3 part = 0.5 * glm::dvec3(i % 3, i / 3 % 3, i / 9);
          double expected;
          if (warped::SlowValue(shapes, values, low + part * (high - low), expected, 0.0))
          {
            worst = std::max(worst, std::abs(NodalField::Interpolate(corners, part) - expected));
          }
        }
      }
      EXPECT_LE(worst, sampled->Deviation() + 1e-6) << shape.Name << " " << tolerance;
      EXPECT_GT(worst, 0.0) << shape.Name;
      // Beside cells that are much thinner than long not everything can be had.
      EXPECT_LE(sampled->AboveTolerance(), sampled->Boxes().CellCount / 1000) << shape.Name;
      EXPECT_EQ(sampled->AboveTolerance() == 0, sampled->Deviation() <= tolerance) << shape.Name;
    }
  }
}

TEST(SampledMesh, BoxesFillTheMesh)
{
  for (const Shape& shape : Shapes())
  {
    ThreadPool pool(2);
    const CellShapes shapes(shape.Cells.Mesh(), MeshSampling::FinestPart, pool);
    const double expected = VolumeOf(shapes);
    EXPECT_NEAR(VolumeOf(*warped::Sample(shape.Cells)), expected, 0.02 * expected) << shape.Name;
  }
}

/// Linear fields are those of the mesh everywhere but in boxes at the border.
TEST(SampledMesh, LinearFieldsAreExact)
{
  for (const Shape& shape : Shapes())
  {
    ThreadPool pool(2);
    const CellShapes shapes(shape.Cells.Mesh(), MeshSampling::FinestPart, pool);
    const std::vector<double> values = Linear(shape.Cells);
    const auto sampled = warped::Sample(shape.Cells);
    const SampledMesh::Values boxes = sampled->Sample(ArrayOf(values), pool);
    for (std::int64_t point = 0; point < sampled->Boxes().PointCount; point += 29)
    {
      double inside;
      const glm::dvec3 p = BoxPoint(*sampled, point);
      if (warped::SlowValue(shapes, values, p, inside))
      {
        const double expected = 0.3 + 0.5 * p.x - 0.25 * p.y + 0.125 * p.z;
        EXPECT_NEAR(boxes.Doubles[static_cast<std::size_t>(point)], expected, 1e-6) << shape.Name;
      }
    }
  }
}

TEST(SampledMesh, ThreadsChangeNothing)
{
  const Mesh mesh = warped::Grid({ 6, 5, 4 }, warped::Bent);
  const auto one = warped::Sample(mesh, {}, 1);
  const auto three = warped::Sample(mesh, {}, 3);
  ASSERT_EQ(one->Boxes().CellCount, three->Boxes().CellCount);
  ThreadPool pool(3);
  const std::vector<double> values = Noise(mesh);
  EXPECT_EQ(
    one->Sample(ArrayOf(values), pool).Doubles, three->Sample(ArrayOf(values), pool).Doubles);
}

TEST(SampledMesh, LimitsOfBoxesAreKept)
{
  const Mesh mesh = warped::Grid({ 6, 5, 4 }, warped::Bent);
  MeshSampling sampling;
  sampling.MostCubes = 5000;
  const auto few = warped::Sample(mesh, sampling);
  EXPECT_LE(few->Boxes().CellCount, 5000);
  EXPECT_GT(few->AboveTolerance(), 0);
  EXPECT_GT(few->KeptCoarse(), 0);
  EXPECT_EQ(warped::Sample(mesh)->KeptCoarse(), 0);
  EXPECT_GT(few->Deviation(), sampling.Tolerance);
  sampling.MostCubes = 2;
  EXPECT_THROW(warped::Sample(mesh, sampling), Error);
}

TEST(SampledMesh, AxisAlignedBoxesTakeNoMoreThanTheyNeed)
{
  // Of one size: a box for each cell is exact.
  const auto sampled =
    warped::Sample(warped::Grid({ 10, 6, 5 }, [](const glm::dvec3& p) { return p * 3.0; }));
  EXPECT_EQ(sampled->Boxes().CellCount, 300);
  EXPECT_LT(sampled->Deviation(), 1e-6);
}

TEST(SampledMesh, BadMeshesAreRefused)
{
  const auto refusal = [](const Mesh& mesh)
  {
    try
    {
      warped::Sample(mesh);
      return std::string("sampled");
    }
    catch (const Error& error)
    {
      return std::string(error.what());
    }
  };
  const Mesh good = warped::Grid({ 3, 3, 3 }, warped::Bent);
  Mesh mesh = good;
  mesh.IdAt(5, 2) = 999;
  EXPECT_NE(refusal(mesh).find("Cell 5 refers to point 999"), std::string::npos) << refusal(mesh);
  mesh = good;
  mesh.Points[3 * static_cast<std::size_t>(mesh.IdAt(4, 0))] =
    std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(refusal(mesh).find("not finite"), std::string::npos) << refusal(mesh);
  mesh = good;
  for (std::size_t corner = 4; corner < 8; ++corner)
  {
    mesh.IdAt(7, corner) = mesh.IdAt(7, corner - 4);
  }
  EXPECT_NE(refusal(mesh).find("Cell 7"), std::string::npos) << refusal(mesh);
  mesh.Ids.clear();
  EXPECT_NE(refusal(mesh).find("no cells"), std::string::npos) << refusal(mesh);
}

TEST(SampledMesh, TangledCellsAreCounted)
{
  Mesh mesh = warped::Grid({ 4, 3, 3 }, warped::Bent);
  std::swap(mesh.IdAt(6, 0), mesh.IdAt(6, 1));
  const auto sampled = warped::Sample(mesh);
  EXPECT_EQ(sampled->TangledCells(), 1);
  EXPECT_EQ(sampled->FirstTangledCell(), 6);
  // Mirrored cells are as good as others.
  mesh = warped::Grid(
    { 4, 3, 3 }, [](const glm::dvec3& p) { return warped::Bent(p) * glm::dvec3(-1.0, 1.0, 1.0); });
  EXPECT_EQ(warped::Sample(mesh)->TangledCells(), 0);
}

TEST(SampledMesh, MagnitudesAndComponents)
{
  const Mesh mesh = warped::Grid({ 4, 3, 3 }, warped::Graded);
  const auto sampled = warped::Sample(mesh);
  std::vector<float> vectors;
  for (std::size_t i = 0; i < mesh.Points.size() / 3; ++i)
  {
    vectors.insert(vectors.end(), { 3.0f, -4.0f, 12.0f });
  }
  NodeArray array;
  array.Values = vectors.data();
  array.Components = 3;
  ThreadPool pool(2);
  for (const auto& [component, expected] :
    { std::pair{ 0, 3.0f }, { 1, -4.0f }, { NodeArray::Magnitude, 13.0f } })
  {
    array.Component = component;
    const SampledMesh::Values values = sampled->Sample(array, pool);
    ASSERT_FALSE(values.Floats.empty());
    EXPECT_NEAR(*std::min_element(values.Floats.begin(), values.Floats.end()), expected, 1e-6);
    EXPECT_NEAR(*std::max_element(values.Floats.begin(), values.Floats.end()), expected, 1e-6);
  }
  array.Component = 3;
  EXPECT_THROW(sampled->Sample(array, pool), Error);
}

} // namespace
