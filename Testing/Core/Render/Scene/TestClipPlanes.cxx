// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

const glm::ivec3 N{ 33, 26, 37 };

/// Through the middle of the volume, in a given direction.
ClipPlane Through(const RayScene& scene, const glm::dvec3& normal, double offset = 0.0)
{
  const glm::dvec3 centre = scenes::CentreOf(scene.DomainCells, scene.IndexToWorld);
  return { normal, offset - glm::dot(normal, centre) };
}

struct Case
{
  std::vector<float> Values = scenes::Sampled(scenes::Standard, N);
  RayScene Scene;

  explicit Case(
    const glm::dmat4& toWorld = glm::dmat4(1.0), double distance = 1.4, bool parallel = false)
    : Scene(scenes::Scene(N, { 61, 50 }, toWorld, distance, parallel))
  {
  }

  scenes::Drawn Draw(int brickCells = 16) const
  {
    return scenes::Draw(this->Scene, scenes::ArrayOf(this->Values, N), { brickCells, 1, 1u << 30 });
  }

  double Error() const
  {
    return MaxDifference(
      this->Draw().Image, ReferenceImage(this->Scene, scenes::ValueOf(this->Values, N),
                            scenes::NearestEntry(this->Scene.Transfer)));
  }
};

TEST(ClipPlanes, AgreeWithTheReference)
{
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  glm::dmat4 toWorld = glm::rotate(glm::dmat4(1.0), 0.7, glm::normalize(glm::dvec3(1, 2, 3)));
  toWorld = glm::scale(toWorld, glm::dvec3(0.5, -1.25, 2.0));
  for (int i = 0; i < 12; ++i)
  {
    Case test(i % 3 == 0 ? toWorld : glm::dmat4(1.0), i % 4 == 1 ? 0.1 : 1.4, i % 2 == 0);
    const FloatImage whole = test.Draw().Image;
    for (int plane = 0; plane <= i % 3; ++plane)
    {
      const glm::dvec3 direction(normal(random), normal(random), normal(random));
      test.Scene.ClipPlanes.push_back(Through(test.Scene, direction, 2.0 * normal(random)));
    }
    EXPECT_LE(test.Error(), 1e-4) << i;
    EXPECT_GT(MaxDifference(test.Draw().Image, whole), 0.01) << i;
  }
}

TEST(ClipPlanes, CropBoxAgreesWithTheReference)
{
  for (const bool parallel : { false, true })
  {
    Case test(glm::dmat4(1.0), 1.4, parallel);
    AddCropBox(test.Scene.ClipPlanes, { 4.3, 2.0, -INFINITY }, { 20.7, INFINITY, 30.05 });
    EXPECT_EQ(test.Scene.ClipPlanes.size(), 4u);
    EXPECT_LE(test.Error(), 1e-4);
  }
}

TEST(ClipPlanes, PlanesAlongTheRays)
{
  // Pixel centres lie at 0, 0.5, ... 8.
  const glm::ivec3 n(9);
  const std::vector<float> values = scenes::Sampled(scenes::Radial, n);
  RayScene scene = scenes::Scene(n, { 17, 17 });
  const glm::dvec3 centre(4.0);
  scene.Camera = RayCamera(glm::ortho(-4.25, 4.25, -4.25, 4.25, 1.0, 40.0) *
                             glm::lookAt(centre + glm::dvec3(0, 0, 20), centre, { 0, 1, 0 }),
    { 17, 17 }, centre);
  scene.ClipPlanes = { { { 2.0, 0.0, 0.0 }, -5.5 }, { { 0.0, -1.0, 0.0 }, 5.25 } };
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n), { 4, 1, 1 }).Image;
  for (int i = 1; i < 16; ++i)
  {
    EXPECT_EQ(image.At(i, 6).a > 0.0f, i >= 6) << i;
    EXPECT_EQ(image.At(8, i).a > 0.0f, i <= 10) << i;
  }
}

TEST(ClipPlanes, BrickSizeChangesNoBit)
{
  Case test;
  test.Scene.SampleDistance = 0.7;
  // A face of bricks of 4 and 16, and a plane that lies askew.
  test.Scene.ClipPlanes = { { { 1.0, 0.0, 0.0 }, -16.0 },
    Through(test.Scene, { 0.3, -0.8, 0.4 }, 1.0) };
  const FloatImage image = test.Draw(16).Image;
  for (const int cells : { 1, 4, 7, 32 })
  {
    EXPECT_EQ(MaxDifference(test.Draw(cells).Image, image), 0.0) << cells;
  }
}

TEST(ClipPlanes, PlanesThatCutNothingChangeNoBit)
{
  Case test;
  const FloatImage whole = test.Draw().Image;
  test.Scene.ClipPlanes = { { { 1.0, 0.0, 0.0 }, 0.5 }, { { -1e-200, -1e-200, 0.0 }, 2e-198 },
    { { 0.0, 1e250, 1e250 }, 1e250 } };
  AddCropBox(test.Scene.ClipPlanes, glm::dvec3(-INFINITY), glm::dvec3(INFINITY));
  EXPECT_EQ(MaxDifference(test.Draw().Image, whole), 0.0);
}

TEST(ClipPlanes, BricksThatAreCutAwayAreNotLoaded)
{
  Case test;
  test.Scene.OpacityLimit = 2.0f;
  const RayStatistics whole = test.Draw(8).Statistics;
  // A quarter of the bricks is left.
  AddCropBox(test.Scene.ClipPlanes, { 0.0, 0.0, 0.0 }, { 15.9, 26.0, 15.9 });
  const RayStatistics part = test.Draw(8).Statistics;
  EXPECT_EQ(whole.BricksDrawn, 4 * 4 * 5);
  EXPECT_EQ(part.BricksDrawn, 2 * 4 * 2);
  EXPECT_EQ(part.BricksSkipped, whole.BricksDrawn - part.BricksDrawn);
  EXPECT_LT(part.SamplesTaken, whole.SamplesTaken / 3);

  test.Scene.ClipPlanes = { { { 0.0, 0.0, 1.0 }, -40.0 } };
  const scenes::Drawn nothing = test.Draw(8);
  EXPECT_EQ(nothing.Statistics.BricksDrawn, 0);
  EXPECT_TRUE(nothing.Image.Pixels.empty());
}

std::string SentenceOf(const std::vector<ClipPlane>& planes)
{
  Case test;
  test.Scene.ClipPlanes = planes;
  try
  {
    test.Draw();
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

TEST(ClipPlanes, UnusablePlanesGetASentence)
{
  const ClipPlane good{ { 1, 0, 0 }, 0 };
  EXPECT_EQ(SentenceOf({ good }), "");
  EXPECT_NE(SentenceOf({ good, { { 0, 0, 0 }, 1 } }).find("Clipping plane 1"), std::string::npos);
  EXPECT_NE(SentenceOf({ { { 1, NAN, 0 }, 0 } }).find("not finite"), std::string::npos);
  EXPECT_NE(SentenceOf({ { { 1, 0, 0 }, INFINITY } }).find("not finite"), std::string::npos);
  EXPECT_EQ(SentenceOf(std::vector<ClipPlane>(64, good)), "");
  EXPECT_NE(SentenceOf(std::vector<ClipPlane>(65, good)).find("too many"), std::string::npos);
}

} // namespace
