// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/TinyMeshes.h"

#include "Mesh/Octree/HexBrickSource.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>

namespace
{

using namespace banyan;
using meshes::Cube;

NodeArray ArrayOf(const std::vector<double>& values)
{
  NodeArray array;
  array.Values = values.data();
  array.Type = ScalarType::Float64;
  return array;
}

double Wavy(const glm::dvec3& p)
{
  return std::sin(0.7 * p.x) + std::cos(0.4 * p.y + 0.3 * p.z) + 0.1 * p.z;
}

double Trilinear(const glm::dvec3& p)
{
  return 1.0 + 0.5 * p.x - 0.25 * p.y * p.z + 0.125 * p.x * p.y * p.z + p.z;
}

/// At a place inside of a leaf, by the element alone.
double InLeaf(const NodalField& field, std::int64_t leaf, const glm::dvec3& place)
{
  double corners[8];
  field.CornersOf(leaf, corners);
  const glm::dvec3 in = place - glm::dvec3(field.Tree().CornerOfLeaf(leaf));
  return NodalField::Interpolate(corners, in / double(1 << field.Tree().LevelOfLeaf(leaf)));
}

/// At a place inside of a brick, by its samples alone.
double InBrick(const BrickView& view, const HexBrick& brick, const glm::dvec3& place)
{
  const glm::dvec3 at = place / double(1 << brick.Level) - glm::dvec3(brick.Cells.Lo);
  const glm::ivec3 cell =
    glm::clamp(glm::ivec3(glm::floor(at)), glm::ivec3(0), brick.Cells.Size() - 1);
  double corners[8];
  for (int i = 0; i < 8; ++i)
  {
    const glm::ivec3 p = cell + glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
    corners[i] = static_cast<const double*>(
      view.Values)[p.x * view.Stride[0] + p.y * view.Stride[1] + p.z * view.Stride[2]];
  }
  return NodalField::Interpolate(corners, at - glm::dvec3(cell));
}

class HexBricksTest : public testing::Test
{
protected:
  ThreadPool Pool{ 2 };

  struct Case
  {
    meshes::OwnMesh<double, std::int64_t> Mesh;
    std::shared_ptr<const ElementOctree> Tree;
    std::shared_ptr<const HexBricks> Bricks;
  };

  Case Made(const std::vector<Cube>& cubes, int edge = 8)
  {
    Case made;
    made.Mesh = meshes::Make(cubes, glm::dvec3(0.0), glm::dvec3(1.0), 3);
    made.Tree = meshes::Find(made.Mesh.Mesh());
    made.Bricks = std::make_shared<const HexBricks>(made.Tree, edge);
    return made;
  }

  /// Meshes with and without balance and holes.
  std::vector<std::vector<Cube>> Cubes() const
  {
    std::vector<std::vector<Cube>> all{ meshes::Ball({ 2, 1, 1 }, 5),
      meshes::Wild({ 1, 1, 2 }, 5, 4),
      meshes::Leaves({ 5, 3, 2 }, 1, [](const Cube&) { return true; }) };
    std::vector<Cube> holes;
    for (std::size_t i = 0; i < all[1].size(); ++i)
    {
      if (i % 7 != 3)
      {
        holes.push_back(all[1][i]);
      }
    }
    all.push_back(holes);
    return all;
  }
};

TEST_F(HexBricksTest, BricksFillTheLeavesAndNothingElse)
{
  for (const auto& cubes : this->Cubes())
  {
    for (const int edge : { 1, 4, 16, 32 })
    {
      const Case made = this->Made(cubes, edge);
      std::int64_t leaf = 0;
      std::int64_t volume = 0;
      for (const HexBrick& brick : made.Bricks->List())
      {
        const glm::ivec3 size = brick.Cells.Size();
        ASSERT_LE(std::max({ size.x, size.y, size.z }), edge);
        ASSERT_EQ(brick.FirstLeaf, leaf);
        int finest = 30;
        std::int64_t filled = 0;
        for (; leaf < brick.EndLeaf; ++leaf)
        {
          const glm::ivec3 corner = made.Tree->CornerOfLeaf(leaf);
          const int level = made.Tree->LevelOfLeaf(leaf);
          const Box cells{ corner, corner + (1 << level) };
          ASSERT_TRUE(brick.FinestCells().Contains(cells));
          finest = std::min(finest, level);
          filled += cells.Count();
        }
        ASSERT_EQ(brick.Level, finest);
        ASSERT_EQ(filled, brick.FinestCells().Count()) << "no holes inside";
        volume += filled;
      }
      EXPECT_EQ(leaf, made.Tree->LeafCount());
      EXPECT_EQ(volume, made.Tree->Domain().Count() - made.Tree->HoleCells());
    }
  }
}

TEST_F(HexBricksTest, LargeElementsAreFewBricks)
{
  const Case made = this->Made(meshes::Ball({ 4, 4, 4 }, 5), 16);
  // 128^3 of the finest cells would be 512 bricks of 16^3.
  EXPECT_LT(made.Bricks->List().size(), 200u);
  EXPECT_EQ(made.Bricks->CoarsestLevel(), 5);
}

TEST_F(HexBricksTest, SamplesAreTheElementsOwnValues)
{
  std::mt19937 random(3);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const auto& cubes : this->Cubes())
  {
    const Case made = this->Made(cubes);
    const std::vector<double> values = made.Mesh.Sampled(Wavy);
    HexBrickSource source(made.Bricks, ArrayOf(values), this->Pool);
    for (std::int64_t number = 0; number < source.Bricks().x; ++number)
    {
      const HexBrick& brick = made.Bricks->List()[static_cast<std::size_t>(number)];
      const BrickView view = source.Load(number);
      for (std::int64_t leaf = brick.FirstLeaf; leaf < brick.EndLeaf; ++leaf)
      {
        const glm::dvec3 place = glm::dvec3(made.Tree->CornerOfLeaf(leaf)) +
                                 glm::dvec3(unit(random), unit(random), unit(random)) *
                                   double(1 << made.Tree->LevelOfLeaf(leaf));
        ASSERT_NEAR(InBrick(view, brick, place), InLeaf(source.Field(), leaf, place), 1e-12);
      }
    }
  }
}

