// SPDX-License-Identifier: BSD-3-Clause
// Points at one place: whatever they are called, and in whatever order cells come, a mesh is
// sampled alike.
#include "Mesh/Sampling/OneNumberPerPlace.h"
#include "Mesh/Sampling/WarpedMeshes.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <tuple>

namespace
{

using namespace banyan;
using warped::Mesh;

/// The same mesh with cells in another order, and eight points for each if they are `apart`.
Mesh Reordered(const Mesh& mesh, unsigned seed, bool apart)
{
  std::vector<std::size_t> order(mesh.Ids.size() / 8);
  for (std::size_t i = 0; i < order.size(); ++i)
  {
    order[i] = i;
  }
  std::mt19937 random(seed);
  if (seed != 0)
  {
    std::shuffle(order.begin(), order.end(), random);
  }
  Mesh made = mesh;
  made.Ids.clear();
  for (const std::size_t cell : order)
  {
    made.Ids.insert(made.Ids.end(), mesh.Ids.begin() + static_cast<std::ptrdiff_t>(8 * cell),
      mesh.Ids.begin() + static_cast<std::ptrdiff_t>(8 * cell + 8));
  }
  if (apart)
  {
    made.Points.clear();
    for (std::int64_t& id : made.Ids)
    {
      const glm::dvec3 point = mesh.PointAt(static_cast<std::size_t>(id));
      id = static_cast<std::int64_t>(made.Points.size() / 3);
      made.Points.insert(made.Points.end(), { point.x, point.y, point.z });
    }
  }
  return made;
}

using Values = std::map<std::tuple<double, double, double>, double>;

/// What a mesh is sampled as: values at the points of boxes.
Values Sampled(const Mesh& mesh, std::int64_t& boxes)
{
  ThreadPool pool(2);
  MeshSampling sampling;
  sampling.Tolerance = 0.5;
  sampling.MostCubes = 20000;
  const auto sampled = SampledMesh::Of(OneNumberPerPlace(mesh.Mesh(), pool), sampling, pool);
  boxes = sampled->Boxes().CellCount;
  std::vector<double> field;
  for (std::size_t i = 0; i < mesh.Points.size() / 3; ++i)
  {
    const glm::dvec3 p = mesh.PointAt(i);
    field.push_back(std::sin(5.0 * p.x) * std::cos(4.0 * p.y) + 0.3 * p.z);
  }
  NodeArray array;
  array.Values = field.data();
  array.Type = ScalarType::Float64;
  const SampledMesh::Values values = sampled->Sample(array, pool);
  Values result;
  const auto* points = static_cast<const glm::dvec3*>(sampled->Boxes().Points);
  for (std::size_t i = 0; i < values.Doubles.size(); ++i)
  {
    // Origins are rounded in another way.
    const glm::dvec3 place = glm::round(points[i] * 1e9);
    result[{ place.x + 0.0, place.y + 0.0, place.z + 0.0 }] = values.Doubles[i];
  }
  return result;
}

TEST(OneNumberPerPlace, CellsWithPointsOfTheirOwnInAnyOrderAreSampledAlike)
{
  for (const Mesh& mesh : { warped::Grid({ 5, 3, 4 }, warped::Bent),
         warped::Grid({ 5, 5, 4 }, warped::Mountain), warped::Grid({ 6, 5, 7 }, warped::Graded) })
  {
    std::int64_t expectedBoxes = 0;
    const Values expected = Sampled(mesh, expectedBoxes);
    for (const unsigned seed : { 0u, 1u, 2u })
    {
      for (const bool apart : { false, true })
      {
        std::int64_t boxes = 0;
        const Values values = Sampled(Reordered(mesh, seed, apart), boxes);
        ASSERT_EQ(boxes, expectedBoxes) << "order " << seed << ", apart: " << apart;
        ASSERT_EQ(values.size(), expected.size());
        for (const auto& value : expected)
        {
          const auto found = values.find(value.first);
          ASSERT_TRUE(found != values.end());
          ASSERT_NEAR(found->second, value.second, 1e-9) << "order " << seed;
        }
      }
    }
  }
}

TEST(OneNumberPerPlace, TheLowestNumberCounts)
{
  ThreadPool pool(1);
  meshes::OwnMesh<float, std::int32_t> mesh;
  for (const float zero : { 0.0f, -0.0f })
  {
    for (int i = 0; i < 8; ++i)
    {
      mesh.Ids.push_back(static_cast<std::int32_t>(mesh.Points.size() / 3));
      mesh.Points.insert(mesh.Points.end(),
        { (i & 1) != 0 ? 1.0f : zero, (i & 2) != 0 ? 1.0f : zero, (i & 4) != 0 ? 1.0f : zero });
    }
  }
  const HexMesh one = OneNumberPerPlace(mesh.Mesh(), pool);
  const auto* ids = static_cast<const std::int32_t*>(one.Connectivity);
  for (int i = 0; i < 16; ++i)
  {
    EXPECT_EQ(ids[i], i % 8);
  }
  EXPECT_EQ(one.PointCount, 16) << "values stay where they are";
  mesh.Ids[3] = 16;
  EXPECT_THROW(OneNumberPerPlace(mesh.Mesh(), pool), Error);
}

TEST(OneNumberPerPlace, AMeshWithoutSuchPointsIsHandedBack)
{
  ThreadPool pool(2);
  const Mesh mesh = warped::Grid({ 4, 3, 2 }, warped::Bent);
  const HexMesh given = mesh.Mesh();
  EXPECT_EQ(OneNumberPerPlace(given, pool).Connectivity, given.Connectivity);
}

} // namespace
