// Coarser levels of octree meshes: which elements they have, their values, and their pictures.
#include "HexOctree/TinyMeshes.h"

#include "HexOctree/HexBrickSource.h"
#include "Parallel/DistributedFrame.h"
#include "Parallel/DistributedPlan.h"
#include "Parallel/Zones.h"
#include "Render/Analytic.h"
#include "Render/ElementsPerPixel.h"

#include <gtest/gtest.h>

#include <cmath>

namespace
{

using namespace banyan;
using analytic::OneLevel;
using meshes::Cube;

const glm::ivec3 Size(64, 32, 32);

struct Made
{
  meshes::OwnMesh<double, std::int64_t> Mesh;
  std::vector<float> Values;
  std::shared_ptr<const HexBricks> Bricks;

  Made(meshes::OwnMesh<double, std::int64_t> mesh, const scenes::Field& field)
    : Mesh(std::move(mesh))
    , Values(Mesh.Sampled<float>([&](const glm::dvec3& p) { return field(p / glm::dvec3(Size)); }))
    , Bricks(std::make_shared<const HexBricks>(meshes::Find(Mesh.Mesh()), 8))
  {
  }
  Made(const std::vector<Cube>& cubes, const scenes::Field& field)
    : Made(meshes::Make(cubes, glm::dvec3(0.0), glm::dvec3(1.0), 3), field)
  {
  }

  HexBrickSource Source(ThreadPool& pool) const
  {
    NodeArray array;
    array.Values = this->Values.data();
    return HexBrickSource(this->Bricks, array, pool);
  }

