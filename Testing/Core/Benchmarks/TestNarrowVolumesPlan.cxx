// SPDX-License-Identifier: BSD-3-Clause
// Volumes of which few pixels see something: is the error still below the estimate?
#include "ConvergedImage.h"
#include "Picture.h"
#include "PlanTesting.h"
#include "StandardScenes.h"

#include "Render/Sampling/ProbeSpacing.h"

#include <gtest/gtest.h>

#include <cmath>

using namespace banyan;
using namespace banyan::bench;
using namespace banyan::plan_testing;

namespace
{

using Field = double (*)(double x, double y, double z); // over [0, 1]^3

double Waves(double x, double y, double z)
{
  return 0.5 + 0.25 * std::sin(40.0 * z + 3.0 * x) +
         0.25 * std::sin(25.0 * z - 5.0 * y) * std::cos(4.0 * x);
}

/// Two balls are all that S2 shows of it.
double Balls(double x, double y, double z)
{
  const auto ball = [&](double a, double b, double c)
  { return std::exp(-40.0 * ((x - a) * (x - a) + (y - b) * (y - b) + (z - c) * (z - c))); };
  const double wave = 0.1 + 0.1 * std::sin(20.0 * x) * std::sin(15.0 * y);
  return 0.8 * (ball(0.35, 0.4, 0.5) + ball(0.65, 0.6, 0.4)) + wave;
}

/// One thin bright layer.
double Layer(double x, double, double z)
{
  return 0.05 + 0.9 * std::exp(-4000.0 * (z - 0.5) * (z - 0.5) - 3.0 * (x - 0.5) * (x - 0.5));
}

std::shared_ptr<const Volume> Sampled(Field field, const glm::ivec3& n)
{
  auto volume = std::make_shared<Volume>();
  volume->Samples = n;
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      for (int x = 0; x < n.x; ++x)
      {
        volume->Floats.push_back(
          static_cast<float>(field(x / (n.x - 1.0), y / (n.y - 1.0), z / (n.z - 1.0))));
      }
    }
  }
  return volume;
}

struct View
{
  const char* Name;
  glm::dvec3 From;
  glm::dvec3 Up;
};

const View Views[] = { { "aslant", { 0.48, 0.36, 0.80 }, { 0, 1, 0 } },
  { "from the side", { 1.0, 0.02, 0.01 }, { 0, 0, 1 } },
  { "from the end", { 0.05, 0.03, 1.0 }, { 0.5, 0.3, 1.0 } } };

BenchScene Scene(
  std::shared_ptr<const Volume> volume, StandardFunction function, int picture, const View& view)
{
  const glm::dvec3 size = volume->Size();
  BenchScene scene = StandardScene(std::move(volume), function, false, picture);
  scene.UnitDistance = 1.0;
  scene.Center = 0.5 * size;
  scene.Eye = scene.Center + 1.3 * glm::length(size) * glm::normalize(view.From);
  scene.Up = view.Up;
  return scene;
}

class NarrowVolumesPlan : public testing::TestWithParam<glm::ivec3>
{
};

TEST_P(NarrowVolumesPlan, TheErrorStaysBelowTheEstimate)
{
  ThreadPool pool(2);
  for (const Field field : { Waves, Balls, Layer })
  {
    const auto volume = Sampled(field, GetParam());
    for (const StandardFunction function : { StandardFunction::S1, StandardFunction::S2 })
    {
      for (const View& view : Views)
      {
        const BenchScene scene = Scene(volume, function, 192, view);
        SCOPED_TRACE(std::string(view.Name) + ", field " +
                     (field == Waves    ? "waves"
                       : field == Balls ? "balls"
                                        : "layer") +
                     (function == StandardFunction::S1 ? ", S1" : ", S2"));
        const FloatImage converged = ConvergedImage(scene, 1.0 / 8.0, pool);
        for (const double tolerance : { 0.5, 1.0, 8.0 })
        {
          Drawer drawer(scene);
          const SamplingPlan plan = drawer.Plan(tolerance, 2);
          EXPECT_LE(ErrorOf(drawer.Draw(plan), converged).Largest, plan.EstimatedError)
            << "at a tolerance of " << tolerance;
        }
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(SamplingPlan, NarrowVolumesPlan,
  testing::Values(glm::ivec3(16, 16, 512), glm::ivec3(5, 5, 41), glm::ivec3(9, 100, 100)));

TEST(ProbeSpacing, GoesByWhatTheVolumeTakesUp)
{
  const auto spacing = [](const glm::ivec3& samples, int picture, const View& view)
  {
    return ProbeSpacing(
      ToRayScene(Scene(Sampled(Waves, samples), StandardFunction::S1, picture, view), 1.0, 1.0f));
  };
  EXPECT_EQ(spacing(glm::ivec3(33), 1024, Views[0]), 16);
  EXPECT_EQ(spacing({ 3, 3, 129 }, 192, Views[1]), 1);
  const int column = spacing({ 9, 9, 129 }, 1024, Views[1]);
  EXPECT_GT(column, 1);
  EXPECT_LT(column, 16);
}

TEST(ProbeSpacing, GoesByWhatProbesSee)
{
  EXPECT_EQ(ProbeSpacingAfter(16, EnoughProbes), 16);
  EXPECT_EQ(ProbeSpacingAfter(1, 0), 1);
  EXPECT_EQ(ProbeSpacingAfter(16, 0), 1);
  EXPECT_EQ(ProbeSpacingAfter(16, EnoughProbes / 16), 4);
  EXPECT_LT(ProbeSpacingAfter(2, EnoughProbes / 4 - 1), 2);
}

TEST(ProbeSpacing, AnEyeInsideSeesTheVolumeEverywhere)
{
  BenchScene scene = Scene(Sampled(Waves, glm::ivec3(33)), StandardFunction::S1, 512, Views[0]);
  scene.Eye = scene.Center + glm::dvec3(1.0, 0.5, 0.2);
  const RayScene drawn = ToRayScene(scene, 1.0, 1.0f);
  EXPECT_EQ(ProbeSpacing(drawn), 8);
  EXPECT_EQ(VolumeOnScreen(drawn), drawn.Viewport);
}

} // namespace
