// SPDX-License-Identifier: BSD-3-Clause
// Steps whose motion is brought out while they are drawn: brick by brick what whole arrays give.
#include "Render/Levels/RayCaster.h"
#include "Render/Scenes.h"
#include "Render/Steps/EnhancedBrickSource.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace
{

using namespace banyan;

constexpr int Brick = 8;
const TemporalEnhancement How{ 0.6, 2.0, 0.01, 1.5 };

/// A wave that moves through one half of a box; the other half rests at 0.25, but for a part at 0.
float Value(const glm::ivec3& p, const glm::ivec3& n, int step)
{
  if (2 * p.x > n.x)
  {
    return 2 * p.y > n.y ? 0.0f : 0.25f;
  }
  return static_cast<float>(std::exp(-0.05 * p.z) * std::sin(0.4 * p.x + 0.3 * p.y - 0.9 * step));
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
        values.push_back(Value({ x, y, z }, n, step));
      }
    }
  }
  return values;
}

class EnhancedBricks : public testing::Test
{
protected:
  EnhancedBricks()
  {
    for (int i = 0; i < 3; ++i)
    {
      this->Steps[i] = Step(this->Samples, i);
    }
    for (std::size_t i = 0; i < this->Steps[1].size(); ++i)
    {
      const double before = this->Steps[0][i];
      const double after = this->Steps[2][i];
      this->Enhanced.push_back(
        static_cast<float>(EnhancedValue(How, this->Steps[1][i], &before, &after)));
    }
  }

  std::unique_ptr<BrickSource> Plain(const std::vector<float>& values)
  {
    return std::make_unique<ArrayBrickSource>(
      scenes::ArrayOf(values, this->Samples), Brick, MaskRange{ -2.0, 2.0 }, this->Pool);
  }

  std::unique_ptr<EnhancedBrickSource> Source()
  {
    return std::make_unique<EnhancedBrickSource>(
      How, this->Plain(this->Steps[0]), this->Plain(this->Steps[1]), this->Plain(this->Steps[2]));
  }

  /// Checks every sample of every brick against the array, and all bounds.
  void ExpectLevel(BrickSource& source, int level)
  {
    const glm::ivec3 counts = source.Bricks();
    for (std::int64_t b = 0; b < std::int64_t{ counts.x } * counts.y * counts.z; ++b)
    {
      const Box cells = source.CellsOf(b);
      const BrickView view = source.Load(b);
      ASSERT_EQ(view.Type, ScalarType::Float32);
      const ValueRange range = source.RangeOf(b);
      const std::optional<UniformValue> uniform = source.UniformValueOf(b);
      for (glm::ivec3 p = cells.Lo; p.z <= cells.Hi.z; ++p.z)
      {
        for (p.y = cells.Lo.y; p.y <= cells.Hi.y; ++p.y)
        {
          for (p.x = cells.Lo.x; p.x <= cells.Hi.x; ++p.x)
          {
            const glm::ivec3 at = glm::min(p << level, this->Samples - 1);
            const float expected = this->Enhanced[at.x + static_cast<std::size_t>(this->Samples.x) *
                                                           (at.y + this->Samples.y * at.z)];
            const glm::ivec3 local = p - cells.Lo;
            const float found = static_cast<const float*>(
              view.Values)[local.x * view.Stride[0] + local.y * view.Stride[1] +
                           local.z * view.Stride[2]];
            ASSERT_EQ(found, expected);
            ASSERT_LE(range.Low, found);
            ASSERT_GE(range.High, found);
            ASSERT_TRUE(!uniform || uniform->Value == found);
            ASSERT_TRUE(source.MaskOf(b) >> source.MasksAreOver().BinOf(found) & 1);
          }
        }
      }
    }
  }

  glm::ivec3 Samples{ 33, 27, 20 };
  ThreadPool Pool{ 2 };
  std::array<std::vector<float>, 3> Steps;
  std::vector<float> Enhanced;
};

TEST_F(EnhancedBricks, HaveTheValuesOfTheWholeArray)
{
  const auto source = this->Source();
  this->ExpectLevel(*source, 0);
}

TEST_F(EnhancedBricks, AreEnhancedAtCoarserLevels)
{
  const auto source = this->Source();
  const Box domain{ glm::ivec3(0), this->Samples - 1 };
  BrickSource* const coarse = source->AtLevel(1, domain);
  ASSERT_TRUE(coarse);
  this->ExpectLevel(*coarse, 1);
}

TEST_F(EnhancedBricks, StaticOnesAreNotLoaded)
{
  const auto source = this->Source();
  int uniform = 0;
  const glm::ivec3 counts = source->Bricks();
  for (std::int64_t b = 0; b < std::int64_t{ counts.x } * counts.y * counts.z; ++b)
  {
    uniform += source->UniformValueOf(b) ? 1 : 0;
  }
  EXPECT_GT(uniform, 0);
}

TEST_F(EnhancedBricks, MakeThePictureOfTheEnhancedArray)
{
  const auto enhanced = this->Source();
  const auto plain = this->Plain(this->Enhanced);
  RayScene scene = scenes::Scene(this->Samples, { 70, 50 });
  scene.Transfer.Low = -2.0;
  scene.Transfer.High = 2.0;
  RayStatistics statistics;
  const FloatImage a =
    CastRays(scene, *enhanced, scene.DomainCells, 1 << 24, this->Pool, statistics);
  const FloatImage b = CastRays(scene, *plain, scene.DomainCells, 1 << 24, this->Pool, statistics);
  EXPECT_TRUE(a.Pixels == b.Pixels);
  EXPECT_GT(statistics.SamplesTaken, 0);
}

TEST(EnhancedValues, LieInTheRangeThatIsForetold)
{
  const double values[] = { -3.0, -1.0, -1e-9, 0.0, 1e-12, 0.5, 1.0, 7.0 };
  for (const double strength : { 0.0, 0.2, 0.5, 1.0 })
  {
    const TemporalEnhancement how{ strength, 2.5, 0.0, 3.0 };
    for (const double low : values)
    {
      for (const double high : values)
      {
        if (low > high)
        {
          continue;
        }
        const ValueRange range = EnhancedRange(how, { low, high });
        for (const double now : { low, 0.5 * (low + high), high })
        {
          for (const double other : { -now, 0.0, now, 2.0 * now, -1e9, 1e9 })
          {
            const double value = EnhancedValue(how, now, &other, nullptr);
            ASSERT_LE(range.Low, value) << low << " " << high << " " << now << " " << strength;
            ASSERT_GE(range.High, value) << low << " " << high << " " << now << " " << strength;
          }
        }
      }
    }
  }
}

} // namespace
