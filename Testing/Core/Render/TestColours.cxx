// SPDX-License-Identifier: BSD-3-Clause
// Three and four components drawn as the colours that they are.
#include "Base/Error.h"
#include "Render/Bricks/JoinedComponents.h"
#include "Render/ColouredFields.h"
#include "Render/Raycast/BrickMarcher.h"
#include "Targets.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace
{

using namespace coloured;

constexpr double Tolerance = 2e-4;
const glm::ivec3 N{ 33, 26, 37 };
const glm::ivec2 Picture{ 61, 50 };

TEST(Colours, AgreeWithTheReference)
{
  for (const int components : { 3, 4 })
  {
    const std::vector<std::uint8_t> values = Sampled(N, components);
    const Looks looks(values, components);
    for (const double distance : { 0.1, 1.4 })
    {
      RayScene scene = SceneOf(N, Picture, White, distance);
      for (const auto interpolation : { SampleInterpolation::Linear, SampleInterpolation::Nearest })
      {
        scene.Interpolation = interpolation;
        const FloatImage expected = ReferenceOf(scene, looks, N);
        EXPECT_GT(Most(expected, ColourOf), 0.05f);
        const FloatImage image = scenes::Draw(scene, ArrayOf(values, N, components)).Image;
        EXPECT_LE(MaxDifference(image, expected), Tolerance) << components << " " << distance;
      }
    }
  }
}

TEST(Colours, OpaqueSamplesAreTheBytes)
{
  const glm::ivec3 n(17, 17, 5);
  const std::vector<std::uint8_t> values = Sampled(n, 4);
  RayScene scene = SceneOf(n, glm::ivec2(17), [](double) { return glm::dvec4(1.0); });
  scene.Interpolation = SampleInterpolation::Nearest;
  // Pixel centres lie on the samples, and the eye looks along z.
  const glm::dvec3 centre(8.0, 8.0, 0.0);
  scene.Camera =
    RayCamera(glm::ortho(-8.5, 8.5, -8.5, 8.5, 1.0, 40.0) *
                glm::lookAt(centre + glm::dvec3(0, 0, 20), centre, glm::dvec3(0, 1, 0)),
      glm::ivec2(17), centre);
  const FloatImage image = scenes::Draw(scene, ArrayOf(values, n, 4)).Image;
  for (int y = 1; y < 16; ++y)
  {
    for (int x = 1; x < 16; ++x)
    {
      const std::uint8_t* const sample = &values[4u * (x + 17u * (y + 17u * 4u))];
      for (int channel = 0; channel < 3; ++channel)
      {
        EXPECT_NEAR(image.At(x, y)[channel] * 255.0f, sample[channel], 1e-3f) << x << " " << y;
      }
    }
  }
}

TEST(Colours, BricksThreadsAndBudgetsChangeNoBit)
{
  const std::vector<std::uint8_t> values = Sampled(N, 4);
  for (const bool shaded : { false, true })
  {
    RayScene scene = SceneOf(N, Picture);
    scene.Shading = { shaded, 0.3f, 0.7f, 0.4f, 12.0f };
    const FloatImage image = scenes::Draw(scene, ArrayOf(values, N, 4)).Image;
    for (const int brick : { 1, 5, 8, 31, 64 })
    {
      const FloatImage other =
        scenes::Draw(scene, ArrayOf(values, N, 4), { brick, 2, 100000 }).Image;
      EXPECT_EQ(MaxDifference(image, other), 0.0) << brick;
    }
  }
}

/// Where all samples have one colour, shading is that of what the opacity function is asked for.
TEST(Colours, AreShadedByTheGradientOfAlpha)
{
  std::vector<std::uint8_t> values = Sampled(N, 4);
  std::vector<std::uint8_t> alpha;
  for (std::size_t i = 0; i < values.size(); i += 4)
  {
    values[i] = 51;
    values[i + 1] = 255;
    values[i + 2] = 102;
    alpha.push_back(values[i + 3]);
  }
  RayScene scene = SceneOf(N, Picture);
  scene.Shading = { true, 0.3f, 0.7f, 0.0f, 12.0f };
  FloatImage expected = scenes::Draw(scene, scenes::ArrayOf(alpha, N)).Image;
  for (glm::vec4& pixel : expected.Pixels)
  {
    pixel *= glm::vec4(0.2f, 1.0f, 0.4f, 1.0f);
  }
  EXPECT_LE(MaxDifference(scenes::Draw(scene, ArrayOf(values, N, 4)).Image, expected), 1e-5);
  RayScene bright = scene;
  bright.Shading.Specular = 0.4f;
  EXPECT_GT(MaxDifference(scenes::Draw(bright, ArrayOf(values, N, 4)).Image, expected), 0.02);
}

TEST(Colours, SpaceThatCannotBeSeenIsSkipped)
{
  const std::vector<std::uint8_t> values = Sampled(N, 4, true);
  const RayScene scene = SceneOf(N, Picture, SparseWhite);
  const scenes::Drawn drawn = scenes::Draw(scene, ArrayOf(values, N, 4), { 8, 1, 1u << 30 });
  EXPECT_LE(MaxDifference(drawn.Image, ReferenceOf(scene, Looks(values, 4), N)), Tolerance);
  EXPECT_GT(Most(drawn.Image, ColourOf), 0.05f);
  const scenes::Drawn all =
    scenes::Draw(SceneOf(N, Picture), ArrayOf(values, N, 4), { 8, 1, 1u << 30 });
  EXPECT_LT(drawn.Statistics.BricksDrawn, all.Statistics.BricksDrawn / 2);
  EXPECT_LT(drawn.Statistics.SamplesTaken, all.Statistics.SamplesTaken / 2);
}

/// A brick of one alpha has colours all the same.
TEST(Colours, OfOneAlphaAreNotOneColour)
{
  std::vector<std::uint8_t> values = Sampled(N, 4);
  for (std::size_t i = 3; i < values.size(); i += 4)
  {
    values[i] = 200;
  }
  const RayScene scene = SceneOf(N, Picture);
  const FloatImage image = scenes::Draw(scene, ArrayOf(values, N, 4)).Image;
  EXPECT_LE(MaxDifference(image, ReferenceOf(scene, Looks(values, 4), N)), Tolerance);
}

TEST(Colours, OfOtherTypesAreRoundedAndCutOff)
{
  const std::vector<std::uint8_t> bytes = Sampled(N, 4);
  const RayScene scene = SceneOf(N, Picture);
  const FloatImage expected = scenes::Draw(scene, ArrayOf(bytes, N, 4)).Image;
  std::vector<float> reals;
  std::vector<std::int32_t> wholes;
  for (const std::uint8_t byte : bytes)
  {
    reals.push_back(byte == 255 ? 1e9f : byte == 0 ? -3.5f : static_cast<float>(byte) + 0.4f);
    wholes.push_back(byte == 255 ? 70000 : byte == 0 ? -70000 : byte);
  }
  EXPECT_EQ(MaxDifference(scenes::Draw(scene, ArrayOf(reals, N, 4)).Image, expected), 0.0);
  EXPECT_EQ(MaxDifference(scenes::Draw(scene, ArrayOf(wholes, N, 4)).Image, expected), 0.0);
  const std::vector<double> numbers = NumbersOf(bytes, 4);
  EXPECT_EQ(MaxDifference(scenes::Draw(scene, ArrayOf(numbers, N, 1)).Image, expected), 0.0);
}

TEST(Colours, ThatAreNotNumbersOrHiddenDrawNothing)
{
  const std::vector<std::uint8_t> bytes = Sampled(N, 4);
  std::vector<float> values(bytes.begin(), bytes.end());
  Looks looks(bytes, 4);
  std::vector<std::uint8_t> flags(looks.Shown.size(), 0);
  for (std::size_t i = 0; i < looks.Shown.size(); i += 197)
  {
    looks.Shown[i] = NAN;
    values[4 * i + i % 4] = i % 3 ? NAN : INFINITY;
    flags[i] = 2;
  }
  for (const bool shaded : { false, true })
  {
    RayScene scene = SceneOf(N, Picture);
    scene.Shading.On = shaded;
    const FloatImage holes = scenes::Draw(scene, ArrayOf(values, N, 4)).Image;
    SampleArray hidden = ArrayOf(bytes, N, 4);
    hidden.Flags = flags.data();
    EXPECT_EQ(MaxDifference(scenes::Draw(scene, hidden).Image, holes), 0.0);
    if (!shaded)
    {
      EXPECT_LE(MaxDifference(holes, ReferenceOf(scene, looks, N)), Tolerance);
    }
  }
}

TEST(Colours, OfHiddenCellsDrawNothing)
{
  const std::vector<std::uint8_t> values = Sampled(N, 4);
  const RayScene scene = SceneOf(N, Picture);
  const SampleArray array = ArrayOf(values, N, 4);
  ThreadPool pool(1);
  ArrayBrickSource source(array, 16, { 0.0, 255.0 }, pool);
  const auto hidden = std::make_shared<HiddenCells>(N - 1);
  const Box box{ { 9, 3, 20 }, { 25, 17, 36 } };
  const std::vector<std::uint8_t> flags(static_cast<std::size_t>(box.Count()), 1);
  hidden->Hide(box, flags.data(), 1);
  source.Hide(hidden);
  RayStatistics statistics;
  const FloatImage image =
    CastViewport(scene, source, scene.DomainCells, 1u << 30, pool, statistics);
  const FloatImage expected = ReferenceOf(
    scene, Looks(values, 4), N, [&](const glm::ivec3& cell) { return box.Contains(cell); });
  EXPECT_LE(MaxDifference(image, expected), Tolerance);
}

TEST(Colours, OfACoarserLevelAreItsSamples)
{
  const glm::ivec3 n(33, 25, 41);
  const std::vector<std::uint8_t> values = Sampled(n, 3);
  std::vector<std::uint8_t> coarse;
  for (int z = 0; z < n.z; z += 2)
  {
    for (int y = 0; y < n.y; y += 2)
    {
      for (int x = 0; x < n.x; x += 2)
      {
        const auto* sample = &values[3u * (x + std::size_t(n.x) * (y + std::size_t(n.y) * z))];
        coarse.insert(coarse.end(), sample, sample + 3);
      }
    }
  }
  RayScene scene = SceneOf(n, Picture);
  scene.SampleDistance = 2.0;
  RayScene small = scene;
  small.IndexToWorld = glm::scale(glm::dmat4(1.0), glm::dvec3(2.0));
  const glm::ivec3 samples = (n + 1) / 2;
  small.DomainCells.Hi = samples - 1;
  const FloatImage expected = scenes::Draw(small, ArrayOf(coarse, samples, 3)).Image;
  scene.Samplings = std::make_shared<const TileSamplings>(
    Picture, std::vector{ RaySampling{ 1, scene.SampleDistance } });
  const FloatImage image = scenes::Draw(scene, ArrayOf(values, n, 3)).Image;
  EXPECT_GT(Most(image, ColourOf), 0.05f);
  EXPECT_LE(MaxDifference(image, expected), 1e-5);
}

TEST(Colours, BoundsOfJoinedComponentsHoldAllSamples)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<double> number(-60.0, 300.0);
  for (const int components : { 3, 4 })
  {
    for (int i = 0; i < 2000; ++i)
    {
      std::vector<ValueRange> ranges(static_cast<std::size_t>(components));
      double inside[4];
      for (int c = 0; c < components; ++c)
      {
        ValueRange& range = ranges[static_cast<std::size_t>(c)];
        range.Include(number(random));
        range.Include(number(random));
        const double part = static_cast<double>(random() % 5) / 4.0;
        inside[c] = range.Low + part * range.Width();
      }
      const ValueRange bounds = JoinedBounds(SampleArray::Colours, ranges);
      const double shown = ColourNumber::ShownOf(ColourNumber::Of(inside, components));
      EXPECT_LE(bounds.Low, shown);
      EXPECT_GE(bounds.High, shown);
    }
  }
}

