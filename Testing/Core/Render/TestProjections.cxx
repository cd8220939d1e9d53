// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Render/Raycast/BrickProjector.h"
#include "Render/Scenes.h"
#include "Targets.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

const glm::ivec3 N{ 33, 26, 37 };
constexpr BlendMode Modes[] = { BlendMode::Maximum, BlendMode::Minimum, BlendMode::Average };
constexpr SampleInterpolation Interpolations[] = { SampleInterpolation::Linear,
  SampleInterpolation::Nearest };

/// Opaque in the middle of the range only, so that the best value is not the most opaque one.
glm::dvec4 Middle(double value)
{
  glm::dvec4 entry = scenes::Smooth(value);
  entry.a = 0.9 * std::exp(-20.0 * (value - 0.4) * (value - 0.4));
  return entry;
}

RayScene SceneOf(BlendMode mode, double distance = 1.4, bool parallel = false)
{
  RayScene scene = scenes::Scene(N, { 61, 50 }, glm::dmat4(1.0), distance, parallel);
  scene.Transfer = scenes::Tabulate(Middle);
  scene.Blend.Mode = mode;
  scene.OpacityLimit = 0.5f; // no matter
  return scene;
}

template <class T>
double ErrorOf(const RayScene& scene, const std::vector<T>& values)
{
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, N)).Image;
  const FloatImage reference =
    ReferenceImage(scene, scenes::ValueOf(values, N), scenes::NearestEntry(scene.Transfer));
  EXPECT_GT(reference.At(30, 25).a, 0.05f);
  return MaxDifference(image, reference);
}

/// A neighbouring entry, where values round apart.
constexpr double Tolerance = 1e-3;

TEST(Projections, AgreeWithTheReference)
{
  const std::vector<float> values = scenes::Sampled(scenes::Standard, N);
  for (const BlendMode mode : Modes)
  {
    for (const SampleInterpolation interpolation : Interpolations)
    {
      for (const double distance : { 0.1, 1.4 })
      {
        RayScene scene = SceneOf(mode, distance, distance > 1.0);
        scene.Interpolation = interpolation;
        EXPECT_LE(ErrorOf(scene, values), Tolerance) << static_cast<int>(mode);
        scene.SampleDistance = 0.37;
        scene.ClipPlanes = { { { 0.3, -1.0, 0.2 }, 7.0 } };
        EXPECT_LE(ErrorOf(scene, values), Tolerance) << static_cast<int>(mode);
      }
    }
  }
}

TEST(Projections, AveragesAreExactWhateverTheScale)
{
  RayScene scene = SceneOf(BlendMode::Average);
  scene.Blend.Black = 10.0;
  scene.Blend.White = 90.0;
  scene.Transfer.High = 100.0;
  EXPECT_LE(ErrorOf(scene, scenes::Sampled<float>(scenes::Standard, N, 100.0)), 1e-5);
  EXPECT_LE(ErrorOf(scene, scenes::Sampled<double>(scenes::Standard, N, 100.0)), 1e-5);
  EXPECT_LE(ErrorOf(scene, scenes::Sampled<std::uint8_t>(scenes::Standard, N, 100.0)), 1e-5);
  // Some count, some do not.
  scene.Blend.AveragedLow = 20.5;
  scene.Blend.AveragedHigh = 60.5;
  EXPECT_LE(ErrorOf(scene, scenes::Sampled<std::uint8_t>(scenes::Standard, N, 100.0)), 2e-3);
}

TEST(Projections, AConstantIsItsOwnAverage)
{
  const std::vector<float> values(std::size_t(N.x) * N.y * N.z, 0.75f);
  RayScene scene = SceneOf(BlendMode::Average);
  scene.Transfer = scenes::Tabulate([](double) { return glm::dvec4(0.1, 0.2, 0.3, 0.5); });
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, N)).Image;
  const glm::vec4 pixel = image.At(30, 25);
  EXPECT_NEAR(pixel.r, 0.375, 1e-6);
  EXPECT_EQ(pixel.r, pixel.g);
  EXPECT_EQ(pixel.r, pixel.b);
  EXPECT_EQ(pixel.a, 1.0f);
}

