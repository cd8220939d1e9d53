// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

/// Float against double over some hundred samples; where they round apart, a sample takes the
/// neighbouring entry of the table.
constexpr double Tolerance = 1e-4;
/// The nearest of 4096 entries against the function itself, which the table stands for.
constexpr double TableTolerance = 5e-4;

/// @return difference to the reference that looks up the same table
template <class T>
double ErrorOf(const RayScene& scene, const std::vector<T>& values, const glm::ivec3& n)
{
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
  const auto value = scenes::ValueOf(values, n);
  const FloatImage reference = ReferenceImage(scene, value, scenes::NearestEntry(scene.Transfer));
  EXPECT_GT(reference.At(scene.Viewport.Hi.x / 2, scene.Viewport.Hi.y / 2).a, 0.03f);
  const double width = scene.Transfer.High - scene.Transfer.Low;
  const auto smooth = [&](double v) { return scenes::Smooth((v - scene.Transfer.Low) / width); };
  EXPECT_LE(MaxDifference(image, ReferenceImage(scene, value, smooth)), TableTolerance);
  return MaxDifference(image, reference);
}

double ErrorOf(const RayScene& scene, const scenes::Field& field, const glm::ivec3& n)
{
  return ErrorOf(scene, scenes::Sampled(field, n), n);
}

TEST(AgainstReference, PerspectiveFields)
{
  const glm::ivec3 n(32);
  const RayScene scene = scenes::Scene(n, { 65, 48 });
  EXPECT_LE(ErrorOf(scene, scenes::Linear, n), Tolerance);
  EXPECT_LE(ErrorOf(scene, scenes::Radial, n), Tolerance);
  EXPECT_LE(ErrorOf(scene, scenes::Standard, n), Tolerance);
}

TEST(AgainstReference, ParallelFields)
{
  const glm::ivec3 n(32);
  const RayScene scene = scenes::Scene(n, { 65, 48 }, glm::dmat4(1.0), 1.4, true);
  EXPECT_LE(ErrorOf(scene, scenes::Linear, n), Tolerance);
  EXPECT_LE(ErrorOf(scene, scenes::Radial, n), Tolerance);
  EXPECT_LE(ErrorOf(scene, scenes::Standard, n), Tolerance);
}

TEST(AgainstReference, CameraInsideTheVolume)
{
  const glm::ivec3 n(32);
  for (const double distance : { 0.01, 0.2, 0.35 })
  {
    const RayScene scene = scenes::Scene(n, { 40, 40 }, glm::dmat4(1.0), distance);
    EXPECT_LE(ErrorOf(scene, scenes::Standard, n), Tolerance);
  }
}

TEST(AgainstReference, OffAxisFrustum)
{
  const glm::ivec3 n(24);
  RayScene scene = scenes::Scene(n, { 50, 30 });
  const glm::dvec3 centre = scenes::CentreOf(scene.DomainCells, scene.IndexToWorld);
  const glm::dmat4 view = glm::lookAt(centre + glm::dvec3(5, 10, 60), centre, glm::dvec3(0, 1, 0));
  scene.Camera =
    RayCamera(glm::frustum(-0.1, 0.4, -0.3, 0.1, 0.8, 200.0) * view, { 50, 30 }, centre);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
  const FloatImage reference =
    ReferenceImage(scene, scenes::ValueOf(values, n), scenes::NearestEntry(scene.Transfer));
  EXPECT_GT(reference.At(10, 20).a, 0.03f);
  EXPECT_LE(MaxDifference(image, reference), Tolerance);
}

TEST(AgainstReference, RaysAlongTheAxes)
{
  // Directions with zeroes, and rays that run exactly inside cell faces and domain faces.
  const glm::ivec3 n(9);
  const std::vector<float> values = scenes::Sampled(scenes::Radial, n);
  for (int axis = 0; axis < 3; ++axis)
  {
    glm::dvec3 forward(0.0);
    forward[axis] = axis == 1 ? 1.0 : -1.0;
    glm::dvec3 up(0.0);
    up[(axis + 1) % 3] = 1.0;
    const glm::dvec3 centre(4.0);
    // Pixel centres lie at 0, 0.5, ... 8 exactly.
    const glm::dmat4 projection = glm::ortho(-4.25, 4.25, -4.25, 4.25, 1.0, 40.0);
    const glm::ivec2 picture(17);
    RayScene scene = scenes::Scene(n, picture);
    scene.Camera =
      RayCamera(projection * glm::lookAt(centre - 20.0 * forward, centre, up), picture, centre);
    scene.SampleDistance = 0.5;
    const FloatImage image =
      scenes::Draw(scene, scenes::ArrayOf(values, n), { 4, 1, 1u << 30 }).Image;
    const FloatImage reference =
      ReferenceImage(scene, scenes::ValueOf(values, n), scenes::NearestEntry(scene.Transfer));
    // Whether a ray in a domain face is inside is a matter of rounding: leave the rim out.
    for (int y = 1; y < 16; ++y)
    {
      for (int x = 1; x < 16; ++x)
      {
        const glm::vec4 difference = image.At(x, y) - reference.At(x, y);
        EXPECT_LE(glm::length(difference), Tolerance) << axis << " " << x << " " << y;
      }
    }
  }
}