TEST(Colours, OfOtherCountsAreRefused)
{
  const std::vector<std::uint8_t> values = Sampled(glm::ivec3(9), 4);
  EXPECT_THROW(ArraySamples(ArrayOf(values, glm::ivec3(9), 2)), Error);
  EXPECT_THROW(ArraySamples(ArrayOf(values, glm::ivec3(9), 5)), Error);
}

/// A brick of colours, drawn ray by ray and by packets with all sets of instructions.
void ExpectSameBits(bool shaded, SampleInterpolation interpolation, bool sparse, bool hides)
{
  const glm::ivec3 n(33, 29, 31);
  const std::vector<double> numbers = NumbersOf(Sampled(n, 4, sparse), 4);
  RayScene scene = SceneOf(n, { 70, 45 }, sparse ? SparseWhite : White);
  scene.Shading = { shaded, 0.3f, 0.7f, 0.4f, 12.0f };
  scene.OpacityLimit = 0.9f;
  const Box cells{ glm::ivec3(0), n - 1 };
  const StepTable table(scene.Transfer, scene.SampleDistance);
  const ShadingTable shading(scene.Shading, glm::dmat3(1.0));
  const ShadingTable* const light = shaded ? &shading : nullptr;
  BrickView view{ numbers.data(), ScalarType::Float64, { 1, n.x, std::ptrdiff_t{ n.x } * n.y },
    {} };
  PackedBrick packed = shaded
                         ? PackedBrick(view, { glm::ivec3(0), n }, cells, 0.0, 1.0f / 128.0f, true)
                         : PackedBrick(view, glm::ivec3(0), cells, 0.0, 0.0, true);
  if (hides)
  {
    HiddenCells hidden(n - 1);
    const std::vector<std::uint8_t> flags(8 * 8 * 8, 1);
    hidden.Hide({ glm::ivec3(9), glm::ivec3(17) }, flags.data(), 1);
    packed.Hide(HiddenInBrick(&hidden, cells));
  }
  const BrickVisibility seen(packed, { 0.0, 255.0 }, VisibleValues(scene.Transfer));
  EXPECT_TRUE(!sparse || seen.Holes);
  const auto draw = [&](auto march)
  {
    const RayLattice lattice(scene);
    FloatImage picture;
    picture.Rect = scene.Viewport;
    picture.Pixels.assign(static_cast<std::size_t>(scene.Viewport.Count()), glm::vec4(0, 0, 0, 1));
    const auto tile = std::make_unique<RayTile>();
    for (int y = 0; y < scene.Viewport.Hi.y; y += RayTile::Edge)
    {
      for (int x = 0; x < scene.Viewport.Hi.x; x += RayTile::Edge)
      {
        const PixelRect rect =
          Intersection({ { x, y }, glm::ivec2(x, y) + RayTile::Edge }, scene.Viewport);
        tile->Open(lattice, rect, picture, 1.0f - scene.OpacityLimit);
        march(packed, seen, table, light, scene.Viewport, *tile, interpolation);
        tile->Close(picture);
      }
    }
    return picture;
  };
  const FloatImage plain = draw(MarchUnpacked);
  EXPECT_GT(Most(plain, ColourOf), 0.05f);
  for (const std::int64_t target : targets::OfThisMachine())
  {
    SCOPED_TRACE(hwy::TargetName(target));
    const targets::OnlyTarget only(target);
    EXPECT_EQ(MaxDifference(draw(MarchPacked), plain), 0.0);
  }
}

TEST(Colours, PacketsGiveTheBitsOfSingleRays)
{
  for (const bool shaded : { false, true })
  {
    for (const auto interpolation : { SampleInterpolation::Linear, SampleInterpolation::Nearest })
    {
      for (const bool sparse : { false, true })
      {
        ExpectSameBits(shaded, interpolation, sparse, false);
        ExpectSameBits(shaded, interpolation, sparse, true);
      }
    }
  }
}

} // namespace
