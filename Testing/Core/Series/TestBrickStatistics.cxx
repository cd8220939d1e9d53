#include "Series/BrickStatistics.h"
#include "Series/SeriesTesting.h"

namespace banyan::testing
{
namespace
{

template <class T>
ValueMask SlowMask(const std::vector<T>& v, const glm::ivec3& n, const MaskRange& range)
{
  ValueMask mask = 0;
  const glm::ivec3 cells = glm::max(n - 1, glm::ivec3(1));
  for (int z = 0; z < cells.z; ++z)
  {
    for (int y = 0; y < cells.y; ++y)
    {
      for (int x = 0; x < cells.x; ++x)
      {
        int first = 64;
        int last = -1;
        for (int c = 0; c < 8; ++c)
        {
          const glm::ivec3 p =
            glm::min(glm::ivec3(x, y, z) + glm::ivec3(c & 1, c >> 1 & 1, c >> 2), n - 1);
          const double value = static_cast<double>(v[(p.z * n.y + p.y) * n.x + p.x]);
          if (std::isfinite(value))
          {
            first = std::min(first, range.BinOf(value));
            last = std::max(last, range.BinOf(value));
          }
        }
        mask |= first <= last ? MaskOfBins(first, last) : 0;
      }
    }
  }
  return mask;
}

const std::vector<glm::ivec3> Shapes = { { 1, 1, 1 }, { 1, 1, 2 }, { 1, 6, 1 }, { 5, 1, 4 },
  { 2, 2, 2 }, { 3, 3, 1 }, { 9, 9, 9 }, { 17, 4, 3 } };

TEST(BrickStatistics, MaskIsThatOfTheSlowReference)
{
  std::mt19937 random(23);
  for (const glm::ivec3& n : Shapes)
  {
    for (int round = 0; round < 60; ++round)
    {
      std::uniform_real_distribution<float> uniform(
        -0.2f + 0.01f * static_cast<float>(round), round % 3 == 0 ? 0.5f : 1.3f);
      std::vector<float> v(static_cast<std::size_t>(n.x * n.y * n.z));
      for (float& value : v)
      {
        const auto dice = random() % 20;
        value = uniform(random);
        value = round % 2 == 0 && dice == 0 ? std::nanf("") : value;
        value = round % 2 == 0 && dice == 1 ? -INFINITY : value;
        value = round % 2 == 0 && dice == 2 ? INFINITY : value;
      }
      for (const MaskRange& range : { MaskRange{ 0, 1 }, MaskRange{ 0.3, 0.35 },
             MaskRange{ 0.5, 0.5 }, MaskRange{ 1, 0 }, MaskRange{ -1e308, 1e308 } })
      {
        const BrickSummary summary = Summarize(v.data(), n, range);
        EXPECT_EQ(summary.Mask, SlowMask(v, n, range));
        EXPECT_EQ(summary.Range.Low, RangeOf(v).Low);
        EXPECT_EQ(summary.Range.High, RangeOf(v).High);
      }
    }
  }
}

TEST(BrickStatistics, MaskHoldsEveryInterpolant)
{
  std::mt19937 random(29);
  std::uniform_real_distribution<double> unit(0, 1);
  const glm::ivec3 n(5, 5, 5);
  std::vector<double> v(125);
  for (double& value : v)
  {
    value = unit(random) * unit(random);
  }
  const MaskRange range{ 0, 1 };
  const ValueMask mask = Summarize(v.data(), n, range).Mask;
  for (int i = 0; i < 20000; ++i)
  {
    const glm::dvec3 p = glm::dvec3(unit(random), unit(random), unit(random)) * 3.999;
    const glm::ivec3 c(p);
    const glm::dvec3 f = p - glm::dvec3(c);
    double value = 0;
    for (int k = 0; k < 8; ++k)
    {
      const glm::ivec3 d(k & 1, k >> 1 & 1, k >> 2);
      const double w = (d.x ? f.x : 1 - f.x) * (d.y ? f.y : 1 - f.y) * (d.z ? f.z : 1 - f.z);
      value += w * v[((c.z + d.z) * n.y + c.y + d.y) * n.x + c.x + d.x];
    }
    EXPECT_NE(mask >> range.BinOf(value) & 1, 0u);
  }
}

TEST(BrickStatistics, NothingFiniteGivesAnEmptyRange)
{
  const std::vector<double> v(27, std::nan(""));
  const BrickSummary summary = Summarize(v.data(), { 3, 3, 3 }, { 0, 1 });
  EXPECT_TRUE(summary.Range.Empty());
  EXPECT_TRUE(summary.HasNonFinite);
  EXPECT_FALSE(summary.Uniform);
  EXPECT_EQ(summary.Mask, 0u);
}

TEST(BrickStatistics, RangesOfLongIntegersGoOutward)
{
  const std::int64_t odd = (std::int64_t{ 1 } << 60) + 1;
  const std::vector<std::int64_t> v = { -odd, odd };
  const BrickSummary summary = Summarize(v.data(), { 2, 1, 1 }, { 0, 1 });
  EXPECT_LE(static_cast<long double>(summary.Range.Low), static_cast<long double>(-odd));
  EXPECT_GE(static_cast<long double>(summary.Range.High), static_cast<long double>(odd));
  EXPECT_NEAR(summary.Range.High, static_cast<double>(odd), 300);
  const std::vector<std::int64_t> equal(2, odd);
  EXPECT_FALSE(Summarize(equal.data(), { 2, 1, 1 }, { 0, 1 }).Uniform);
  const std::vector<std::uint64_t> top(2, std::numeric_limits<std::uint64_t>::max());
  EXPECT_FALSE(Summarize(top.data(), { 2, 1, 1 }, { 0, 1 }).Uniform);
}

TEST(BrickStatistics, UniformMeansEqualBits)
{
  const std::vector<float> zeros = { 0.0f, -0.0f };
  EXPECT_FALSE(Summarize(zeros.data(), { 2, 1, 1 }, { 0, 1 }).Uniform);
  const std::vector<float> minus(2, -0.0f);
  const BrickSummary summary = Summarize(minus.data(), { 2, 1, 1 }, { 0, 1 });
  EXPECT_TRUE(summary.Uniform);
  EXPECT_TRUE(std::signbit(summary.Range.Low));
}

TEST(BrickStatistics, ErrorsCountOwnedSamplesOnly)
{
  const std::vector<float> original = { 1, 2, 3, std::nanf("") };
  const std::vector<float> decoded = { 1.5f, 2, 13, std::nanf("") };
  const BrickError part = MeasureError(original.data(), decoded.data(), { 4, 1, 1 }, { 2, 1, 1 });
  EXPECT_EQ(part.Maximum, 0.5);
  EXPECT_EQ(part.SumSquared, 0.25);
  EXPECT_EQ(part.Finite, 2);
  const BrickError all = MeasureError(original.data(), decoded.data(), { 4, 1, 1 }, { 4, 1, 1 });
  EXPECT_EQ(all.Maximum, 10);
  EXPECT_EQ(all.Finite, 3);
  EXPECT_EQ(all.NonFinite, 1);
}

} // namespace
} // namespace banyan::testing
