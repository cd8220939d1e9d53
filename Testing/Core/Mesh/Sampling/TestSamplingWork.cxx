// SPDX-License-Identifier: BSD-3-Clause
// What finding the boxes of a mesh spares, shows and lets be stopped.
#include "Mesh/Sampling/WarpedMeshes.h"

#include "Mesh/Sampling/CellShapes.h"

#include <gtest/gtest.h>

#include <thread>

namespace
{

using namespace banyan;
using warped::Mesh;

std::vector<Mesh> Meshes()
{
  Mesh tangled = warped::Grid({ 4, 3, 3 }, warped::Bent);
  std::swap(tangled.IdAt(6, 0), tangled.IdAt(6, 1));
  return { warped::Grid({ 5, 4, 4 }, warped::Warp({ 5, 4, 4 })),
    warped::Grid({ 8, 2, 3 }, warped::Bent), warped::Grid({ 3, 3, 3 }, warped::Graded), tangled };
}

TEST(CellHull, HoldsAllOfTheCell)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> part(-1e-6, 1.0 + 1e-6);
  for (const Mesh& mesh : Meshes())
  {
    ThreadPool pool(1);
    const CellShapes shapes(mesh.Mesh(), 3, pool);
    for (std::int64_t cell = 0; cell < shapes.Count(); ++cell)
    {
      for (int i = 0; i < 200; ++i)
      {
        glm::dvec3 at(part(random), part(random), part(random));
        at[i % 3] = i % 2 == 0 ? std::round(at[i % 3]) : at[i % 3]; // faces are the worst
        EXPECT_TRUE(shapes.MayHold(cell, shapes.Shape(cell).At(at))) << cell;
      }
    }
  }
}

TEST(CellHull, SparesMostOfWhatIsOutside)
{
  std::mt19937 random(4);
  std::uniform_real_distribution<double> part(0.0, 1.0);
  const Mesh mesh = warped::Grid({ 8, 2, 3 }, warped::Bent);
  ThreadPool pool(1);
  const CellShapes shapes(mesh.Mesh(), 3, pool);
  int outside = 0;
  int spared = 0;
  for (std::int64_t cell = 0; cell < shapes.Count(); ++cell)
  {
    const glm::dvec3 size = shapes.High(cell) - shapes.Low(cell);
    for (int i = 0; i < 200; ++i)
    {
      const glm::dvec3 point =
        shapes.Low(cell) + size * glm::dvec3(part(random), part(random), part(random));
      glm::dvec3 place(0.5);
      const bool inside = shapes.Shape(cell).Find(point, place) &&
                          glm::all(glm::lessThanEqual(glm::abs(place - 0.5), glm::dvec3(0.5)));
      outside += inside ? 0 : 1;
      spared += shapes.MayHold(cell, point) ? 0 : 1;
      EXPECT_TRUE(!inside || shapes.MayHold(cell, point)) << cell;
    }
  }
  EXPECT_GT(outside, 1000);
  EXPECT_GT(spared, 0.8 * outside);
}

TEST(SamplingWork, ProgressGrowsToItsEnd)
{
  const Mesh mesh = warped::Grid({ 6, 5, 4 }, warped::Bent);
  for (const std::int64_t most : { 5000, 1 << 20 })
  {
    const std::thread::id caller = std::this_thread::get_id();
    std::vector<double> parts;
    MeshSampling sampling;
    sampling.MostCubes = most;
    sampling.Watch = [&](double part)
    {
      EXPECT_EQ(std::this_thread::get_id(), caller);
      parts.push_back(part);
      return true;
    };
    const auto watched = warped::Sample(mesh, sampling, 3);
    ASSERT_GT(parts.size(), 5u);
    EXPECT_GE(parts.front(), 0.0);
    EXPECT_TRUE(std::is_sorted(parts.begin(), parts.end()));
    EXPECT_LE(parts[parts.size() - 2], 0.9);
    EXPECT_EQ(parts.back(), 1.0);
    sampling.Watch = nullptr;
    EXPECT_EQ(warped::Sample(mesh, sampling, 3)->Boxes().CellCount, watched->Boxes().CellCount);
  }
}

TEST(SamplingWork, IsStoppedAtOnce)
{
  const Mesh mesh = warped::Grid({ 6, 5, 4 }, warped::Bent);
  for (const int last : { 1, 4, 9 })
  {
    int calls = 0;
    MeshSampling sampling;
    sampling.Watch = [&](double) { return ++calls < last; };
    EXPECT_THROW(warped::Sample(mesh, sampling, 2), Interruption);
    EXPECT_EQ(calls, last);
  }
}

} // namespace