  RayScene Scene(double step, double distance = 1.4) const
  {
    RayScene scene = scenes::Scene(Size + 1, { 90, 70 }, glm::dmat4(1.0), distance);
    scene.IndexToWorld = this->Bricks->Tree().LatticeToWorld();
    scene.DomainCells = this->Bricks->Tree().Domain();
    scene.SampleDistance = step;
    scene.LevelsShareCells = true;
    return scene;
  }
};

std::vector<Cube> Graded()
{
  return meshes::Ball({ 2, 1, 1 }, 5);
}

std::vector<Cube> Rough()
{
  return meshes::Wild({ 2, 1, 1 }, 5, 4);
}

/// With cells left out here and there.
std::vector<Cube> Holed()
{
  std::vector<Cube> cubes;
  for (const Cube& cube : Rough())
  {
    if ((cube.Corner.x + 3 * cube.Corner.y + 5 * cube.Corner.z) % 11 != 0)
    {
      cubes.push_back(cube);
    }
  }
  return cubes;
}

const HexBrickSource& At(HexBrickSource& source, int level, const Box& domain)
{
  return dynamic_cast<const HexBrickSource&>(*source.AtLevel(level, domain));
}

template <class Function>
void ForPoints(const glm::ivec3& size, const Function& function)
{
  for (int z = 0; z < size.z; ++z)
  {
    for (int y = 0; y < size.y; ++y)
    {
      for (int x = 0; x < size.x; ++x)
      {
        function(glm::ivec3(x, y, z));
      }
    }
  }
}

/// Which cells have an element, x fastest.
std::vector<bool> CoveredCells(const ElementOctree& tree)
{
  std::vector<bool> covered;
  ForPoints(Size, [&](const glm::ivec3& cell) { covered.push_back(tree.LeafAt(cell) >= 0); });
  return covered;
}

/// The corner and the level of the element of a coarser mesh at a cell: the largest cube up to the
/// level that smaller leaves fill, cell by cell.
Cube SlowElementAt(
  const ElementOctree& tree, const std::vector<bool>& covered, const glm::ivec3& cell, int level)
{
  const std::int64_t own = tree.LeafAt(cell);
  Cube found{ tree.CornerOfLeaf(own), tree.LevelOfLeaf(own) };
  for (int larger = found.Level + 1; larger <= level; ++larger)
  {
    const glm::ivec3 corner = cell >> larger << larger;
    for (int i = 0; i < 1 << 3 * larger; ++i)
    {
      const int mask = (1 << larger) - 1;
      const glm::ivec3 p = corner + glm::ivec3(i & mask, i >> larger & mask, i >> 2 * larger);
      if (!covered[static_cast<std::size_t>(p.x + Size.x * (p.y + Size.y * p.z))])
      {
        return found;
      }
    }
    found = { corner, larger };
  }
  return found;
}

TEST(HexLevels, ElementsAreTheLargestCubesThatAreFilled)
{
  ThreadPool pool(2);
  for (const auto& cubes : { Graded(), Rough(), Holed() })
  {
    const Made made(cubes, scenes::Standard);
    const ElementOctree& tree = made.Bricks->Tree();
    const std::vector<bool> covered = CoveredCells(tree);
    for (const int level : { 1, 3 })
    {
      const ElementOctree& coarser = made.Bricks->AtLevel(level, pool).Bricks->Tree();
      EXPECT_LT(coarser.LeafCount(), tree.LeafCount());
      EXPECT_EQ(coarser.Domain(), tree.Domain());
      EXPECT_EQ(coarser.HoleCells(), tree.HoleCells());
      ForPoints(tree.Domain().Hi,
        [&](const glm::ivec3& cell)
        {
          const std::int64_t leaf = coarser.LeafAt(cell);
          ASSERT_EQ(leaf < 0, tree.LeafAt(cell) < 0);
          if (leaf >= 0)
          {
            const Cube expected = SlowElementAt(tree, covered, cell, level);
            ASSERT_EQ(coarser.LevelOfLeaf(leaf), expected.Level);
            ASSERT_EQ(coarser.CornerOfLeaf(leaf), expected.Corner);
          }
        });
      // From the mesh itself, without the levels between.
      const CoarserOctree direct = CoarserOctreeOf(tree, level, pool);
      EXPECT_EQ(direct.Tree->LeafCount(), coarser.LeafCount());
      EXPECT_EQ(direct.Tree->Hanging().size(), coarser.Hanging().size());
    }
  }
}

TEST(HexLevels, CornersKeepTheirValuesAndNoFaceHasACrack)
{
  ThreadPool pool(1);
  for (const auto& cubes : { Graded(), Rough(), Holed() })
  {
    const Made made(cubes, scenes::Standard);
    HexBrickSource source = made.Source(pool);
    const Box domain = made.Bricks->Tree().Domain();
    for (const int level : { 1, 3 })
    {
      const NodalField& field = At(source, level, domain).Field();
      const ElementOctree& tree = field.Tree();
      std::vector<bool> hangs(static_cast<std::size_t>(tree.Mesh().PointCount), false);
      for (const HangingNode& node : tree.Hanging())
      {
        hangs[static_cast<std::size_t>(node.Node)] = true;
      }
      for (std::int64_t leaf = 0; leaf < tree.LeafCount(); ++leaf)
      {
        std::int64_t nodes[8];
        tree.NodesOfLeaf(leaf, nodes);
        for (int corner = 0; corner < 8; ++corner)
        {
          const glm::ivec3 at =
            tree.CornerOfLeaf(leaf) +
            glm::ivec3(corner & 1, corner >> 1 & 1, corner >> 2) * (1 << tree.LevelOfLeaf(leaf));
          if (!hangs[static_cast<std::size_t>(nodes[corner])])
          {
            ASSERT_EQ(field.AtNode(nodes[corner]), source.Field().AtPoint(at));
          }
        }
      }
      ForPoints(domain.Hi + 1,
        [&](const glm::ivec3& point)
        {
          // All elements that touch a point of the lattice say the same of it.
          double low = std::numeric_limits<double>::infinity();
          double high = -low;
          for (int octant = 0; octant < 8; ++octant)
          {
            const std::int64_t leaf =
              tree.LeafAt(point - glm::ivec3(octant & 1, octant >> 1 & 1, octant >> 2));
            if (leaf >= 0)
            {
              double corners[8];
              field.CornersOf(leaf, corners);
              const double value = NodalField::Interpolate(corners,
                glm::dvec3(point - tree.CornerOfLeaf(leaf)) / double(1 << tree.LevelOfLeaf(leaf)));
              low = std::min(low, value);
              high = std::max(high, value);
            }
          }
          ASSERT_TRUE(high < low || high - low < 1e-6);
        });
    }
  }
}

/// Each cell with points of its own.
TEST(HexLevels, PointsAtOnePlaceBecomeOne)
{
  ThreadPool pool(1);
  const auto cubes = Rough();
  const Made shared(cubes, scenes::Standard);
  meshes::OwnMesh<double, std::int64_t> apart;
  for (const Cube& cube : cubes)
  {
    const auto one = meshes::Make({ cube });
    const auto before = static_cast<std::int64_t>(apart.Places.size());
    apart.Points.insert(apart.Points.end(), one.Points.begin(), one.Points.end());
    apart.Places.insert(apart.Places.end(), one.Places.begin(), one.Places.end());
    for (const std::int64_t id : one.Ids)
    {
      apart.Ids.push_back(id + before);
    }
  }
  const Made twins(apart, scenes::Standard);
  HexBrickSource a = shared.Source(pool);
  HexBrickSource b = twins.Source(pool);
  const Box domain = shared.Bricks->Tree().Domain();
  const NodalField& expected = At(a, 2, domain).Field();
  const NodalField& field = At(b, 2, domain).Field();
  ASSERT_EQ(field.Tree().LeafCount(), expected.Tree().LeafCount());
  ForPoints(domain.Hi + 1, [&](const glm::ivec3& point)
    { ASSERT_NEAR(field.AtPoint(point), expected.AtPoint(point), 1e-6); });
}

/// Every second tile at a level, every second one at another.
std::shared_ptr<TileSamplings> Mixed(const RayScene& scene, int first, int second)
{
  auto samplings = std::make_shared<TileSamplings>(scene.Camera.ImageSize(),
    std::vector<RaySampling>{ { first, scene.SampleDistance }, { second, scene.SampleDistance } });
  ForPoints({ samplings->Tiles(), 1 },
    [&](const glm::ivec3& tile) { samplings->SetNumber(tile, (tile.x + tile.y) % 2); });
  return samplings;
}

FloatImage DrawOnRanks(const Made& made, const RayScene& scene, int ranks)
{
  FloatImage image;
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      ThreadPool pool(1);
      HexBrickSource source = made.Source(pool);
      // Planes of zones stand anywhere, also inside of large elements.
      std::vector<Box> zones;
      for (const Box& part : StaticZones({ 13, 7, 7 }, communicator.Size()))
      {
        zones.push_back(CellsOfBricks(part, 5, scene.DomainCells.Hi));
      }
      FrameStatistics statistics;
      const FloatImage picture = DrawDistributed(
        communicator, scene, &source, zones, std::uint64_t{ 1 } << 24, pool, {}, statistics);
      if (communicator.Rank() == 0)
      {
        image = picture;
      }
    });
  return image;
}

