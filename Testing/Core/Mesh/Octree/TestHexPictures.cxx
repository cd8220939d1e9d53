// SPDX-License-Identifier: BSD-3-Clause
// Pictures of octree meshes: those of the field that the mesh is of.
#include "Mesh/Octree/PicturesOfRanks.h"
#include "Mesh/Octree/TinyMeshes.h"

#include "Mesh/Octree/HexBrickSource.h"
#include "Render/Analytic.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;
using analytic::OneLevel;
using meshes::Cube;

const glm::ivec2 Pixels(90, 70);

/// A mesh of cubes over 64 x 32 x 32 finest cells, and the values of a field over [0, 1]^3 at its
/// points.
struct Case
{
  meshes::OwnMesh<double, std::int64_t> Mesh;
  std::vector<float> Values;
  std::shared_ptr<const HexBricks> Bricks;
  int Edge; ///< finest cells per finest edge of the mesh

  Case(const std::vector<Cube>& cubes, const scenes::Field& field, int brickEdge = 16)
    : Mesh(meshes::Make(cubes, glm::dvec3(0.0), glm::dvec3(1.0), 3))
    , Values(Mesh.Sampled<float>(
        [&](const glm::dvec3& p) { return field(p / glm::dvec3(64.0, 32.0, 32.0)); }))
    , Bricks(std::make_shared<const HexBricks>(meshes::Find(Mesh.Mesh()), brickEdge))
    , Edge(static_cast<int>(Bricks->Tree().Edge().x + 0.5))
  {
  }

  HexBrickSource Source(ThreadPool& pool) const
  {
    NodeArray array;
    array.Values = this->Values.data();
    return HexBrickSource(this->Bricks, array, pool);
  }

  /// The scene of all of it; distances are those of the world, whatever the finest edge.
  RayScene Scene(double step, double distance = 1.4, bool parallel = false) const
  {
    RayScene scene = scenes::Scene({ 65, 33, 33 }, Pixels, glm::dmat4(1.0), distance, parallel);
    scene.IndexToWorld = this->Bricks->Tree().LatticeToWorld();
    scene.DomainCells = this->Bricks->Tree().Domain();
    scene.SampleDistance = step;
    return scene;
  }
};

FloatImage Draw(const Case& made, const RayScene& scene, int threads = 1,
  std::uint64_t budget = std::uint64_t{ 1 } << 30, RayStatistics* statistics = nullptr)
{
  ThreadPool pool(threads);
  HexBrickSource source = made.Source(pool);
  RayStatistics own;
  FloatImage image =
    CastRays(scene, source, scene.DomainCells, budget, pool, statistics ? *statistics : own);
  FinishPicture(scene, image);
  return image;
}

std::vector<Cube> Uniform(int level)
{
  return meshes::Leaves(glm::ivec3(64, 32, 32) >> level, level, [](const Cube&) { return false; });
}

std::vector<Cube> Graded()
{
  return meshes::Ball({ 2, 1, 1 }, 5);
}

std::vector<Cube> Rough()
{
  return meshes::Wild({ 2, 1, 1 }, 5, 4);
}

double Trilinear(const glm::dvec3& p)
{
  return 0.1 + 0.3 * p.x + 0.2 * p.y * p.z - 0.25 * p.x * p.z + 0.5 * p.x * p.y * p.z + 0.1 * p.z;
}

TEST(HexPictures, OneLevelIsImageDataToTheBit)
{
  const glm::ivec3 n(65, 33, 33);
  for (const bool shaded : { false, true })
  {
    for (const int edge : { 16, 32 })
    {
      const Case made(Uniform(0), scenes::Standard, edge);
      RayScene scene = made.Scene(0.7);
      scene.Shading.On = shaded;
      const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
      const FloatImage expected = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
      const FloatImage image = Draw(made, scene);
      EXPECT_EQ(MaxDifference(image, expected), 0.0) << edge;
      EXPECT_GT(image.At(45, 35).a, 0.2);
    }
  }
}

/// Integrals of an extinction that grows with the value, in closed form along straight rays for
/// linear fields.
TEST(HexPictures, LinearFieldsAreTheAnalyticPicture)
{
  const double extinction = 0.05;
  const auto linear = [](const glm::dvec3& p) { return 0.1 + 0.3 * p.x + 0.25 * p.y + 0.3 * p.z; };
  for (const auto& cubes : { Uniform(2), Graded(), Rough() })
  {
    const Case made(cubes, linear);
    RayScene scene = made.Scene(0.25);
    scene.Transfer = scenes::Tabulate(
      [&](double v) { return glm::dvec4(1, 1, 1, analytic::OpacityOf(extinction * v)); }, 65536);
    analytic::ExpectIntegral(
      Draw(made, scene), scene, glm::dvec3(64.0, 32.0, 32.0),
      [&](const analytic::Chord& chord)
      {
        const glm::dvec3 size(64.0, 32.0, 32.0);
        const double depth =
          extinction * chord.Length() * 0.5 *
          (linear(chord.At(chord.Enter) / size) + linear(chord.At(chord.Exit) / size));
        return glm::dvec4(analytic::OpacityOf(depth));
      },
      OneLevel);
  }
}