TEST(AgainstReference, AnisotropicRotatedAndMirrored)
{
  const glm::ivec3 n(20, 31, 12);
  glm::dmat4 toWorld = glm::translate(glm::dmat4(1.0), glm::dvec3(100, -50, 7));
  toWorld = glm::rotate(toWorld, 0.8, glm::normalize(glm::dvec3(1, 2, 3)));
  const glm::dmat4 stretched = glm::scale(toWorld, glm::dvec3(0.5, 1.25, 2.0));
  const glm::dmat4 mirrored = glm::scale(toWorld, glm::dvec3(1.0, -1.0, 1.0));
  glm::dmat4 sheared = stretched;
  sheared[2] += 0.4 * sheared[0];
  for (const glm::dmat4& matrix : { stretched, mirrored, sheared })
  {
    for (const bool parallel : { false, true })
    {
      const RayScene scene = scenes::Scene(n, { 40, 30 }, matrix, 1.4, parallel);
      EXPECT_LE(ErrorOf(scene, scenes::Standard, n), Tolerance);
    }
  }
}

TEST(AgainstReference, VolumesOfAllSizes)
{
  for (const glm::ivec3& n : { glm::ivec3(2), glm::ivec3(15), glm::ivec3(16), glm::ivec3(17),
         glm::ivec3(18), glm::ivec3(2, 3, 37), glm::ivec3(41, 2, 5), glm::ivec3(13, 29, 2) })
  {
    RayScene scene = scenes::Scene(n, { 33, 33 });
    scene.SampleDistance = 0.3;
    scene.Transfer.UnitDistance = 0.2;
    EXPECT_LE(ErrorOf(scene, scenes::Linear, n), Tolerance) << n.x << " " << n.y << " " << n.z;
  }
}

TEST(AgainstReference, StepsOfAllSizes)
{
  const glm::ivec3 n(12);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  for (const double step : { 0.05, 0.37, 1.0, 3.3, 10.0, 15.0, 100.0 })
  {
    RayScene scene = scenes::Scene(n, { 33, 33 });
    scene.SampleDistance = step;
    const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n), { 4, 1, 1 }).Image;
    const FloatImage reference =
      ReferenceImage(scene, scenes::ValueOf(values, n), scenes::NearestEntry(scene.Transfer));
    EXPECT_GT(reference.At(16, 16).a, 0.05f);
    // Ten times more samples at 0.05: ten times more to round.
    EXPECT_LE(MaxDifference(image, reference), Tolerance) << step;
  }
}

template <class T>
class AgainstReferenceOfType : public testing::Test
{
};
using AllTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(AgainstReferenceOfType, AllTypes);

TYPED_TEST(AgainstReferenceOfType, WholeRangeOfTheType)
{
  const glm::ivec3 n(20);
  constexpr bool isInteger = std::is_integral_v<TypeParam>;
  using Limits = std::numeric_limits<TypeParam>;
  // Beyond 2^53 the field, made in double, has no more digits.
  const double low = isInteger ? static_cast<double>(Limits::lowest()) : -3.0;
  const double high = isInteger ? static_cast<double>(Limits::max()) * (1.0 - 1e-15) : 5.0;
  const auto values = scenes::Sampled<TypeParam>(scenes::Standard, n, high - low, low);
  RayScene scene = scenes::Scene(n, { 40, 40 });
  scene.Transfer.Low = low;
  scene.Transfer.High = high;
  EXPECT_LE(ErrorOf(scene, values, n), Tolerance);
}

TYPED_TEST(AgainstReferenceOfType, SmallRangeAtALargeOffset)
{
  if constexpr (sizeof(TypeParam) >= 4 && !std::is_same_v<TypeParam, float>)
  {
    const glm::ivec3 n(20);
    const bool isInteger = std::is_integral_v<TypeParam>;
    const double low = isInteger ? 1e9 : 1e6;
    const double width = isInteger ? 50.0 : 0.1;
    const auto values = scenes::Sampled<TypeParam>(scenes::Standard, n, width, low);
    RayScene scene = scenes::Scene(n, { 40, 40 });
    scene.Transfer.Low = low;
    scene.Transfer.High = low + width;
    EXPECT_LE(ErrorOf(scene, values, n), Tolerance);
  }
}

TEST(AgainstReference, DoublesFarOutsideTheTable)
{
  // Fill values that float cannot hold are like any value above the table.
  const glm::ivec3 n(12);
  std::vector<double> values = scenes::Sampled<double>(scenes::Standard, n);
  values[700] = 1e300;
  values[911] = -1e300;
  const RayScene scene = scenes::Scene(n, { 40, 40 });
  EXPECT_LE(ErrorOf(scene, values, n), Tolerance);
}

} // namespace