TEST_F(HexBricksTest, TheFieldIsContinuousAcrossFacesOfElementsAndBricks)
{
  std::mt19937 random(9);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (const auto& cubes : this->Cubes())
  {
    const Case made = this->Made(cubes);
    const ElementOctree& tree = *made.Tree;
    // What hangs has other values in the array than the large side has there.
    std::vector<double> values = made.Mesh.Sampled(Wavy);
    HexBrickSource source(made.Bricks, ArrayOf(values), this->Pool);
    std::vector<std::int64_t> brickOf(static_cast<std::size_t>(tree.LeafCount()));
    std::vector<BrickView> views;
    for (std::size_t i = 0; i < made.Bricks->List().size(); ++i)
    {
      const HexBrick& brick = made.Bricks->List()[i];
      std::fill(brickOf.begin() + brick.FirstLeaf, brickOf.begin() + brick.EndLeaf,
        static_cast<std::int64_t>(i));
      views.push_back(source.Load(static_cast<std::int64_t>(i)));
    }
    int faces = 0;
    int mixed = 0;
    for (std::int64_t leaf = 0; leaf < tree.LeafCount(); ++leaf)
    {
      const int edge = 1 << tree.LevelOfLeaf(leaf);
      const glm::ivec3 corner = tree.CornerOfLeaf(leaf);
      for (int axis = 0; axis < 3; ++axis)
      {
        for (int try_ = 0; try_ < 4; ++try_)
        {
          glm::dvec3 place = glm::dvec3(corner) +
                             double(edge) * glm::dvec3(unit(random), unit(random), unit(random));
          place[axis] = corner[axis] + edge;
          glm::ivec3 beyond(glm::floor(place));
          beyond[axis] = corner[axis] + edge;
          const std::int64_t other = tree.LeafAt(beyond);
          if (other < 0)
          {
            continue;
          }
          ++faces;
          mixed += tree.LevelOfLeaf(other) != tree.LevelOfLeaf(leaf) ? 1 : 0;
          const double here = InLeaf(source.Field(), leaf, place);
          ASSERT_NEAR(here, InLeaf(source.Field(), other, place), 1e-12);
          for (const std::int64_t side : { leaf, other })
          {
            const auto number = static_cast<std::size_t>(brickOf[static_cast<std::size_t>(side)]);
            ASSERT_NEAR(InBrick(views[number], made.Bricks->List()[number], place), here, 1e-12);
          }
        }
      }
    }
    EXPECT_GT(faces, 300);
    EXPECT_TRUE(mixed > 100 || tree.CoarsestLevel() == 0);
  }
}

TEST_F(HexBricksTest, TrilinearFieldsStayWhatTheyAre)
{
  for (const auto& cubes : this->Cubes())
  {
    const Case made = this->Made(cubes);
    const std::vector<double> values = made.Mesh.Sampled(Trilinear);
    const NodalField field(made.Tree, ArrayOf(values), this->Pool);
    for (std::size_t node = 0; node < values.size(); ++node)
    {
      ASSERT_NEAR(field.AtNode(static_cast<std::int64_t>(node)), values[node], 1e-9);
    }
  }
}