TEST(HexPictures, TrilinearFieldsAreTheReference)
{
  // In double precision, one sample after the other, through the function itself.
  const glm::ivec3 n(65, 33, 33);
  const std::vector<double> exact = scenes::Sampled<double>(Trilinear, n);
  for (const bool parallel : { false, true })
  {
    for (const double distance : { 1.4, 0.1 })
    {
      const Case finest(Uniform(0), Trilinear);
      const RayScene scene = finest.Scene(0.6, distance, parallel);
      const FloatImage reference =
        ReferenceImage(scene, scenes::ValueOf(exact, n), scenes::NearestEntry(scene.Transfer));
      for (const auto& cubes : { Uniform(0), Uniform(3), Graded(), Rough() })
      {
        const Case made(cubes, Trilinear);
        const FloatImage image = Draw(made, made.Scene(0.6, distance, parallel));
        EXPECT_LE(MaxDifference(image, reference), OneLevel);
      }
    }
  }
}

TEST(HexPictures, AnyFieldIsTheReferenceOfItsElements)
{
  // The lattice sampled from the mesh: what is drawn must be that, elements of all sizes alike.
  ThreadPool pool(1);
  for (const auto& cubes : { Graded(), Rough() })
  {
    const Case made(cubes, scenes::Standard);
    ASSERT_EQ(made.Edge, 1);
    const HexBrickSource source = made.Source(pool);
    const RayScene scene = made.Scene(0.5);
    const FloatImage reference = ReferenceImage(
      scene, [&](const glm::ivec3& p) { return source.Field().AtPoint(p); },
      scenes::NearestEntry(scene.Transfer));
    EXPECT_LE(MaxDifference(Draw(made, scene), reference), OneLevel);
  }
}

TEST(HexPictures, RefiningElementsChangesNoPicture)
{
  // The same field on finer elements: cubes split once more, values by the elements they split.
  for (const bool shaded : { false, true })
  {
    const auto bell = [](const glm::dvec3& p)
    { return 0.2 + 0.6 * p.x * p.y + 0.2 * p.z * (1.0 - p.x); };
    const Case coarse(Uniform(3), bell);
    RayScene scene = coarse.Scene(0.5);
    scene.Shading.On = shaded;
    const FloatImage expected = Draw(coarse, scene);
    EXPECT_GT(expected.At(45, 35).a, 0.2);
    for (const auto& cubes : { Uniform(2), Uniform(1), Graded(), Rough() })
    {
      const Case made(cubes, bell);
      RayScene same = made.Scene(0.5);
      same.Shading.On = shaded;
      EXPECT_LE(MaxDifference(Draw(made, same), expected), OneLevel) << shaded;
    }
  }
}

TEST(HexPictures, ShadingHasNoSeamsWhereLevelsMeet)
{
  const auto bell = [](const glm::dvec3& p) { return std::exp(-1.5 * glm::dot(p - 0.5, p - 0.5)); };
  const Case fine(Uniform(0), bell);
  // Levels 0 and 1 meet in the middle of the bell.
  const Case mixed(
    meshes::Leaves({ 32, 16, 16 }, 1, [](const Cube& cube) { return cube.Corner.x < 32; }), bell);
  RayScene scene = fine.Scene(0.5);
  scene.Shading.On = true;
  RayScene same = mixed.Scene(0.5);
  same.Shading.On = true;
  EXPECT_LE(MaxDifference(Draw(fine, scene), Draw(mixed, same)), OneLevel);
}

TEST(HexPictures, BricksThreadsAndMemoryChangeNoBit)
{
  for (const bool shaded : { false, true })
  {
    for (const auto& cubes : { Graded(), Rough() })
    {
      const Case made(cubes, scenes::Standard, 32);
      RayScene scene = made.Scene(0.8);
      scene.Shading.On = shaded;
      const FloatImage expected = Draw(made, scene);
      EXPECT_EQ(MaxDifference(Draw(made, scene, 3), expected), 0.0);
      EXPECT_EQ(MaxDifference(Draw(made, scene, 2, 100000), expected), 0.0);
      // Other bricks have other lattices: the same numbers but for rounding; gradients are those of
      // the lattice.
      for (const int edge : { 2, 8 })
      {
        const FloatImage other = Draw(Case(cubes, scenes::Standard, edge), scene);
        EXPECT_LE(MaxDifference(other, expected), shaded ? 0.1 : 1e-4);
      }
    }
  }
}

TEST(HexPictures, AnyStepIsThatOfImageData)
{
  // 20 is longer than packets of the finest bricks are made for.
  const glm::ivec3 n(65, 33, 33);
  const std::vector<float> values = scenes::Sampled(Trilinear, n);
  const Case made(Graded(), Trilinear);
  for (const double step : { 0.1, 0.5, 4.0, 15.0, 20.0 })
  {
    const RayScene scene = made.Scene(step);
    const FloatImage expected = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
    EXPECT_LE(MaxDifference(Draw(made, scene), expected), OneLevel) << step;
  }
}

