// SPDX-License-Identifier: BSD-3-Clause
// Scenes in which ray casters fail: functions with steps, shells thinner than a cell, eyes and rays
// in the faces of bricks, cells a thousand times as long as wide, grids far from the origin, and
// columns of one cell. Each is held to the reference in double, in all ways to blend.
#include "Render/Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

/// Float against double; where they round apart, a sample takes the neighbouring entry of the
/// table.
constexpr double Tolerance = 1e-4;
/// Of projections one such entry is all that a pixel has.
constexpr double OneEntry = 1e-3;
constexpr BlendMode Modes[] = { BlendMode::Composite, BlendMode::Maximum, BlendMode::Minimum,
  BlendMode::Average };

/// Draws in all modes, in bricks of several sizes, and compares with the reference.
template <class T>
void ExpectTheReference(RayScene scene, const std::vector<T>& values, const glm::ivec3& n,
  double allowed = Tolerance, double allowedOfProjections = OneEntry)
{
  const auto value = scenes::ValueOf(values, n);
  for (const BlendMode mode : Modes)
  {
    scene.Blend.Mode = mode;
    const FloatImage reference = ReferenceImage(scene, value, scenes::NearestEntry(scene.Transfer));
    float strongest = 0.0f;
    for (const glm::vec4& pixel : reference.Pixels)
    {
      strongest = std::max(strongest, pixel.a);
    }
    // The lowest value of a ray is invisible in some scenes.
    EXPECT_TRUE(strongest > 0.03f || mode != BlendMode::Composite) << "the test sees nothing";
    for (const int brick : { 8, 16, 32 })
    {
      const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n), { brick }).Image;
      EXPECT_LE(MaxDifference(image, reference),
        mode == BlendMode::Composite ? allowed : allowedOfProjections)
        << "mode " << static_cast<int>(mode) << ", bricks of " << brick;
    }
  }
}

/// Nothing below an entry, and from it on so opaque.
TransferFunction StepAt(double part, double opacity, int entries)
{
  return scenes::Tabulate(
    [=](double value)
    {
      glm::dvec4 entry = scenes::Smooth(value);
      entry.a = value < part ? 0.0 : opacity;
      return entry;
    },
    entries);
}

/// A picture without mirror images: no sample lies on a step by symmetry.
RayScene SceneOf(const glm::ivec3& n, double step = 0.8)
{
  RayScene scene = scenes::Scene(n, { 45, 38 });
  scene.SampleDistance = step;
  return scene;
}

TEST(HardScenes, StepsOfOneCode)
{
  const glm::ivec3 n(33, 30, 34);
  const auto codes = scenes::Sampled<std::uint8_t>(scenes::Standard, n, 255.0);
  const auto floats = scenes::Sampled(scenes::Standard, n);
  for (const double opacity : { 0.3, 0.95, 0.999999 })
  {
    for (const int entries : { 2, 256, 4096 })
    {
      SCOPED_TRACE(testing::Message() << opacity << ", " << entries << " entries");
      RayScene scene = SceneOf(n);
      scene.Transfer = StepAt(0.3, opacity, entries);
      ExpectTheReference(scene, floats, n);
      scene.Transfer.High = 255.0;
      scene.Blend.White = 255.0;
      ExpectTheReference(scene, codes, n);
    }
  }
}

TEST(HardScenes, NearlyOpaque)
{
  const glm::ivec3 n(20, 23, 21);
  const auto values = scenes::Sampled(scenes::Standard, n);
  for (const double opacity : { 0.99, 1.0 - 1e-6, 1.0 })
  {
    for (const double step : { 0.05, 0.8, 5.0 })
    {
      SCOPED_TRACE(testing::Message() << opacity << ", step " << step);
      RayScene scene = SceneOf(n, step);
      scene.Transfer = scenes::Tabulate(
        [=](double value) { return glm::dvec4(glm::dvec3(scenes::Smooth(value)), opacity); });
      ExpectTheReference(scene, values, n);
    }
  }
}

TEST(HardScenes, ShellsThinnerThanACell)
{
  const glm::ivec3 n(33, 30, 34);
  const auto values = scenes::Sampled(scenes::Radial, n);
  for (const double width : { 0.02, 0.002 })
  {
    for (const double step : { 0.1, 0.8 })
    {
      SCOPED_TRACE(testing::Message() << width << ", step " << step);
      RayScene scene = SceneOf(n, step);
      scene.Transfer = scenes::Tabulate(
        [=](double value)
        {
          glm::dvec4 entry = scenes::Smooth(value);
          entry.a = std::abs(value - 0.4) < 0.5 * width ? 0.8 : 0.0;
          return entry;
        });
      ExpectTheReference(scene, values, n);
    }
  }
}