TEST(Projections, TypesOfAllKindsAgreeWithTheReference)
{
  for (const BlendMode mode : { BlendMode::Maximum, BlendMode::Minimum })
  {
    RayScene scene = SceneOf(mode);
    scene.Transfer.Low = 1e6;
    scene.Transfer.High = 1e6 + 100.0;
    EXPECT_LE(ErrorOf(scene, scenes::Sampled<double>(scenes::Standard, N, 100.0, 1e6)), Tolerance);
    EXPECT_LE(
      ErrorOf(scene, scenes::Sampled<std::int32_t>(scenes::Standard, N, 100.0, 1e6)), Tolerance);
  }
}

std::vector<float> WithSpecialValues()
{
  std::vector<float> values = scenes::Sampled(scenes::Standard, N);
  std::mt19937 random(3);
  const float special[] = { NAN, INFINITY, -INFINITY, 3e38f, -3e38f };
  for (int i = 0; i < 200; ++i)
  {
    values[random() % values.size()] = special[i % 5];
  }
  return values;
}

/// Draws one brick, tile by tile, with `project(tile)`.
template <class Project>
FloatImage DrawTiles(const RayScene& scene, std::int64_t& samples, Project&& project)
{
  const RayLattice lattice(scene);
  FloatImage picture;
  picture.Rect = scene.Viewport;
  picture.Pixels.assign(scene.Viewport.Count(), glm::vec4(0.0f, 2.0f, 0.25f, 1.0f));
  const auto tile = std::make_unique<RayTile>();
  samples = 0;
  for (int y = 0; y < scene.Viewport.Hi.y; y += RayTile::Edge)
  {
    for (int x = 0; x < scene.Viewport.Hi.x; x += RayTile::Edge)
    {
      tile->Open(lattice,
        Intersection({ { x, y }, glm::ivec2(x, y) + RayTile::Edge }, scene.Viewport), picture,
        0.0f);
      EXPECT_TRUE(tile->PacketsFit);
      project(*tile);
      tile->Close(picture);
      samples += tile->SamplesTaken;
    }
  }
  return picture;
}

template <class T>
void ExpectPacketsGiveTheBitsOfSingleRays(const RayScene& scene, const std::vector<T>& values)
{
  const Box cells{ { 1, 2, 3 }, { 31, 25, 35 } };
  const StepTable steps(scene.Transfer, scene.SampleDistance);
  const ProjectionTable table(scene, steps);
  BrickView view;
  view.Values = values.data();
  view.Type = ScalarTypeOf<T>();
  view.Stride[1] = N.x;
  view.Stride[2] = std::ptrdiff_t{ N.x } * N.y;
  ValueRange range;
  for (const T value : values)
  {
    if (std::isfinite(static_cast<double>(value)))
    {
      range.Include(static_cast<double>(value));
    }
  }
  const PixelRect all = scene.Viewport;
  std::int64_t taken = 0;
  const FloatImage plain = DrawTiles(scene, taken,
    [&](RayTile& tile) {
      ProjectBrick({ view, glm::ivec3(0), cells }, table, all, tile);
    });
  EXPECT_GT(taken, 1000);
  const PackedBrick packed(view, glm::ivec3(0), cells, table.Low());
  std::int64_t samples = 0;
  const FloatImage unpacked = DrawTiles(scene, samples,
    [&](RayTile& tile) { ProjectUnpacked(packed, packed.Cells(), table, all, tile); });
  EXPECT_EQ(MaxDifference(unpacked, plain), 0.0);
  EXPECT_EQ(samples, taken);
  for (const std::int64_t target : targets::OfThisMachine())
  {
    SCOPED_TRACE(hwy::TargetName(target));
    const targets::OnlyTarget only(target);
    const FloatImage drawn = DrawTiles(scene, samples,
      [&](RayTile& tile) { ProjectPacked(packed, packed.Cells(), range, table, all, tile); });
    EXPECT_EQ(MaxDifference(drawn, plain), 0.0);
    EXPECT_LE(samples, taken);
  }
}

