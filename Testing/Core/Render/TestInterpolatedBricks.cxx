// SPDX-License-Identifier: BSD-3-Clause
// Values between two steps, brick by brick as they are drawn: those of whole arrays.
#include "Render/Bricks/ColourNumbers.h"
#include "Render/Bricks/SampledBox.h"
#include "Render/Levels/RayCaster.h"
#include "Render/Scenes.h"
#include "Render/Steps/InterpolatedBrickSource.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

namespace
{

using namespace banyan;

constexpr int Brick = 8;
constexpr float Fill = -1.5f;

/// Plain bricks that know what they hold.
class KnownBricks : public ArrayBrickSource
{
public:
  KnownBricks(const SampleArray& array, ThreadPool& pool)
    : ArrayBrickSource(array, Brick, MaskRange{ -2.0, 2.0 }, pool)
  {
  }
  std::optional<Hash128> ContentOf(std::int64_t brick) const override
  {
    const Box cells = this->CellsOf(brick);
    const Box samples{ cells.Lo, cells.Hi + 1 };
    std::vector<float> values(static_cast<std::size_t>(samples.Count()));
    CopySamples({ const_cast<KnownBricks*>(this)->Load(brick), samples }, samples,
      ScalarType::Float32, values.data());
    return HashOf(values.data(), values.size() * sizeof(float));
  }
};

/// A wave in a part of a box; a part of one value at each step, and one that stays as it is.
float Value(const glm::ivec3& p, int step)
{
  if (p.x >= 24)
  {
    return 0.1f * static_cast<float>(p.y);
  }
  if (p.x >= 8)
  {
    return step == 0 ? 0.25f : 0.75f;
  }
  return std::sin(0.4f * static_cast<float>(p.x) + 0.3f * static_cast<float>(p.y) -
                  0.9f * static_cast<float>(step));
}

std::vector<float> Step(const glm::ivec3& n, int step)
{
  std::vector<float> values;
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      for (int x = 0; x < n.x; ++x)
      {
        values.push_back(Value({ x, y, z }, step));
      }
    }
  }
  return values;
}

/// The slow, obvious way.
float Between(float a, float b, double fraction)
{
  if (a == Fill || b == Fill)
  {
    return Fill;
  }
  return a == b ? a : static_cast<float>((1.0 - fraction) * a + fraction * b);
}

bool Same(float a, float b)
{
  return a == b || (std::isnan(a) && std::isnan(b));
}

class InterpolatedBricks : public testing::TestWithParam<double>
{
protected:
  InterpolatedBricks()
  {
    for (int i = 0; i < 2; ++i)
    {
      this->Steps[i] = Step(this->Samples, i);
    }
    this->Steps[0][3] = std::numeric_limits<float>::quiet_NaN();
    this->Steps[1][5] = std::numeric_limits<float>::infinity();
    this->Steps[0][7] = Fill;
    this->Steps[1][9] = Fill;
    for (std::size_t i = 0; i < this->Steps[0].size(); ++i)
    {
      this->Expected.push_back(Between(this->Steps[0][i], this->Steps[1][i], GetParam()));
    }
  }

  std::unique_ptr<BrickSource> Plain(const std::vector<float>& values)
  {
    return std::make_unique<KnownBricks>(scenes::ArrayOf(values, this->Samples), this->Pool);
  }

  std::unique_ptr<InterpolatedBrickSource> Source(double fraction = GetParam())
  {
    std::vector<InterpolatedBrickSource::Part> parts;
    parts.push_back({ { this->Plain(this->Steps[0]), this->Plain(this->Steps[1]) },
      { fraction, { static_cast<double>(Fill) } } });
    return std::make_unique<InterpolatedBrickSource>(
      ScalarType::Float32, std::move(parts), InterpolatedBrickSource::Ends{}, 0);
  }