/// The eye looks from somewhere in index space.
void LookFrom(RayScene& scene, const glm::dvec3& eye, const glm::dvec3& at)
{
  const glm::dvec3 way = glm::normalize(at - eye);
  const glm::dvec3 up = std::abs(way.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const glm::dmat4 projection = glm::perspective(0.9, 1.0, 0.01, 200.0);
  scene.Viewport = { { 0, 0 }, { 33, 33 } }; // odd: the middle ray goes straight ahead
  scene.Camera = RayCamera(projection * glm::lookAt(eye, at, up), scene.Viewport.Hi,
    scenes::CentreOf(scene.DomainCells, scene.IndexToWorld));
}

TEST(HardScenes, EyesInBricksAndOnTheirFaces)
{
  const glm::ivec3 n(49, 33, 41);
  const auto values = scenes::Sampled(scenes::Standard, n);
  const glm::dvec3 eyes[] = { { 20.3, 9.1, 11.7 }, { 16, 16, 16 }, { 16, 8.5, 20.2 },
    { 32, 16, 3.3 }, { 24, 24, 24 } };
  const glm::dvec3 ways[] = { { 1, 0, 0 }, { 0, -1, 0 }, { 0, 0, 1 }, { -1, 1, 0 }, { 0, 1, -1 },
    { 1, 1, 1 }, { 0.3, -0.7, 0.2 } };
  for (const glm::dvec3& eye : eyes)
  {
    for (const glm::dvec3& way : ways)
    {
      SCOPED_TRACE(testing::Message() << eye.x << " " << eye.y << " " << eye.z << " along " << way.x
                                      << " " << way.y << " " << way.z);
      RayScene scene = SceneOf(n, 0.7);
      LookFrom(scene, eye, eye + way);
      ExpectTheReference(scene, values, n);
    }
  }
}

/// From outside: the middle column and row of pixels have rays in the faces of bricks.
TEST(HardScenes, RaysInTheFacesOfBricks)
{
  const glm::ivec3 n(49, 33, 41);
  const auto values = scenes::Sampled(scenes::Standard, n);
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const double from : { -30.0, 80.0 })
    {
      SCOPED_TRACE(testing::Message() << axis << " from " << from);
      glm::dvec3 eye(16.0);
      glm::dvec3 at(16.0);
      eye[axis] = from;
      RayScene scene = SceneOf(n, 0.7);
      LookFrom(scene, eye, at);
      ExpectTheReference(scene, values, n);
    }
  }
}

/// In diagonals: from farther away columns lie between pixels.
constexpr double VeryClose = 0.04;

TEST(HardScenes, CellsAThousandTimesAsLongAsWide)
{
  const glm::ivec3 n(22, 19, 25);
  const auto values = scenes::Sampled(scenes::Standard, n);
  for (const glm::dvec3& spacing :
    { glm::dvec3(1, 1, 1000), { 1000, 1, 1 }, { 1, 0.001, 1 }, { 1e-3, 1, 1e3 } })
  {
    for (const double step : { 0.8, 20.0 })
    {
      SCOPED_TRACE(testing::Message()
                   << spacing.x << ":" << spacing.y << ":" << spacing.z << ", step " << step);
      const double shortest = std::min({ spacing.x, spacing.y, spacing.z });
      RayScene scene =
        scenes::Scene(n, { 45, 38 }, glm::scale(glm::dmat4(1.0), spacing), VeryClose);
      scene.SampleDistance = step * std::max(shortest, 0.002 * std::max(spacing.x, spacing.z));
      scene.Transfer.UnitDistance = shortest;
      ExpectTheReference(scene, values, n);
      // Across the long edge.
      LookFrom(scene, spacing * glm::dvec3(10, 9, 12), spacing * glm::dvec3(11, 10, 12.5));
      ExpectTheReference(scene, values, n);
    }
  }
}

TEST(HardScenes, SmallCellsFarFromTheOrigin)
{
  const glm::ivec3 n(22, 19, 25);
  const auto values = scenes::Sampled(scenes::Standard, n);
  for (const double spacing : { 1.0, 0.01, 1e-4 })
  {
    SCOPED_TRACE(spacing);
    glm::dmat4 toWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(1e7, -1e7, 3e7));
    toWorld = glm::scale(toWorld, glm::dvec3(spacing));
    RayScene scene = scenes::Scene(n, { 45, 38 }, toWorld);
    scene.SampleDistance = 0.8 * spacing;
    scene.Transfer.UnitDistance = spacing;
    // The camera's matrix itself has no more digits: 1e-9 of 3e7 is a hundredth of a cell.
    ExpectTheReference(scene, values, n);
  }
}

TEST(HardScenes, ColumnsAndPlatesOfOneCell)
{
  for (const glm::ivec3& n : { glm::ivec3(2, 2, 300), { 300, 2, 2 }, { 2, 150, 2 }, { 2, 90, 70 },
         { 70, 2, 90 }, { 90, 70, 2 } })
  {
    for (const double step : { 0.3, 4.0 })
    {
      SCOPED_TRACE(testing::Message() << n.x << " " << n.y << " " << n.z << ", step " << step);
      RayScene scene = scenes::Scene(n, { 45, 38 }, glm::dmat4(1.0), VeryClose);
      scene.SampleDistance = step;
      scene.Transfer.UnitDistance = 0.05;
      ExpectTheReference(scene, scenes::Sampled(scenes::Standard, n), n);
      // Along the column, and past its end.
      const glm::dvec3 last(n - 1);
      LookFrom(scene, 0.05 * last, last);
      ExpectTheReference(scene, scenes::Sampled(scenes::Standard, n), n);
    }
  }
}

/// Without a cell there is nothing to integrate.
TEST(HardScenes, RowsOfSamplesHaveNoVolume)
{
  for (const glm::ivec3& n : { glm::ivec3(1, 1, 50), { 50, 1, 1 }, { 1, 50, 1 }, { 1, 30, 20 },
         { 20, 1, 30 }, { 20, 30, 1 }, { 1, 1, 1 } })
  {
    RayScene scene = scenes::Scene(glm::ivec3(20), { 45, 38 });
    scene.DomainCells = { glm::ivec3(0), n - 1 };
    const auto values = scenes::Sampled(scenes::Linear, n);
    for (const BlendMode mode : Modes)
    {
      scene.Blend.Mode = mode;
      EXPECT_TRUE(scenes::Draw(scene, scenes::ArrayOf(values, n)).Image.Pixels.empty());
    }
  }
}

} // namespace
