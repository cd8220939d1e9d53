// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

RayScene Shaded(const glm::ivec3& n, const glm::dmat4& toWorld = glm::dmat4(1.0))
{
  RayScene scene = scenes::Scene(n, { 60, 50 }, toWorld);
  scene.Shading = { true, 0.3f, 0.7f, 0.4f, 12.0f };
  return scene;
}

/// Trilinear in the differences of the neighbours on both sides; `at` gives samples.
glm::dvec4 ValueAndGradient(const std::function<double(const glm::ivec3&)>& at, const glm::ivec3& n,
  const glm::dvec3& position)
{
  const glm::ivec3 cell =
    glm::clamp(glm::ivec3(glm::floor(position)), glm::ivec3(0), glm::max(n - 2, 0));
  const glm::dvec3 part = position - glm::dvec3(cell);
  glm::dvec4 sum(0.0);
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::ivec3 offset(corner & 1, corner >> 1 & 1, corner >> 2);
    const glm::ivec3 p = cell + offset;
    double weight = 1.0;
    glm::dvec4 sample(at(p), 0.0, 0.0, 0.0);
    for (int axis = 0; axis < 3; ++axis)
    {
      weight *= offset[axis] ? part[axis] : 1.0 - part[axis];
      glm::ivec3 low = p;
      glm::ivec3 high = p;
      low[axis] = std::max(p[axis] - 1, 0);
      high[axis] = std::min(p[axis] + 1, n[axis] - 1);
      sample[axis + 1] = (at(high) - at(low)) / (high[axis] - low[axis]);
    }
    sum += weight * sample;
  }
  return sum;
}

/// In double, sample by sample, with the lattice's definition only.
FloatImage Reference(const RayScene& scene, const std::vector<float>& values, const glm::ivec3& n)
{
  const auto at = scenes::ValueOf(values, n);
  const glm::dmat4 toIndex = glm::inverse(scene.IndexToWorld);
  const glm::dmat3 gradientToWorld = glm::transpose(glm::dmat3(toIndex));
  const auto function = scenes::NearestEntry(scene.Transfer);
  FloatImage image;
  image.Rect = scene.Viewport;
  for (int y = 0; y < scene.Viewport.Hi.y; ++y)
  {
    for (int x = 0; x < scene.Viewport.Hi.x; ++x)
    {
      const Ray ray = scene.Camera.RayOf(x, y);
      double enter = ray.Near;
      double exit = ray.Far;
      const glm::dvec3 origin(toIndex * glm::dvec4(ray.Origin, 1.0));
      const glm::dvec3 way(toIndex * glm::dvec4(ray.Direction, 0.0));
      for (int axis = 0; axis < 3; ++axis)
      {
        const double a = -origin[axis] / way[axis];
        const double b = (n[axis] - 1 - origin[axis]) / way[axis];
        enter = std::fmax(enter, std::fmin(a, b));
        exit = std::fmin(exit, std::fmax(a, b));
      }
      glm::dvec3 color(0.0);
      double transmittance = 1.0;
      const double step = scene.SampleDistance;
      for (double k = std::floor(enter / step); enter < exit && k * step < exit; k += 1.0)
      {
        const double begin = std::fmax(k * step, enter);
        const double end = std::fmin((k + 1.0) * step, exit);
        const glm::dvec3 position = origin + way * (0.5 * (begin + end));
        const glm::dvec4 found = ValueAndGradient(at, n, position);
        const glm::dvec3 normal = gradientToWorld * glm::dvec3(found.y, found.z, found.w);
        const double length = glm::length(normal);
        const double cosine =
          length > 0.0 ? std::abs(glm::dot(normal, ray.Direction)) / length : 0.0;
        const RayShading& s = scene.Shading;
        const glm::dvec4 entry = function(found.x);
        const double opacity =
          1.0 - std::pow(1.0 - entry.a, (end - begin) / scene.Transfer.UnitDistance);
        color += transmittance * opacity *
                 (glm::dvec3(entry) * (s.Ambient + s.Diffuse * cosine) +
                   s.Specular * std::pow(cosine, double{ s.SpecularPower }));
        transmittance *= 1.0 - opacity;
      }
      image.Pixels.emplace_back(color, 1.0 - transmittance);
    }
  }
  return image;
}

TEST(Shading, AgainstReference)
{
  const glm::ivec3 n(25, 28, 23);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  glm::dmat4 turned = glm::rotate(glm::dmat4(1.0), 0.8, glm::normalize(glm::dvec3(1, 2, 3)));
  turned = glm::scale(turned, glm::dvec3(0.5, -1.25, 2.0));
  turned[2] += 0.4 * turned[0];
  struct Placed
  {
    glm::dmat4 ToWorld;
    double Distance = 1.4; // of the eye, in diagonals: from farther away columns lie between pixels
  };
  for (const auto& [toWorld, distance] : { Placed{ glm::dmat4(1.0) }, Placed{ turned },
         Placed{ glm::scale(glm::dmat4(1.0), glm::dvec3(1e-5)) },
         Placed{ glm::translate(glm::dmat4(1.0), glm::dvec3(1e7, -1e7, 3e7)) },
         Placed{ glm::scale(glm::dmat4(1.0), glm::dvec3(1, 1, 1000)), 0.03 },
         Placed{ glm::scale(glm::dmat4(1.0), glm::dvec3(300, 1, 1)), 0.03 } })
  {
    RayScene scene = Shaded(n, toWorld);
    scene.Camera = scenes::Scene(n, { 60, 50 }, toWorld, distance).Camera;
    scene.SampleDistance = toWorld[0][0] < 1e-3 ? 1e-5 : 1.0;
    scene.Transfer.UnitDistance = scene.SampleDistance;
    const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
    EXPECT_GT(image.At(30, 25).a, 0.1f);
    EXPECT_LE(MaxDifference(image, Reference(scene, values, n)), 5e-4);
  }
}