  /// Checks every sample of every brick against the array, and all bounds.
  void ExpectLevel(BrickSource& source, int level)
  {
    const glm::ivec3 counts = source.Bricks();
    for (std::int64_t b = 0; b < std::int64_t{ counts.x } * counts.y * counts.z; ++b)
    {
      const Box cells = source.CellsOf(b);
      const Box samples{ cells.Lo, cells.Hi + 1 };
      std::vector<float> found(static_cast<std::size_t>(samples.Count()));
      CopySamples({ source.Load(b), samples }, samples, ScalarType::Float32, found.data());
      const std::optional<UniformValue> uniform = source.UniformValueOf(b);
      std::size_t i = 0;
      for (glm::ivec3 p = cells.Lo; p.z <= cells.Hi.z; ++p.z)
      {
        for (p.y = cells.Lo.y; p.y <= cells.Hi.y; ++p.y)
        {
          for (p.x = cells.Lo.x; p.x <= cells.Hi.x; ++p.x, ++i)
          {
            const glm::ivec3 at = glm::min(p << level, this->Samples - 1);
            const float expected = this->Expected[static_cast<std::size_t>(at.x) +
                                                  static_cast<std::size_t>(this->Samples.x) *
                                                    (at.y + this->Samples.y * at.z)];
            ASSERT_TRUE(Same(found[i], expected)) << found[i] << " " << expected;
            ASSERT_TRUE(!uniform || uniform->Value == found[i]);
            if (std::isfinite(found[i]))
            {
              const ValueRange range = source.RangeOf(b);
              ASSERT_LE(range.Low, found[i]);
              ASSERT_GE(range.High, found[i]);
              ASSERT_TRUE(source.MaskOf(b) >> source.MasksAreOver().BinOf(found[i]) & 1);
            }
          }
        }
      }
    }
  }

  glm::ivec3 Samples{ 33, 27, 20 };
  ThreadPool Pool{ 2 };
  std::array<std::vector<float>, 2> Steps;
  std::vector<float> Expected;
};

TEST_P(InterpolatedBricks, HaveTheValuesOfTheWholeArray)
{
  const auto source = this->Source();
  this->ExpectLevel(*source, 0);
  BrickSource* const coarse = source->AtLevel(1, { glm::ivec3(0), this->Samples - 1 });
  ASSERT_TRUE(coarse);
  this->ExpectLevel(*coarse, 1);
}

TEST_P(InterpolatedBricks, AreTheStepsOwnWhereNothingChanges)
{
  const auto source = this->Source();
  const auto other = this->Source(0.5 * GetParam());
  const auto step = this->Plain(this->Steps[0]);
  const auto next = this->Plain(this->Steps[1]);
  int same = 0;
  int changed = 0;
  int uniform = 0;
  const glm::ivec3 counts = source->Bricks();
  for (std::int64_t b = 0; b < std::int64_t{ counts.x } * counts.y * counts.z; ++b)
  {
    if (step->ContentOf(b) == next->ContentOf(b))
    {
      ++same;
      EXPECT_EQ(source->ContentOf(b), step->ContentOf(b));
      EXPECT_EQ(source->MaskOf(b), step->MaskOf(b));
      EXPECT_EQ(source->LoadBytes(b), step->LoadBytes(b));
      continue;
    }
    ++changed;
    uniform += source->UniformValueOf(b) ? 1 : 0;
    EXPECT_NE(source->ContentOf(b), step->ContentOf(b));
    EXPECT_NE(source->ContentOf(b), next->ContentOf(b));
    EXPECT_NE(source->ContentOf(b), other->ContentOf(b)) << "another time";
    EXPECT_GT(source->LoadBytes(b), 0u);
  }
  EXPECT_GT(same, 0);
  EXPECT_GT(changed, 0);
  EXPECT_GT(uniform, 0) << "of one value at both steps";
}

TEST_P(InterpolatedBricks, MakeThePictureOfTheInterpolatedArray)
{
  const auto between = this->Source();
  const auto plain = this->Plain(this->Expected);
  RayScene scene = scenes::Scene(this->Samples, { 70, 50 });
  scene.Transfer.Low = -2.0;
  scene.Transfer.High = 2.0;
  RayStatistics statistics;
  const FloatImage a =
    CastRays(scene, *between, scene.DomainCells, 1 << 24, this->Pool, statistics);
  const FloatImage b = CastRays(scene, *plain, scene.DomainCells, 1 << 24, this->Pool, statistics);
  EXPECT_TRUE(a.Pixels == b.Pixels);
  const auto step = this->Plain(this->Steps[0]);
  const FloatImage c = CastRays(scene, *step, scene.DomainCells, 1 << 24, this->Pool, statistics);
  EXPECT_FALSE(a.Pixels == c.Pixels) << "the steps must look apart";
}

