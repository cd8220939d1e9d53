// SPDX-License-Identifier: BSD-3-Clause
// What the ray caster is measured with: scenes, the converged picture and the judgement of errors.
#include "ConvergedImage.h"
#include "Picture.h"
#include "StandardScenes.h"

#include "Base/ThreadPool.h"
#include "Render/Sampling/ImageError.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <limits>

namespace fs = std::filesystem;
using namespace banyan::bench;

namespace
{

constexpr int Pixels = 24;

std::function<double(const glm::ivec3&)> ValueOf(const Volume& volume)
{
  return [&volume](const glm::ivec3& p)
  {
    const glm::ivec3& n = volume.Samples;
    const std::size_t at = p.x + std::size_t(n.x) * (p.y + std::size_t(n.y) * p.z);
    return volume.Codes.empty() ? double(volume.Floats[at]) : double(volume.Codes[at]);
  };
}

/// A scene of a volume that is flat, has long cells and shows a formula.
BenchScene FlatScene(bool codes)
{
  auto volume = std::make_shared<Volume>();
  volume->Samples = { 9, 14, 6 };
  volume->Spacing = { 1.0, 0.6, 2.5 };
  if (codes)
    volume->Codes = scenes::Sampled<std::uint8_t>(scenes::Standard, volume->Samples, 255.0);
  else
    volume->Floats = scenes::Sampled<float>(scenes::Standard, volume->Samples);
  BenchScene scene;
  scene.Name = "flat";
  scene.Data = volume;
  scene.Picture = Pixels;
  scene.High = codes ? 255.0 : 1.0;
  scene.UnitDistance = 0.7;
  for (int i = 0; i < 32; ++i)
  {
    scene.Nodes.push_back(scenes::Sparse(i / 31.0));
  }
  scene.LookFromAfar(1.1);
  return scene;
}

} // namespace

TEST(RayCastBenchmark, TheConvergedPictureIsTheReferenceIntegrators)
{
  banyan::ThreadPool pool(2);
  for (const bool codes : { false, true })
  {
    const BenchScene scene = FlatScene(codes);
    const double step = 0.4; // in voxels
    const banyan::FloatImage fast = ConvergedImage(scene, step, pool);
    const banyan::FloatImage slow = banyan::ReferenceImage(ToRayScene(scene, step, 2.0f),
      ValueOf(*scene.Data), [&scene](double value) { return scene.At(value); });
    float strongest = 0.0f;
    for (const glm::vec4& pixel : slow.Pixels)
    {
      strongest = std::max(strongest, pixel.a);
    }
    EXPECT_GT(strongest, 0.2f);
    EXPECT_LT(banyan::MaxDifference(fast, slow), 2e-6);
  }
}

TEST(RayCastBenchmark, TheRayCasterDrawsTheScene)
{
  banyan::ThreadPool pool(1);
  for (const bool shaded : { false, true })
  {
    BenchScene scene = FlatScene(false);
    scene.Shaded = shaded;
    const banyan::RayScene drawn = ToRayScene(scene, 0.05, 2.0f);
    banyan::ArrayBrickSource source(scene.Data->Array(), 16, { 0.0, 1.0 }, pool);
    banyan::RayStatistics statistics;
    const banyan::FloatImage image =
      banyan::CastRays(drawn, source, drawn.DomainCells, 1u << 30, pool, statistics);
    EXPECT_LT(ErrorOf(image, ConvergedImage(scene, 0.05, pool)).Largest, shaded ? 2.0 : 1.0);
  }
}

TEST(RayCastBenchmark, LightIsThatOfTheGradientAndTheRay)
{
  banyan::ThreadPool pool(1);
  // Ramps along an axis and across: their gradients have one direction up to the faces.
  for (const glm::dvec3& slope :
    { glm::dvec3(0.5, 0, 0), { 0, 0.5, 0 }, { 0, 0, 0.5 }, { 0.3, -0.2, 0.25 } })
  {
    BenchScene scene = FlatScene(false);
    auto ramp = std::make_shared<Volume>(*scene.Data);
    ramp->Floats = scenes::Sampled<float>(
      [&slope](const glm::dvec3& p) { return 0.4 + glm::dot(slope, p); }, ramp->Samples);
    scene.Data = ramp;
    const banyan::FloatImage plain = ConvergedImage(scene, 0.5, pool);
    scene.Shaded = true;
    const banyan::FloatImage shaded = ConvergedImage(scene, 0.5, pool);
    const banyan::RayCamera camera = ToRayScene(scene, 1.0, 1.0f).Camera;
    const glm::dvec3 voxels = glm::dvec3(ramp->Samples - 1) * ramp->Spacing;
    const glm::dvec3 normal = glm::normalize(slope / voxels);
    int lit = 0;
    for (int y = 0; y < Pixels; ++y)
    {
      for (int x = 0; x < Pixels; ++x)
      {
        const double light = 0.3 + 0.7 * std::abs(glm::dot(camera.RayOf(x, y).Direction, normal));
        const glm::vec4& without = plain.At(x, y);
        const glm::vec4& with = shaded.At(x, y);
        EXPECT_NEAR(with.r, light * without.r, 1e-5);
        EXPECT_NEAR(with.g, light * without.g, 1e-5);
        EXPECT_EQ(with.a, without.a);
        lit += without.r > 0.05f || without.g > 0.05f ? 1 : 0;
      }
    }
    EXPECT_GT(lit, 60);
  }
  BenchScene even = FlatScene(false);
  auto volume = std::make_shared<Volume>(*even.Data);
  std::fill(volume->Floats.begin(), volume->Floats.end(), 0.75f);
  even.Data = volume;
  const glm::vec4 without = ConvergedImage(even, 0.5, pool).At(Pixels / 2, Pixels / 2);
  even.Shaded = true;
  const glm::vec4 with = ConvergedImage(even, 0.5, pool).At(Pixels / 2, Pixels / 2);
  EXPECT_GT(without.g, 0.05f);
  EXPECT_NEAR(with.g, 0.3f * without.g, 1e-6);
}