TEST(HexLevels, LinearFieldsLookTheSameAtAllLevels)
{
  const auto linear = [](const glm::dvec3& p) { return 0.1 + 0.3 * p.x + 0.25 * p.y + 0.3 * p.z; };
  for (const auto& cubes : { Graded(), Rough() })
  {
    const Made made(cubes, linear);
    RayScene scene = made.Scene(0.5);
    const FloatImage expected = DrawOnRanks(made, scene, 1);
    EXPECT_GT(expected.At(45, 35).a, 0.2);
    scene.Samplings = Mixed(scene, 2, 5);
    EXPECT_LE(MaxDifference(DrawOnRanks(made, scene, 1), expected), OneLevel);
  }
}

TEST(HexLevels, LevelsAreDrawnAsTheyAreAndByRanksAsByOne)
{
  const glm::ivec3 n = Size + 1;
  for (const auto& cubes : { Graded(), Rough() })
  {
    const Made made(cubes, scenes::Standard);
    for (const double distance : { 1.4, 0.1 })
    {
      ThreadPool pool(1);
      HexBrickSource source = made.Source(pool);
      RayScene scene = made.Scene(0.7, distance);
      // The level's own field on the finest lattice, where it is trilinear too.
      const NodalField& field = At(source, 3, scene.DomainCells).Field();
      std::vector<float> values;
      for (int i = 0; i < n.x * n.y * n.z; ++i)
      {
        values.push_back(
          static_cast<float>(field.AtPoint(glm::ivec3(i % n.x, i / n.x % n.y, i / n.x / n.y))));
      }
      const FloatImage expected = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
      scene.Samplings = Mixed(scene, 3, 3);
      const FloatImage alone = DrawOnRanks(made, scene, 1);
      EXPECT_LE(MaxDifference(alone, expected), OneLevel);
      scene.Samplings = Mixed(scene, 0, 3);
      const FloatImage mixed = DrawOnRanks(made, scene, 1);
      EXPECT_GT(MaxDifference(mixed, alone), OneLevel);
      for (const int ranks : { 2, 3 })
      {
        EXPECT_LT(MaxDifference(DrawOnRanks(made, scene, ranks), mixed), 1e-5) << ranks;
      }
    }
  }
}