TEST(Shading, BricksThreadsAndUnitsOfValuesChangeNoBit)
{
  const glm::ivec3 n(37, 30, 33);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  const RayScene scene = Shaded(n);
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
  RayScene dark = scene;
  dark.Shading.On = false;
  EXPECT_GT(MaxDifference(image, scenes::Draw(dark, scenes::ArrayOf(values, n)).Image), 0.05);
  for (const int brick : { 1, 3, 8, 31, 64 })
  {
    const FloatImage other =
      scenes::Draw(scene, scenes::ArrayOf(values, n), { brick, 2, 100000 }).Image;
    EXPECT_EQ(MaxDifference(image, other), 0.0) << brick;
  }
  // A power of two, so that nothing rounds otherwise.
  const double tiny = std::exp2(-60.0);
  RayScene scaled = scene;
  scaled.Transfer.High = tiny;
  const std::vector<float> small = scenes::Sampled(scenes::Standard, n, tiny);
  EXPECT_EQ(MaxDifference(image, scenes::Draw(scaled, scenes::ArrayOf(small, n)).Image), 0.0);
}

/// A source that only gives its bricks: what is around is put together from them.
class BricksOnly : public ArrayBrickSource
{
public:
  using ArrayBrickSource::ArrayBrickSource;
  BrickView LoadAround(std::int64_t brick, Box& samples) override
  {
    return BrickSource::LoadAround(brick, samples);
  }
};

TEST(Shading, BricksPutTogetherGiveTheSame)
{
  const glm::ivec3 n(26, 20, 23);
  const std::vector<std::uint16_t> values =
    scenes::Sampled<std::uint16_t>(scenes::Standard, n, 1000.0);
  RayScene scene = Shaded(n);
  scene.Transfer.High = 1000.0;
  ThreadPool pool(2);
  RayStatistics statistics;
  const SampleArray array = scenes::ArrayOf(values, n);
  ArrayBrickSource known(array, 7, { 0, 1000 }, pool);
  BricksOnly together(array, 7, { 0, 1000 }, pool);
  const auto draw = [&](BrickSource& source)
  { return CastRays(scene, source, scene.DomainCells, 1 << 30, pool, statistics); };
  EXPECT_EQ(MaxDifference(draw(known), draw(together)), 0.0);
}

TEST(Shading, PiecesWithAGhostLayerHaveNoSeam)
{
  const glm::ivec3 n(30);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  RayScene scene = Shaded(n);
  scene.OpacityLimit = 1.0f;
  const FloatImage whole = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
  ThreadPool pool(1);
  FloatImage picture;
  picture.Rect = scene.Viewport;
  picture.Pixels.assign(picture.Rect.Count(), glm::vec4(0.0f));
  const Box all = scene.DomainCells;
  // The eye is above, so the upper piece comes first.
  for (const Box& cells :
    { Box{ { 0, 0, 13 }, all.Hi }, Box{ all.Lo, { all.Hi.x, all.Hi.y, 13 } } })
  {
    SampleArray array = scenes::ArrayOf(values, n);
    array.Samples.Lo.z = std::max(cells.Lo.z - 1, 0);
    array.Samples.Hi.z = std::min(cells.Hi.z + 2, n.z);
    array.Values = values.data() + array.Samples.Lo.z * n.x * n.y;
    ArrayBrickSource source(array, 16, { 0, 1 }, pool);
    RayStatistics statistics;
    const FloatImage part = CastRays(scene, source, cells, 1 << 30, pool, statistics);
    for (int y = part.Rect.Lo.y; y < part.Rect.Hi.y; ++y)
    {
      for (int x = part.Rect.Lo.x; x < part.Rect.Hi.x; ++x)
      {
        picture.At(x, y) += (1.0f - picture.At(x, y).a) * part.At(x, y);
      }
    }
  }
  EXPECT_LE(MaxDifference(picture, whole), 1e-5);
}

TEST(Shading, UniformAndNotFiniteValuesGiveNoNaN)
{
  const glm::ivec3 n(16);
  std::vector<float> values(16 * 16 * 16, 0.5f);
  RayScene scene = Shaded(n);
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
  RayScene plain = scene;
  plain.Shading = { true, 0.3f, 0.0f, 0.0f, 1.0f };
  // Without a gradient there is ambient light only.
  EXPECT_EQ(MaxDifference(image, scenes::Draw(plain, scenes::ArrayOf(values, n)).Image), 0.0);
  for (std::size_t i = 0; i < values.size(); i += 41)
  {
    values[i] = i % 2 ? NAN : INFINITY;
  }
  const FloatImage holes = scenes::Draw(scene, scenes::ArrayOf(values, n)).Image;
  EXPECT_LT(MaxDifference(holes, image), 1.0); // infinite for NaN
}

TEST(Shading, CoefficientsAreChecked)
{
  const glm::ivec3 n(8);
  const std::vector<float> values = scenes::Sampled(scenes::Linear, n);
  for (const float bad : { -0.1f, NAN, INFINITY })
  {
    RayScene scene = Shaded(n);
    scene.Shading.Diffuse = bad;
    EXPECT_THROW(scenes::Draw(scene, scenes::ArrayOf(values, n)), Error);
  }
}

} // namespace