TEST(Projections, PacketsGiveTheBitsOfSingleRays)
{
  for (const BlendMode mode : Modes)
  {
    for (const SampleInterpolation interpolation : Interpolations)
    {
      for (const double distance : { 0.15, 1.4 })
      {
        RayScene scene = SceneOf(mode, distance);
        scene.Interpolation = interpolation;
        ExpectPacketsGiveTheBitsOfSingleRays(scene, scenes::Sampled(scenes::Standard, N));
        scene.Blend.AveragedLow = 0.2;
        scene.Blend.AveragedHigh = 0.8;
        ExpectPacketsGiveTheBitsOfSingleRays(scene, WithSpecialValues());
        if (distance < 1.0)
        {
          continue;
        }
        ExpectPacketsGiveTheBitsOfSingleRays(
          scene, scenes::Sampled<std::uint8_t>(scenes::Standard, N, 1.999));
        scene.SampleDistance = 0.3;
        ExpectPacketsGiveTheBitsOfSingleRays(scene, scenes::Sampled<double>(scenes::Standard, N));
      }
    }
  }
}

TEST(Projections, SamplesThatAreAllTransparentAreOnlyCounted)
{
  RayScene scene = SceneOf(BlendMode::Average);
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  const std::vector<float> values(std::size_t(N.x) * N.y * N.z, 0.125f);
  ExpectPacketsGiveTheBitsOfSingleRays(scene, values);
  const scenes::Drawn drawn = scenes::Draw(scene, scenes::ArrayOf(values, N));
  EXPECT_EQ(drawn.Statistics.SamplesTaken, 0);
  EXPECT_EQ(drawn.Image.At(30, 25), glm::vec4(0, 0, 0, 1));
}

scenes::Drawn DrawCopies(
  const RayScene& scene, const std::vector<float>& values, const scenes::DrawOptions& options)
{
  // Bricks that take memory, so that the budget makes batches.
  const std::vector<std::uint8_t> flags(values.size(), 0);
  SampleArray array = scenes::ArrayOf(values, N);
  array.Flags = flags.data();
  return scenes::Draw(scene, array, options);
}

TEST(Projections, BricksThreadsAndBudgetsChangeNoBit)
{
  for (const BlendMode mode : Modes)
  {
    for (const SampleInterpolation interpolation : Interpolations)
    {
      RayScene scene = SceneOf(mode);
      scene.Interpolation = interpolation;
      scene.SampleDistance = 0.7;
      const std::vector<float> values = WithSpecialValues();
      const FloatImage image = DrawCopies(scene, values, { 16, 1, 1u << 30 }).Image;
      for (const scenes::DrawOptions& options : { scenes::DrawOptions{ 3, 1, 1u << 18 },
             scenes::DrawOptions{ 7, 3, 0 }, scenes::DrawOptions{ 64, 2, 0 } })
      {
        EXPECT_EQ(MaxDifference(DrawCopies(scene, values, options).Image, image), 0.0)
          << options.BrickCells << " " << static_cast<int>(mode);
      }
    }
  }
}

TEST(Projections, LargeBricksAndStepsAgreeWithTheReference)
{
  const std::vector<float> values = scenes::Sampled(scenes::Standard, N);
  for (const BlendMode mode : Modes)
  {
    RayScene scene = SceneOf(mode);
    scene.SampleDistance = 20.0; // packets do not fit
    EXPECT_LE(ErrorOf(scene, values), Tolerance);
  }
  const glm::ivec3 n(140, 3, 3); // bricks cannot be packed
  const std::vector<float> rod = scenes::Sampled(scenes::Standard, n);
  for (const BlendMode mode : Modes)
  {
    RayScene scene = scenes::Scene(n, { 40, 40 });
    scene.Blend.Mode = mode;
    const FloatImage image =
      scenes::Draw(scene, scenes::ArrayOf(rod, n), { 200, 1, 1u << 30 }).Image;
    EXPECT_LE(MaxDifference(image, ReferenceImage(scene, scenes::ValueOf(rod, n),
                                     scenes::NearestEntry(scene.Transfer))),
      Tolerance);
  }
}