TEST(HexLevels, PlansKeepTheToleranceWithCoarserLevels)
{
  const auto smooth = [](const glm::dvec3& p) { return std::exp(-0.5 * glm::dot(p, p)); };
  const Made made(meshes::Leaves({ 64, 32, 32 }, 0, [](const Cube&) { return false; }), smooth);
  ThreadPool pool(1);
  HexBrickSource source = made.Source(pool);
  RayScene scene = made.Scene(1.0);
  const std::vector<Box> zones{ scene.DomainCells };
  const auto alone = MakeSelfCommunicator();
  FrameStatistics statistics;
  const FloatImage exact = [&]
  {
    RayScene close = scene;
    close.SampleDistance = 0.125;
    return DrawOnRanks(made, close, 1);
  }();
  for (const double most : { 0.0, 1e6 })
  {
    SamplingWish wish{ 8.0, scene.SampleDistance, 3 };
    wish.LeastCells = 8;
    wish.LargestPixelStride = 1;
    wish.FinestLevel = FinestLevelFor(scene, most > 0.0 ? 1.0 / most : 0.0, wish.CoarsestLevel);
    EXPECT_EQ(wish.FinestLevel, most > 0.0 ? 3 : 0);
    const SamplingPlan plan = PlanDistributed(
      *alone, scene, &source, zones, std::uint64_t{ 1 } << 28, pool, {}, wish, statistics);
    ASSERT_TRUE(plan.Samplings);
    EXPECT_GT(*plan.Samplings->UsedLevels().rbegin(), 0);
    RayScene planned = scene;
    planned.Samplings = plan.Samplings;
    planned.OpacityLimit = plan.OpacityLimit;
    const double error = 255.0 * MaxDifference(DrawOnRanks(made, planned, 1), exact);
    EXPECT_LE(error, plan.EstimatedError);
    if (most == 0.0)
    {
      EXPECT_LE(error, 8.0);
    }
    else
    {
      EXPECT_GE(*plan.Samplings->UsedLevels().begin(), 2); // two levels, for the error
    }
  }
}

TEST(HexLevels, ElementsPerPixelAreCountedWhereTheMeshIsNearest)
{
  const Made made(Rough(), scenes::Standard);
  RayScene scene = made.Scene(1.0);
  // 64 x 64 pixels over 32 x 32 edges: four pixels per element; 16 x 16 elements in each of 2 x 2.
  const auto with = [&](int pixels)
  {
    const glm::dmat4 toClip = glm::ortho(0.0, 32.0, 0.0, 32.0, -100.0, 100.0);
    scene.Camera = RayCamera(toClip, glm::ivec2(pixels), glm::dvec3(0.0));
    return scene;
  };
  EXPECT_EQ(FinestLevelFor(with(64), 1.0, 5), 0);
  EXPECT_EQ(FinestLevelFor(with(2), 256.0, 5), 0);
  EXPECT_EQ(FinestLevelFor(with(2), 255.0, 5), 1);
  EXPECT_EQ(FinestLevelFor(with(2), 64.0, 5), 1);
  EXPECT_EQ(FinestLevelFor(with(2), 1.0, 5), 4);
  EXPECT_EQ(FinestLevelFor(with(2), 1.0, 3), 3);
  EXPECT_EQ(FinestLevelFor(with(2), 0.0, 5), 0);
  // An eye inside: the nearest element fills the picture.
  EXPECT_EQ(FinestLevelFor(made.Scene(1.0, 0.1), 1.0, 5), 0);
}

} // namespace
