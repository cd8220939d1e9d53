// SPDX-License-Identifier: BSD-3-Clause
// Points in the same place are one.
#include "Base/ThreadPool.h"
#include "Cells/DrawnMesh.h"
#include "Cells/PointTwins.h"
#include "Render/Cells/PointMeans.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;
using namespace cellmeshes;

std::vector<PointTwin> TwinsOneByOne(const CellMesh& mesh)
{
  std::vector<PointTwin> twins;
  for (std::int64_t point = 0; point < mesh.PointCount; ++point)
  {
    std::int64_t first = 0;
    while (mesh.Point(first) != mesh.Point(point))
    {
      ++first;
    }
    if (first != point)
    {
      twins.push_back({ point, first });
    }
  }
  return twins;
}

std::vector<PointTwin> TwinsFound(const OwnedCellMesh& mesh, int threads)
{
  ThreadPool pool(threads);
  return TwinsOf(mesh.View(), pool);
}

TEST(PointTwins, AreAllThatThereAre)
{
  OwnedCellMesh mesh = Cube(4, Cut::Mixed, { 0.05, 0.05 });
  EXPECT_TRUE(TwinsFound(mesh, 2).empty());
  SeparatePoints(mesh);
  Shuffle(mesh);
  const std::vector<PointTwin> twins = TwinsOneByOne(mesh.View());
  EXPECT_GT(twins.size(), 500u);
  for (const int threads : { 1, 2, 5 })
  {
    EXPECT_EQ(TwinsFound(mesh, threads), twins) << threads;
  }
  std::size_t known = 0;
  for (std::int64_t point = 0; point < mesh.PointCount(); ++point)
  {
    const bool isTwin = known < twins.size() && twins[known].Point == point;
    EXPECT_EQ(FirstAt(twins, point), isTwin ? twins[known].First : point);
    known += isTwin ? 1 : 0;
  }
  EXPECT_TRUE(TwinsFound(OwnedCellMesh(), 2).empty());
}

TEST(PointTwins, BothZerosAreOne)
{
  OwnedCellMesh mesh = OneCell(CellShape::Tetrahedron);
  mesh.Points = { 0.0, 0.0, 0.0, 1.0, 0.0, -0.0, 1.0, -0.0, 0.0, 0.0, 0.0, 1.0 };
  EXPECT_EQ(TwinsFound(mesh, 1), std::vector<PointTwin>({ { 2, 1 } }));
}

TEST(PointTwins, GridsThatCloseHaveThem)
{
  OwnedCellMesh ring = Sector({ 2, 6, 3 });
  const std::size_t row = 3;
  for (std::size_t z = 0; z < 4; ++z)
  {
    for (std::size_t i = 0; i < 3 * row; ++i)
    {
      const std::size_t slice = 3 * row * 7 * z;
      ring.Points[slice + 3 * row * 6 + i] = ring.Points[slice + i];
    }
  }
  const std::vector<PointTwin> twins = TwinsFound(ring, 2);
  EXPECT_EQ(twins.size(), 4 * row);
  EXPECT_EQ(twins, TwinsOneByOne(ring.View()));
}

/// Cells whose points are their own have the gradients and means of those that share them.
TEST(PointTwins, MeansOfCellsAreThoseOfSharedPoints)
{
  OwnedCellMesh shared = Cube(4, Cut::Mixed, { 0.05, 0.05 });
  SetValues(shared, StandardField());
  OwnedCellMesh separate = shared;
  SeparatePoints(separate);
  std::vector<float> ofCells(static_cast<std::size_t>(shared.CellCount()));
  for (std::size_t cell = 0; cell < ofCells.size(); ++cell)
  {
    ofCells[cell] = shared.Values[static_cast<std::size_t>(shared.Ids[4 * cell])];
  }
  const DrawnMesh one(shared);
  const DrawnMesh other(separate);
  for (const int threads : { 1, 3 })
  {
    ThreadPool pool(threads);
    const std::vector<float> means = PointMeans(*one.Field.Cells, ofCells, pool);
    const std::vector<float> gradients = PointGradients(*one.Field.Cells, shared.Values, pool);
    const std::vector<float> separateMeans = PointMeans(*other.Field.Cells, ofCells, pool);
    const std::vector<float> separateGradients =
      PointGradients(*other.Field.Cells, separate.Values, pool);
    ASSERT_EQ(separateMeans.size(), shared.Ids.size());
    for (std::size_t i = 0; i < shared.Ids.size(); ++i)
    {
      const auto point = static_cast<std::size_t>(shared.Ids[i]);
      ASSERT_EQ(separateMeans[i], means[point]);
      for (std::size_t axis = 0; axis < 3; ++axis)
      {
        ASSERT_EQ(separateGradients[3 * i + axis], gradients[3 * point + axis]);
      }
    }
  }
}

} // namespace