TEST(HexPictures, HolesAreNotDrawn)
{
  std::vector<Cube> cubes;
  for (const Cube& cube : meshes::Ball({ 2, 1, 1 }, 5))
  {
    if (cube.Corner.z < 16)
    {
      cubes.push_back(cube);
    }
  }
  const Case made(cubes, [](const glm::dvec3&) { return 0.5; });
  ASSERT_EQ(made.Edge, 1);
  RayScene scene = made.Scene(0.5);
  // The whole box, of which only half has elements: rays are those of the half.
  scene.DomainCells.Hi.z = 32;
  const double extinction = 0.02;
  scene.Transfer =
    scenes::Tabulate([&](double) { return glm::dvec4(1, 1, 1, analytic::OpacityOf(extinction)); });
  const FloatImage image = Draw(made, scene);
  double worst = 0.0;
  for (int y = 0; y < Pixels.y; ++y)
  {
    for (int x = 0; x < Pixels.x; ++x)
    {
      // The lower half of the box, by its own chord.
      const Ray ray = scene.Camera.RayOf(x, y);
      double enter = ray.Near;
      double exit = ray.Far;
      const glm::dvec3 low(0.0);
      const glm::dvec3 high(64.0, 32.0, 16.0);
      for (int axis = 0; axis < 3; ++axis)
      {
        const double a = (low[axis] - ray.Origin[axis]) / ray.Direction[axis];
        const double b = (high[axis] - ray.Origin[axis]) / ray.Direction[axis];
        enter = std::max(enter, std::min(a, b));
        exit = std::min(exit, std::max(a, b));
      }
      const double expected = analytic::OpacityOf(extinction * std::max(0.0, exit - enter));
      const PixelRect& rect = image.Rect;
      const bool drawn = x >= rect.Lo.x && x < rect.Hi.x && y >= rect.Lo.y && y < rect.Hi.y;
      // A sample stands for its interval, wherever in it the hole ends.
      worst = std::max(worst, std::abs((drawn ? image.At(x, y).a : 0.0) - expected));
    }
  }
  EXPECT_LE(worst, extinction * scene.SampleDistance);
}

TEST(HexPictures, MaximaAveragesLabelsAndCutsAreThoseOfImageData)
{
  const glm::ivec3 n(65, 33, 33);
  ThreadPool pool(1);
  for (const auto& cubes : { Graded(), Rough() })
  {
    const Case made(cubes, scenes::Standard);
    const HexBrickSource source = made.Source(pool);
    std::vector<float> values;
    for (int i = 0; i < n.x * n.y * n.z; ++i)
    {
      const glm::ivec3 p(i % n.x, i / n.x % n.y, i / n.x / n.y);
      values.push_back(static_cast<float>(source.Field().AtPoint(p)));
    }
    RayScene scene = made.Scene(0.6);
    const glm::dvec3 normal(0.6, -0.2, 0.8);
    scene.ClipPlanes = { { normal, -glm::dot(normal, glm::dvec3(30.0, 16.0, 12.0)) } };
    const auto expectSame = [&](double bound)
    {
      const FloatImage expected = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
      EXPECT_LE(MaxDifference(Draw(made, scene), expected), bound);
    };
    expectSame(OneLevel);
    scene.Blend.Mode = BlendMode::Average;
    expectSame(OneLevel);
    scene.Blend.Mode = BlendMode::Maximum;
    expectSame(OneLevel);
    scene.Blend.Mode = BlendMode::Minimum;
    expectSame(OneLevel);
  }
}

FloatImage DrawOnRanks(const Case& made, const RayScene& scene, int ranks)
{
  return meshes::DrawOnRanks(made, scene, { 13, 6, 6 }, ranks);
}

TEST(HexPictures, RanksDrawThePictureOfOne)
{
  for (const auto& cubes : { Graded(), Rough() })
  {
    const Case made(cubes, scenes::Standard);
    for (const bool shaded : { false, true })
    {
      for (const double distance : { 1.4, 0.1 })
      {
        RayScene scene = made.Scene(0.7, distance);
        scene.DomainCells = { glm::ivec3(0), glm::ivec3(60, 30, 30) };
        scene.Shading.On = shaded;
        const FloatImage alone = DrawOnRanks(made, scene, 1);
        double strongest = 0.0;
        for (const glm::vec4& pixel : alone.Pixels)
        {
          strongest = std::max(strongest, double(pixel.a));
        }
        EXPECT_GT(strongest, 0.3);
        for (const int ranks : { 2, 3, 4 })
        {
          EXPECT_LT(MaxDifference(DrawOnRanks(made, scene, ranks), alone), 1e-5) << ranks;
        }
      }
    }
  }
}

} // namespace
