// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/BrickMarcher.h"
#include "Render/Scenes.h"
#include "Targets.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

const glm::ivec3 N{ 33, 26, 37 };

RayScene SceneOf(const scenes::Function& function = scenes::Smooth, double distance = 1.4)
{
  RayScene scene = scenes::Scene(N, { 61, 50 }, glm::dmat4(1.0), distance);
  scene.Transfer = scenes::Tabulate(function);
  scene.Interpolation = SampleInterpolation::Nearest;
  return scene;
}

TEST(Nearest, AgreesWithTheReference)
{
  const std::vector<float> values = scenes::Sampled(scenes::Standard, N);
  for (const double distance : { 0.1, 1.4 })
  {
    RayScene scene = SceneOf(scenes::Smooth, distance);
    const auto reference = [&] {
      return ReferenceImage(
        scene, scenes::ValueOf(values, N), scenes::NearestEntry(scene.Transfer));
    };
    const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, N)).Image;
    EXPECT_LE(MaxDifference(image, reference()), 1e-4);
    scene.Interpolation = SampleInterpolation::Linear;
    EXPECT_GT(MaxDifference(image, reference()), 0.01);
  }
}

/// Labels 0 and 2 beside each other: what lies between has the colour of one of them, never of 1.
TEST(Nearest, LabelsAreNotMixed)
{
  std::vector<std::uint8_t> labels = scenes::Sampled<std::uint8_t>(
    [](const glm::dvec3& p) { return p.x + p.y < 1.0 ? 0.0 : 2.0; }, N);
  RayScene scene = SceneOf();
  scene.Transfer = scenes::Tabulate(
    [](double value)
    {
      const bool between = value > 0.25 && value < 0.75;
      return between ? glm::dvec4(0, 1, 0, 1) : glm::dvec4(value, 0, 1.0 - value, 0.05);
    });
  scene.Transfer.High = 2.0;
  const auto greenest = [&]
  {
    float most = 0.0f;
    for (const glm::vec4& pixel : scenes::Draw(scene, scenes::ArrayOf(labels, N)).Image.Pixels)
    {
      most = std::max(most, pixel.g);
    }
    return most;
  };
  EXPECT_EQ(greenest(), 0.0f);
  scene.Interpolation = SampleInterpolation::Linear;
  EXPECT_GT(greenest(), 0.9f);
}

TEST(Nearest, MissingValuesDoNotSpread)
{
  std::vector<float> values(std::size_t(N.x) * N.y * N.z, 1.0f);
  for (std::size_t i = 0; i < values.size(); i += 2)
  {
    values[i] = NAN;
  }
  RayScene scene = SceneOf();
  const FloatImage image = scenes::Draw(scene, scenes::ArrayOf(values, N)).Image;
  EXPECT_GT(image.At(30, 25).a, 0.5f);
  scene.Interpolation = SampleInterpolation::Linear;
  EXPECT_EQ(scenes::Draw(scene, scenes::ArrayOf(values, N)).Image.At(30, 25).a, 0.0f);
}

TEST(Nearest, BrickSizeChangesNoBit)
{
  const std::vector<float> values = scenes::Sampled(scenes::Standard, N);
  for (const bool shaded : { false, true })
  {
    RayScene scene = SceneOf(scenes::Sparse);
    scene.SampleDistance = 0.7;
    scene.Shading = { shaded, 0.2f, 0.6f, 0.3f, 7.0f };
    const FloatImage image =
      scenes::Draw(scene, scenes::ArrayOf(values, N), { 16, 1, 1u << 30 }).Image;
    for (const int cells : { 1, 4, 7, 32 })
    {
      const FloatImage other =
        scenes::Draw(scene, scenes::ArrayOf(values, N), { cells, 2, 1u << 30 }).Image;
      EXPECT_EQ(MaxDifference(other, image), 0.0) << cells;
    }
  }
}

/// Packets against single rays, on all sets of instructions.
void ExpectSameBits(const RayScene& scene, const std::vector<float>& values, bool shaded)
{
  const StepTable table(scene.Transfer, scene.SampleDistance);
  const ShadingTable shading({ true, 0.2f, 0.6f, 0.4f, 7.5f }, glm::dmat3(1.0));
  BrickView view{ values.data(), ScalarType::Float32, { 1, N.x, N.x * N.y }, {} };
  const Box cells{ { 2, 1, 3 }, { 30, 25, 36 } };
  const PackedBrick packed = shaded
                               ? PackedBrick(view, { glm::ivec3(0), N }, cells, table.Low(), 4.0f)
                               : PackedBrick(view, glm::ivec3(0), cells, table.Low());
  const BrickVisibility seen(packed, { -1e30, 1e30 }, VisibleValues(scene.Transfer));
  const RayLattice lattice(scene);
  const auto draw = [&](auto&& march)
  {
    FloatImage picture;
    picture.Rect = { { 10, 10 }, { 42, 42 } };
    picture.Pixels.assign(picture.Rect.Count(), glm::vec4(0.125f, 0.0f, 0.25f, 0.75f));
    const auto tile = std::make_unique<RayTile>();
    tile->Open(lattice, picture.Rect, picture, 0.2f);
    march(packed, seen, table, shaded ? &shading : nullptr, picture.Rect, *tile,
      SampleInterpolation::Nearest);
    EXPECT_GT(tile->SamplesTaken, 1000);
    tile->Close(picture);
    return picture;
  };
  const FloatImage plain = draw(MarchUnpacked);
  for (const std::int64_t target : targets::OfThisMachine())
  {
    SCOPED_TRACE(hwy::TargetName(target));
    const targets::OnlyTarget only(target);
    EXPECT_EQ(MaxDifference(draw(MarchPacked), plain), 0.0);
  }
}

TEST(Nearest, PacketsGiveTheBitsOfSingleRays)
{
  std::vector<float> values = scenes::Sampled(scenes::Standard, N);
  for (const bool special : { false, true })
  {
    for (const bool shaded : { false, true })
    {
      ExpectSameBits(SceneOf(scenes::Smooth), values, shaded);
      ExpectSameBits(SceneOf(scenes::Sparse), values, shaded);
    }
    std::mt19937 random(3);
    const float odd[] = { NAN, INFINITY, -INFINITY, 3e38f, -3e38f };
    for (int i = 0; i < 200 && !special; ++i)
    {
      values[random() % values.size()] = odd[i % 5];
    }
  }
}

} // namespace