TEST(Projections, BricksThatCannotBeatAnotherAreNotLoaded)
{
  const std::vector<float> values = scenes::Sampled(scenes::Radial, N);
  RayScene scene = SceneOf(BlendMode::Maximum);
  const auto drawn = [&](BlendMode mode)
  {
    scene.Blend.Mode = mode;
    return DrawCopies(scene, values, { 4, 1, 20000 }).Statistics;
  };
  const RayStatistics average = drawn(BlendMode::Average);
  EXPECT_EQ(average.BricksSkipped, 0);
  for (const BlendMode mode : { BlendMode::Maximum, BlendMode::Minimum })
  {
    const RayStatistics best = drawn(mode);
    EXPECT_EQ(best.BricksDrawn + best.BricksSkipped, average.BricksDrawn);
    EXPECT_GT(best.BricksSkipped, average.BricksDrawn / 8) << static_cast<int>(mode);
  }
}

TEST(Projections, NothingVisibleDrawsNothing)
{
  const std::vector<float> values = scenes::Sampled(scenes::Standard, N);
  RayScene scene = SceneOf(BlendMode::Maximum);
  scene.Transfer = scenes::Tabulate([](double) { return glm::dvec4(1, 1, 1, 0); });
  EXPECT_EQ(scenes::Draw(scene, scenes::ArrayOf(values, N)).Statistics.BricksDrawn, 0);
  scene.Blend.Mode = BlendMode::Average;
  scene.Blend.AveragedLow = 7.0;
  scene.Blend.AveragedHigh = 8.0;
  EXPECT_EQ(scenes::Draw(scene, scenes::ArrayOf(values, N)).Statistics.BricksDrawn, 0);
}

TEST(Projections, ShadingChangesNothing)
{
  const std::vector<float> values = scenes::Sampled(scenes::Standard, N);
  RayScene scene = SceneOf(BlendMode::Maximum);
  const FloatImage plain = scenes::Draw(scene, scenes::ArrayOf(values, N)).Image;
  scene.Shading.On = true;
  EXPECT_EQ(MaxDifference(scenes::Draw(scene, scenes::ArrayOf(values, N)).Image, plain), 0.0);
}

std::string SentenceOf(const RayBlend& blend)
{
  const std::vector<float> values = scenes::Sampled(scenes::Standard, N);
  RayScene scene = SceneOf(BlendMode::Average);
  scene.Blend = blend;
  try
  {
    scenes::Draw(scene, scenes::ArrayOf(values, N));
  }
  catch (const Error& error)
  {
    return error.what();
  }
  return "";
}

TEST(Projections, UnusableBlendsGetASentence)
{
  RayBlend blend;
  blend.Mode = static_cast<BlendMode>(9);
  EXPECT_NE(SentenceOf(blend).find("no blend mode of number 9"), std::string::npos);
  blend.Mode = BlendMode::Average;
  EXPECT_EQ(SentenceOf(blend), "");
  blend.AveragedLow = NAN;
  EXPECT_NE(SentenceOf(blend).find("range of values to average"), std::string::npos);
  blend.AveragedLow = 2.0;
  blend.AveragedHigh = 1.0;
  EXPECT_NE(SentenceOf(blend).find("range of values to average"), std::string::npos);
  blend = {};
  blend.Mode = BlendMode::Average;
  blend.White = NAN;
  EXPECT_NE(SentenceOf(blend).find("black and white"), std::string::npos);
}

} // namespace
