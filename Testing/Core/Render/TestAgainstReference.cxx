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
double ErrorOf(const RayScene& scene, const scenes::Field& field, const glm::ivec3& n)
{
  const std::vector<float> values = scenes::Sampled(field, n);
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
  const auto value = scenes::ValueOf(values, n);
  const FloatImage reference = ReferenceImage(scene, value, scenes::NearestEntry(scene.Transfer));
  EXPECT_GT(reference.At(scene.Viewport.Hi.x / 2, scene.Viewport.Hi.y / 2).a, 0.1f);
  const FloatImage continuous = ReferenceImage(scene, value, scenes::Smooth);
  EXPECT_LE(MaxDifference(image, continuous), TableTolerance);
  return MaxDifference(image, reference);
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
  EXPECT_LE(ErrorOf(scene, scenes::Standard, n), Tolerance);
}

} // namespace
