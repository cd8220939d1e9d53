// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

constexpr float Opacity = 0.05f;

RayScene ConstantScene(const glm::ivec3& n, double step, bool parallel)
{
  RayScene scene = scenes::Scene(n, { 60, 50 }, glm::dmat4(1.0), 1.4, parallel);
  scene.Transfer.Entries.assign(2, { 0.25f, 0.5f, 1.0f, Opacity });
  scene.Transfer.UnitDistance = 1.5;
  scene.SampleDistance = step;
  return scene;
}

/// Length of a ray inside [0, size], between t0 and t1.
double LengthInside(const Ray& ray, const glm::dvec3& size, double t0, double t1)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    const double a = -ray.Origin[axis] / ray.Direction[axis];
    const double b = (size[axis] - ray.Origin[axis]) / ray.Direction[axis];
    t0 = std::fmax(t0, std::fmin(a, b));
    t1 = std::fmin(t1, std::fmax(a, b));
  }
  return std::fmax(t1 - t0, 0.0);
}

glm::vec4 PixelOf(const FloatImage& image, int x, int y)
{
  return Intersection(image.Rect, { { x, y }, { x + 1, y + 1 } }).Empty() ? glm::vec4(0.0f)
                                                                          : image.At(x, y);
}

void ExpectClosedForm(const RayScene& scene, const FloatImage& image, const glm::dvec3& size,
  const std::function<double(const Ray&, int, int)>& end)
{
  for (int y = scene.Viewport.Lo.y; y < scene.Viewport.Hi.y; ++y)
  {
    for (int x = scene.Viewport.Lo.x; x < scene.Viewport.Hi.x; ++x)
    {
      const Ray ray = scene.Camera.RayOf(x, y);
      const double length = LengthInside(ray, size, ray.Near, end(ray, x, y));
      const double alpha = 1.0 - std::pow(1.0 - Opacity, length / scene.Transfer.UnitDistance);
      const glm::vec4 pixel = PixelOf(image, x, y);
      ASSERT_NEAR(pixel.a, alpha, 1e-4);
      ASSERT_NEAR(pixel.r, 0.25 * alpha, 1e-4);
      ASSERT_NEAR(pixel.b, alpha, 1e-4);
    }
  }
}

/// 1 - (1 - a)^(L / unit), at any step: what is left at the ends of a ray counts by its length.
TEST(Opacity, ConstantVolumeAgainstTheClosedForm)
{
  const glm::ivec3 n(20, 13, 17);
  const std::vector<float> values(n.x * n.y * n.z, 3.0f);
  for (const bool parallel : { false, true })
  {
    for (const double step : { 0.1, 0.77, 1.0, 5.0, 33.0, 1e4 })
    {
      const RayScene scene = ConstantScene(n, step, parallel);
      const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
      ExpectClosedForm(
        scene, image, glm::dvec3(n - 1), [](const Ray& ray, int, int) { return ray.Far; });
    }
  }
}

TEST(Opacity, GeometryEndsRays)
{
  const glm::ivec3 n(20, 13, 17);
  const std::vector<float> values(n.x * n.y * n.z, 3.0f);
  for (const bool parallel : { false, true })
  {
    RayScene scene = ConstantScene(n, 0.9, parallel);
    scene.Viewport = { { 3, 2 }, { 55, 50 } };
    // In front, inside, behind, and no geometry at all.
    const auto depthAt = [](int x, int y) { return 0.02f * ((x * 7 + y * 3) % 51); };
    for (int y = 2; y < 50; ++y)
    {
      for (int x = 3; x < 55; ++x)
      {
        scene.Depth.push_back(depthAt(x, y));
      }
    }
    const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
    ExpectClosedForm(scene, image, glm::dvec3(n - 1),
      [&](const Ray& ray, int x, int y)
      { return scene.Camera.DistanceAtDepth(ray, x, y, std::fmin(depthAt(x, y), 1.0f)); });

    const std::vector<float> varied = scenes::Sampled(scenes::Standard, n);
    scene.Transfer = scenes::Tabulate(scenes::Smooth);
    const FloatImage drawn = scenes::Draw(scene, scenes::ArrayOf(varied, n)).Image;
    const FloatImage reference =
      ReferenceImage(scene, scenes::ValueOf(varied, n), scenes::NearestEntry(scene.Transfer));
    EXPECT_LE(MaxDifference(drawn, reference), 1e-4);
  }
}

TEST(Opacity, ClipPlanesCutTheVolume)
{
  const glm::ivec3 n(20);
  const std::vector<float> values(n.x * n.y * n.z, 3.0f);
  RayScene scene = ConstantScene(n, 0.9, false);
  const glm::dvec3 centre(9.5);
  const glm::dmat4 view = glm::lookAt(centre + glm::dvec3(3, 4, 30), centre, glm::dvec3(0, 1, 0));
  scene.Camera =
    RayCamera(glm::perspective(0.6, 1.2, 27.0, 34.0) * view, { 60, 50 }, glm::dvec3(0.0));
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
  EXPECT_GT(image.At(30, 25).a, 0.1f);
  ExpectClosedForm(
    scene, image, glm::dvec3(n - 1), [](const Ray& ray, int, int) { return ray.Far; });
}

TEST(Opacity, OpaqueEntries)
{
  const glm::ivec3 n(8);
  const std::vector<float> values(n.x * n.y * n.z, 3.0f);
  RayScene scene = ConstantScene(n, 0.5, false);
  scene.Transfer.Entries.assign(2, { 0.25f, 0.5f, 1.0f, 1.0f });
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
  EXPECT_EQ(image.At(30, 25), glm::vec4(0.25f, 0.5f, 1.0f, 1.0f));
}

TEST(Opacity, LimitEndsRaysAndSavesSamples)
{
  const glm::ivec3 n(64, 64, 64);
  std::vector<float> values(n.x * n.y * n.z, 3.0f);
  for (std::size_t i = 0; i < values.size(); i += 2)
  {
    values[i] = 2.5f; // bricks of one value take no samples anyway
  }
  RayScene scene = ConstantScene(n, 1.0, false);
  scene.Transfer.Entries.assign(2, { 1.0f, 1.0f, 1.0f, 0.5f });
  const scenes::Drawn all = scenes::Draw(scene, scenes::ArrayOf(values, n));
  scene.OpacityLimit = 0.99f;
  const scenes::Drawn some = scenes::Draw(scene, scenes::ArrayOf(values, n));
  EXPECT_LT(some.Statistics.SamplesTaken, all.Statistics.SamplesTaken / 2);
  EXPECT_LE(MaxDifference(all.Image, some.Image), 0.01 + 1e-6);
}

} // namespace