TEST_F(HexBricksTest, WhatLiesAroundABrickIsTheFieldThere)
{
  for (const auto& cubes : this->Cubes())
  {
    const Case made = this->Made(cubes);
    const std::vector<double> values = made.Mesh.Sampled(Trilinear);
    HexBrickSource source(made.Bricks, ArrayOf(values), this->Pool);
    std::int64_t outside = 0;
    for (std::int64_t number = 0; number < source.Bricks().x; ++number)
    {
      const HexBrick& brick = made.Bricks->List()[static_cast<std::size_t>(number)];
      Box samples;
      const BrickView view = source.LoadAround(number, samples);
      ASSERT_EQ(samples.Lo, brick.Cells.Lo - 1);
      ASSERT_EQ(samples.Hi, brick.Cells.Hi + 2);
      for (int z = samples.Lo.z; z < samples.Hi.z; ++z)
      {
        for (int y = samples.Lo.y; y < samples.Hi.y; ++y)
        {
          for (int x = samples.Lo.x; x < samples.Hi.x; ++x)
          {
            const glm::ivec3 p = glm::ivec3(x, y, z) - samples.Lo;
            const double value = static_cast<const double*>(
              view.Values)[p.x + p.y * view.Stride[1] + p.z * view.Stride[2]];
            const glm::ivec3 at = glm::ivec3(x, y, z) * (1 << brick.Level);
            if (made.Tree->LargestLeafAround(at) >= 0)
            {
              ASSERT_NEAR(value, Trilinear(glm::dvec3(at)), 1e-9);
            }
            else
            {
              ASSERT_TRUE(std::isnan(value));
              ++outside;
            }
          }
        }
      }
    }
    EXPECT_GT(outside, 0);
  }
}

TEST_F(HexBricksTest, RangesAndMasksCoverAllValuesAndUniformBricksAreKnown)
{
  const Case made = this->Made(meshes::Ball({ 2, 1, 1 }, 5));
  std::vector<double> values =
    made.Mesh.Sampled([](const glm::dvec3& p) { return p.x < 30 ? 2.0 : Wavy(p); });
  values[static_cast<std::size_t>(made.Mesh.Ids.front())] = std::nan("");
  HexBrickSource source(made.Bricks, ArrayOf(values), this->Pool);
  int uniform = 0;
  for (std::int64_t number = 0; number < source.Bricks().x; ++number)
  {
    const Box cells = source.CellsOf(number);
    const BrickView view = source.Load(number);
    ValueRange range;
    bool special = false;
    const std::int64_t count = Box{ cells.Lo, cells.Hi + 1 }.Count();
    for (std::int64_t i = 0; i < count; ++i)
    {
      const double value = static_cast<const double*>(view.Values)[i];
      special = special || std::isnan(value);
      if (!std::isnan(value))
      {
        range.Include(value);
        ASSERT_NE(source.MaskOf(number) >> source.MasksAreOver().BinOf(value) & 1, 0u);
      }
    }
    EXPECT_EQ(source.RangeOf(number).Low, range.Low);
    EXPECT_EQ(source.RangeOf(number).High, range.High);
    const auto value = source.UniformValueOf(number);
    EXPECT_EQ(value.has_value(), range.Low == range.High && !special);
    uniform += value.has_value() ? 1 : 0;
  }
  EXPECT_GT(uniform, 5);
  EXPECT_LT(uniform, source.Bricks().x);
}

TEST_F(HexBricksTest, ComponentsMagnitudesAndTypes)
{
  const Case made = this->Made(meshes::Ball({ 1, 1, 1 }, 3));
  const std::size_t count = made.Mesh.Places.size();
  std::vector<float> vectors;
  for (std::size_t i = 0; i < count; ++i)
  {
    const glm::vec3 p(made.Mesh.Places[i]);
    vectors.insert(vectors.end(), { p.x, -2.0f * p.y, p.z + 1.0f });
  }
  NodeArray array;
  array.Values = vectors.data();
  array.Components = 3;
  std::set<std::int64_t> hanging;
  for (const HangingNode& node : made.Tree->Hanging())
  {
    hanging.insert(node.Node);
  }
  for (array.Component = -1; array.Component < 3; ++array.Component)
  {
    const NodalField field(made.Tree, array, this->Pool);
    EXPECT_EQ(field.Type(), ScalarType::Float32);
    for (std::size_t i = 0; i < count; ++i)
    {
      const float* v = &vectors[3 * i];
      const double expected =
        array.Component < 0
          ? std::sqrt(double(v[0]) * v[0] + double(v[1]) * v[1] + double(v[2]) * v[2])
          : v[array.Component];
      if (hanging.count(static_cast<std::int64_t>(i)) == 0 || array.Component >= 0)
      {
        ASSERT_NEAR(field.AtNode(static_cast<std::int64_t>(i)), expected, 1e-5);
      }
    }
  }
  array.Component = 3;
  EXPECT_THROW(NodalField(made.Tree, array, this->Pool), Error);
}

TEST_F(HexBricksTest, NewValuesFindNoOctree)
{
  const Case made = this->Made(meshes::Ball({ 2, 1, 1 }, 4));
  const std::int64_t found = ElementOctree::FoundSoFar();
  for (int step = 0; step < 5; ++step)
  {
    const std::vector<double> values =
      made.Mesh.Sampled([&](const glm::dvec3& p) { return Wavy(p) * step; });
    const HexBrickSource source(made.Bricks, ArrayOf(values), this->Pool);
    EXPECT_EQ(source.MasksAreOver().High > 0.0, step > 0);
  }
  EXPECT_EQ(ElementOctree::FoundSoFar(), found);
}

} // namespace