TEST(RayCastBenchmark, StandardScenesAreAsDefined)
{
  banyan::ThreadPool pool(2);
  const auto volume = StandardVolume(33, pool);
  const BenchScene s1 = StandardScene(volume, StandardFunction::S1, false, 16);
  const BenchScene s2 = StandardScene(volume, StandardFunction::S2, true, 16);
  EXPECT_EQ(s1.Name, "S1-33");
  EXPECT_EQ(s2.Name, "S2-33-shaded");
  ASSERT_EQ(s1.Nodes.size(), 256u);
  EXPECT_NEAR(s1.At(0.0).a, 0.001, 1e-12);
  EXPECT_NEAR(s1.At(1.0).a, 0.02, 1e-12);
  EXPECT_EQ(s2.At(63.0 / 255.0).a, 0.0);
  EXPECT_NEAR(s2.At(64.0 / 255.0).a, 0.02, 1e-9);
  EXPECT_NEAR(s2.At(63.5 / 255.0).a, 0.01, 1e-9);
  EXPECT_NEAR(s2.At(7.0).a, 0.30, 1e-12);
  EXPECT_NEAR(s1.At(0.0).r, 1.0, 1e-12);
  EXPECT_NEAR(s1.UnitDistance, 32.0 / 255.0, 1e-12);
  EXPECT_NEAR(glm::length(s1.Eye - s1.Center), 1.9 * 32.0, 1e-9);
}

TEST(RayCastBenchmark, AllSizesOfAStandardSceneShowOnePicture)
{
  banyan::ThreadPool pool(2);
  const BenchScene coarse =
    StandardScene(StandardVolume(97, pool), StandardFunction::S1, false, Pixels);
  const BenchScene fine =
    StandardScene(StandardVolume(129, pool), StandardFunction::S1, false, Pixels);
  const banyan::FloatImage image = ConvergedImage(coarse, 1.0, pool);
  EXPECT_LT(ErrorOf(image, ConvergedImage(fine, 1.0, pool)).Largest, 2.0);
}

TEST(RayCastBenchmark, ErrorsAreMeasuredAsStated)
{
  banyan::FloatImage truth;
  truth.Rect = { { 0, 0 }, { 2, 2 } };
  truth.Pixels.assign(4, glm::vec4(0.2f, 0.4f, 0.6f, 1.0f));
  banyan::FloatImage image = truth;
  image.At(1, 0).g += 0.1f;
  image.At(1, 0).a = 0.0f; // does not count
  const PictureError error = ErrorOf(image, truth);
  EXPECT_NEAR(error.Largest, 25.5, 1e-4);
  EXPECT_NEAR(error.PsnrDecibels, -10.0 * std::log10(0.01 / 12.0), 1e-4);
  EXPECT_NEAR(ErrorOf(Rounded(truth, 2), truth).Largest, 0.0, 1e-4); // 51, 102 and 153

  image.At(0, 1).b = std::numeric_limits<float>::quiet_NaN();
  EXPECT_EQ(ErrorOf(image, truth).Largest, std::numeric_limits<double>::infinity());
  EXPECT_EQ(ErrorOf(image, truth).PsnrDecibels, -std::numeric_limits<double>::infinity());
  EXPECT_EQ(Rounded(image, 2).Rgb[2 * 3 + 2], 255);

  // Pixels that a picture lacks are black.
  banyan::FloatImage part = truth;
  part.Rect = { { 0, 0 }, { 2, 1 } };
  part.Pixels.resize(2);
  EXPECT_NEAR(ErrorOf(part, truth).Largest, 153.0, 1e-4);
  EXPECT_NEAR(ErrorOf(Rounded(part, 2), truth).Largest, 153.0, 1e-4);
}

TEST(RayCastBenchmark, ConvergedPicturesAreKept)
{
  std::string folder = (fs::temp_directory_path() / "banyan-references-XXXXXX").string();
  ASSERT_NE(mkdtemp(folder.data()), nullptr);
  banyan::ThreadPool pool(1);
  BenchScene scene = FlatScene(false);
  const banyan::FloatImage first = CachedConvergedImage(scene, 0.5, folder, pool);
  const auto files = [&folder]
  { return std::distance(fs::directory_iterator(folder), fs::directory_iterator()); };
  EXPECT_EQ(files(), 1);
  const banyan::FloatImage again = CachedConvergedImage(scene, 0.5, folder, pool);
  EXPECT_EQ(files(), 1);
  EXPECT_EQ(banyan::MaxDifference(first, again), 0.0);
  // Whatever decides the picture decides the file.
  scene.Nodes[20].a *= 0.9;
  const banyan::FloatImage changed = CachedConvergedImage(scene, 0.5, folder, pool);
  EXPECT_EQ(files(), 2);
  EXPECT_GT(banyan::MaxDifference(first, changed), 1e-4);
  auto volume = std::make_shared<Volume>(*scene.Data);
  volume->Floats.back() += 0.01f;
  scene.Data = volume;
  CachedConvergedImage(scene, 0.5, folder, pool);
  EXPECT_EQ(files(), 3);
  fs::remove_all(folder);
}