INSTANTIATE_TEST_SUITE_P(
  Fractions, InterpolatedBricks, testing::Values(0.25, 0.5, 1.0 / 3.0, 0.999));

/// Bins that neither step has lie between.
TEST(InterpolatedMasks, HaveAllBinsBetweenBothSteps)
{
  ThreadPool pool(1);
  const glm::ivec3 samples(5);
  const std::vector<float> low(125, -1.9f);
  const std::vector<float> high(125, 1.9f);
  std::vector<InterpolatedBrickSource::Part> parts;
  parts.push_back({ { std::make_unique<KnownBricks>(scenes::ArrayOf(low, samples), pool),
                      std::make_unique<KnownBricks>(scenes::ArrayOf(high, samples), pool) },
    { 0.5, {} } });
  InterpolatedBrickSource source(
    ScalarType::Float32, std::move(parts), InterpolatedBrickSource::Ends{}, 0);
  EXPECT_TRUE(source.MaskOf(0) >> source.MasksAreOver().BinOf(0.0) & 1);
  ASSERT_TRUE(source.UniformValueOf(0));
  EXPECT_NEAR(source.UniformValueOf(0)->Value, 0.0, 1e-12);
}

/// Vectors that turn by half a circle have no length half-way, whatever lengths they have before.
TEST(InterpolatedLengths, AreThoseOfInterpolatedVectors)
{
  ThreadPool pool(1);
  const glm::ivec3 samples(5);
  const std::vector<float> three(125, 3.0f);
  const std::vector<float> four(125, 4.0f);
  const std::vector<float> five(125, 5.0f);
  std::vector<float> turned(125, -3.0f);
  const auto bricks = [&](const std::vector<float>& values)
  { return std::make_unique<KnownBricks>(scenes::ArrayOf(values, samples), pool); };
  std::vector<InterpolatedBrickSource::Part> parts;
  parts.push_back({ { bricks(three), bricks(turned) }, { 0.5, {} } });
  parts.push_back({ { bricks(four), bricks(four) }, { 0.5, {} } });
  std::vector<float> marked = five; // another content than the lengths before
  marked[0] = 4.9f;
  InterpolatedBrickSource source(ScalarType::Float32, std::move(parts),
    { bricks(five), bricks(marked) }, SampleArray::Magnitude);
  const BrickView view = source.Load(0);
  EXPECT_EQ(*static_cast<const float*>(view.Values), 4.0f);
  EXPECT_LE(source.RangeOf(0).Low, 4.0);
  EXPECT_GE(source.RangeOf(0).High, 4.0);
}

/// Byte by byte: a quarter of the way from one step to the other, rounded.
TEST(InterpolatedColours, AreThoseOfInterpolatedComponents)
{
  ThreadPool pool(1);
  const glm::ivec3 samples(5);
  const float before[4] = { 0.0f, 200.0f, 7.0f, 40.0f };
  const float after[4] = { 80.0f, 100.0f, 7.0f, 200.0f };
  std::vector<std::vector<float>> held;
  const auto bricks = [&](float value)
  {
    held.emplace_back(125, value);
    return std::make_unique<KnownBricks>(scenes::ArrayOf(held.back(), samples), pool);
  };
  held.reserve(10);
  std::vector<InterpolatedBrickSource::Part> parts;
  for (int c = 0; c < 4; ++c)
  {
    parts.push_back({ { bricks(before[c]), bricks(after[c]) }, { 0.25, {} } });
  }
  InterpolatedBrickSource source(
    ScalarType::Float32, std::move(parts), { bricks(1.0f), bricks(2.0f) }, SampleArray::Colours);
  const BrickView view = source.Load(0);
  ASSERT_EQ(view.Type, ScalarType::Float64);
  const double number = *static_cast<const double*>(view.Values);
  EXPECT_EQ(ColourNumber::BytesOf(number), 20u | 175u << 8 | 7u << 16 | 80u << 24);
  EXPECT_EQ(source.RangeOf(0).Low, 40.0);
  EXPECT_EQ(source.RangeOf(0).High, 200.0);
  EXPECT_FALSE(source.UniformValueOf(0));
}

} // namespace
