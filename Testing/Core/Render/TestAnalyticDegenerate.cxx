// SPDX-License-Identifier: BSD-3-Clause
// Cameras and values at the edge of sense: pictures stay numbers in [0, 1], and where the integral
// is known they still show it.
#include "Render/Analytic.h"

#include "Base/Error.h"

#include <random>

namespace
{

using namespace banyan;
using analytic::OneLevel;

const glm::ivec2 Pixels(17, 13);
constexpr double FullTurn = 6.283185307179586;

bool IsPicture(const FloatImage& image)
{
  for (const glm::vec4& pixel : image.Pixels)
  {
    for (int channel = 0; channel < 4; ++channel)
    {
      // False for a NaN.
      if (!(pixel[channel] >= 0.0f && pixel[channel] <= 1.0f + 1e-5f))
      {
        return false;
      }
    }
  }
  return true;
}

/// The standard field, and the same with one sample in seven that is no finite number, or huge.
std::vector<float> Values(const glm::ivec3& n, bool damaged)
{
  std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  const float special[] = { NAN, INFINITY, -INFINITY, std::numeric_limits<float>::max(),
    std::numeric_limits<float>::lowest(), std::numeric_limits<float>::denorm_min(), -0.0f };
  std::mt19937 random(3);
  for (std::size_t i = 0; damaged && i < values.size() / 7; ++i)
  {
    values[random() % values.size()] = special[i % 7];
  }
  return values;
}

struct Look
{
  glm::dvec3 Eye;
  glm::dvec3 At;
  double AngleDegrees = 45.0;
  double Near = 0.1;
  double Far = 1000.0;
};

RayScene SceneOf(const glm::ivec3& n, const Look& look, double step = 0.8)
{
  RayScene scene = scenes::Scene(n, Pixels);
  const glm::dvec3 way = glm::normalize(look.At - look.Eye);
  const glm::dvec3 up = std::abs(way.y) < 0.99 ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
  const double aspect = static_cast<double>(Pixels.x) / Pixels.y;
  const glm::dmat4 projection =
    glm::perspective(look.AngleDegrees / 360.0 * FullTurn, aspect, look.Near, look.Far);
  scene.Camera = RayCamera(projection * glm::lookAt(look.Eye, look.At, up), Pixels,
    scenes::CentreOf(scene.DomainCells, glm::dmat4(1.0)));
  scene.SampleDistance = step;
  return scene;
}

/// Eyes in corners, on faces, edges and samples, inside, in every direction along and between axes.
std::vector<Look> AwkwardLooks(const glm::ivec3& n)
{
  const glm::dvec3 last(n - 1);
  const glm::dvec3 eyes[] = { glm::dvec3(0), last, 0.5 * last, glm::dvec3(3), { 0, 5.5, 0 },
    { last.x, 4, 4.25 }, { 8, 8, last.z }, { -1e-9, 4, 4 }, { 1e-9, 4, 4 } };
  std::vector<Look> looks;
  for (const glm::dvec3& eye : eyes)
  {
    for (int direction = 0; direction < 27; ++direction)
    {
      const glm::dvec3 way(direction % 3 - 1, direction / 3 % 3 - 1, direction / 9 - 1);
      if (direction != 13)
      {
        looks.push_back({ eye, eye + way });
      }
    }
  }
  return looks;
}

TEST(AnalyticDegenerate, EyesAnywhereSeeNumbers)
{
  const glm::ivec3 n(13, 12, 14);
  for (const bool damaged : { false, true })
  {
    const std::vector<float> values = Values(n, damaged);
    const SampleArray array = scenes::ArrayOf(values, n);
    for (const Look& look : AwkwardLooks(n))
    {
      EXPECT_TRUE(IsPicture(scenes::Draw(SceneOf(n, look), array).Image))
        << look.Eye.x << " " << look.Eye.y << " " << look.Eye.z << " to " << look.At.x << " "
        << look.At.y << " " << look.At.z;
    }
  }
}

TEST(AnalyticDegenerate, EyesAnywhereSeeTheIntegral)
{
  const glm::ivec3 n(13, 12, 14);
  const glm::dvec3 size(n - 1);
  const std::vector<float> values = scenes::Sampled([](const glm::dvec3&) { return 0.5; }, n);
  const SampleArray array = scenes::ArrayOf(values, n);
  const double extinction = 0.2;
  int looks = 0;
  for (const Look& look : AwkwardLooks(n))
  {
    RayScene scene = SceneOf(n, look);
    scene.Transfer = scenes::Tabulate(
      [&](double) { return glm::dvec4(1, 1, 1, analytic::OpacityOf(extinction)); });
    // Rays that run in a face may count either way: they are left out, and so are those views.
    bool grazes = false;
    double longest = 0.0;
    for (int y = 0; y < Pixels.y; ++y)
    {
      for (int x = 0; x < Pixels.x; ++x)
      {
        const analytic::Chord chord = analytic::ChordOf(scene.Camera, size, x, y);
        longest = std::max(longest, chord.Length());
        for (int axis = 0; axis < 3; ++axis)
        {
          const double where = chord.Origin[axis];
          const bool inFace = std::abs(where) < 1e-6 || std::abs(where - size[axis]) < 1e-6;
          grazes = grazes || (inFace && std::abs(chord.Direction[axis]) < 1e-6);
        }
      }
    }
    if (!grazes && longest > 2.0)
    {
      ++looks;
      analytic::ExpectIntegral(
        scenes::Draw(scene, array).Image, scene, size,
        [&](const analytic::Chord& chord)
        { return glm::dvec4(analytic::OpacityOf(extinction * chord.Length())); },
        0.1 * OneLevel);
    }
  }
  EXPECT_GT(looks, 60);
}

TEST(AnalyticDegenerate, CamerasOfAllAnglesAndDistancesSeeNumbers)
{
  const glm::ivec3 n(13, 12, 14);
  const glm::dvec3 centre = 0.5 * glm::dvec3(n - 1);
  const glm::dvec3 way = glm::normalize(glm::dvec3(1, 2, 3));
  const Look looks[] = {
    { centre + 20.0 * way, centre, 179.9 },
    { centre + 20.0 * way, centre, 1e-4 },
    { centre + 1e6 * way, centre, 1e-3, 1e5, 2e6 },
    { centre + 20.0 * way, centre, 45.0, 1e-9, 1e12 },
    { centre + 20.0 * way, centre, 45.0, 19.9999, 20.0001 },
    { centre + 20.0 * way, centre + 40.0 * way },
    { centre + 1e-9 * way, centre, 90.0, 1e-6, 100.0 },
  };
  for (const bool damaged : { false, true })
  {
    const std::vector<float> values = Values(n, damaged);
    for (const Look& look : looks)
    {
      const RayScene scene = SceneOf(n, look);
      EXPECT_TRUE(IsPicture(scenes::Draw(scene, scenes::ArrayOf(values, n)).Image));
    }
  }
}

TEST(AnalyticDegenerate, StepsOfAllSizesSeeNumbers)
{
  const glm::ivec3 n(9, 8, 10);
  const glm::dvec3 centre = 0.5 * glm::dvec3(n - 1);
  const std::vector<float> values = Values(n, true);
  for (const double step : { 1e-3, 0.1, 1.0, 100.0, 1e9 })
  {
    const RayScene scene = SceneOf(n, { centre + glm::dvec3(9, 7, 20), centre }, step);
    EXPECT_TRUE(IsPicture(scenes::Draw(scene, scenes::ArrayOf(values, n)).Image)) << step;
  }
}

TEST(AnalyticDegenerate, OpacitiesAtTheirEndsAreExact)
{
  const glm::ivec3 n(9, 8, 10);
  const glm::dvec3 size(n - 1);
  const std::vector<float> values = scenes::Sampled([](const glm::dvec3&) { return 0.5; }, n);
  RayScene scene = scenes::Scene(n, Pixels);
  for (const double opacity : { 1e-4, 1.0 - 1e-6, 1.0 })
  {
    scene.Transfer = scenes::Tabulate([&](double) { return glm::dvec4(1, 1, 1, opacity); });
    const scenes::Drawn drawn = scenes::Draw(scene, scenes::ArrayOf(values, n));
    EXPECT_TRUE(IsPicture(drawn.Image));
    const analytic::Chord chord = analytic::ChordOf(scene.Camera, size, Pixels.x / 2, Pixels.y / 2);
    const double truth = 1.0 - std::pow(1.0 - opacity, chord.Length());
    EXPECT_GT(chord.Length(), 5.0);
    EXPECT_NEAR(drawn.Image.At(Pixels.x / 2, Pixels.y / 2).a, truth, 2e-6);
  }
}

TEST(AnalyticDegenerate, CamerasWithoutAPictureAreRefused)
{
  const glm::dmat4 projection = glm::perspective(1.0, 1.0, 0.1, 10.0);
  const glm::dmat4 view =
    glm::lookAt(glm::dvec3(0, 5, 0), glm::dvec3(0), glm::dvec3(0, 1, 0)); // along its up
  EXPECT_THROW(RayCamera(projection * view, Pixels, glm::dvec3(0.0)), Error);
  const glm::dmat4 nowhere = glm::lookAt(glm::dvec3(1), glm::dvec3(1), glm::dvec3(0, 1, 0));
  EXPECT_THROW(RayCamera(projection * nowhere, Pixels, glm::dvec3(0.0)), Error);
  EXPECT_THROW(RayCamera(glm::dmat4(NAN), Pixels, glm::dvec3(0.0)), Error);
  EXPECT_THROW(RayCamera(glm::dmat4(0.0), Pixels, glm::dvec3(0.0)), Error);
}

} // namespace
