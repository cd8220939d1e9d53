// SPDX-License-Identifier: BSD-3-Clause
// Each way to quantize, encoded, read back and judged here by arithmetic that is not the encoder's.
#include "Series/QuantizersTesting.h"

#include "Base/Error.h"

namespace banyan::testing
{
namespace
{

constexpr int Edge = 40;

/// A source that radiates: decades less far away and late.
float Decades(int x, int y, int z, int step)
{
  const double r = std::sqrt(double(x * x + y * y + z * z));
  return static_cast<float>(1e4 * std::exp(-0.35 * r - 1.5 * step) * std::sin(0.7 * r - step));
}

long double Same(float x)
{
  return x;
}

TEST(Quantizers, AsinhKeepsLateStepsThatUniformLoses)
{
  const Grid grid = GridOf(Edge, Edge, Edge);
  auto steps = Sample<float>(grid, 6, Decades);
  steps[2][77] = std::nanf("5");
  EncodeOptions options;
  const Written uniform(grid, steps, options);
  options.Quantizer.Map = TransformChoice::Asinh;
  const Written asinh(grid, steps, options);
  const Transform& map = asinh.Component().ValueTransform;
  ASSERT_EQ(map.Kind(), TransformKind::Asinh);
  const long double scale = map.Scale();
  const auto f = [scale](float x) { return std::asinh(static_cast<long double>(x) / scale); };
  const ValueRange range = asinh.Component().PromisedRange;
  const double bound = asinh.Component().ErrorBoundAbsolute;
  EXPECT_NEAR(bound,
    (std::asinh(range.High / double(scale)) - std::asinh(range.Low / double(scale))) / 512, 1e-12);
  const double error = GreatestError(asinh, steps, f);
  EXPECT_LE(error, bound * (1 + 1e-12));
  EXPECT_GT(error, bound / 4); // the bound is used
  EXPECT_NEAR(error, asinh.Component().MeasuredMaxErrorTransformed, bound * 1e-9);
  EXPECT_LE(GreatestError(uniform, steps, Same), uniform.Component().ErrorBoundAbsolute);
  // What is left of the last step: the error's norm over that of the step.
  const auto lost = [&](const Written& written)
  {
    const std::vector<float> decoded = written.Read(5);
    double errors = 0;
    double values = 0;
    for (std::size_t i = 0; i < decoded.size(); ++i)
    {
      errors += std::pow(double(decoded[i]) - double(steps[5][i]), 2);
      values += std::pow(double(steps[5][i]), 2);
    }
    return std::sqrt(errors / values);
  };
  EXPECT_GT(lost(uniform), 0.9);
  EXPECT_LT(lost(asinh), 0.05);
}

TEST(Quantizers, TableOfTheUser)
{
  const Grid grid = GridOf(Edge, 33, 17);
  const auto steps = Sample<float>(grid, 3, Wavy<float>);
  EncodeOptions options;
  options.ErrorBound = 0.05;
  options.Mode = ErrorBoundMode::Absolute;
  options.Quantizer.Map = TransformChoice::Table;
  options.Quantizer.Knots = { { -100, -100 }, { 0, 0 }, { 20, 200 }, { 100, 280 } };
  const Written written(grid, steps, options);
  EXPECT_EQ(written.Component().ErrorBoundAbsolute, 0.05);
  const auto f = [](float x) -> long double { return x < 0 ? x : x < 20 ? 10.0L * x : 180.0L + x; };
  EXPECT_LE(GreatestError(written, steps, f), 0.05 * (1 + 1e-9));
  // Ten times as exact where the table is ten times as steep.
  double inside = 0;
  for (std::size_t i = 0; i < steps[0].size(); ++i)
  {
    const float x = steps[0][i];
    inside = std::max(inside, x > 1 && x < 19 ? double(std::abs(written.Read(0)[i] - x)) : 0.0);
    if (i > 2000)
    {
      break;
    }
  }
  EXPECT_LE(inside, 0.0051);
}

TEST(Quantizers, AdaptiveIsMoreExactWhereValuesAre)
{
  const Grid grid = GridOf(Edge, Edge, 20);
  // Nearly all values lie close to 1; few go up to 100.
  const auto steps = Sample<float>(grid, 3,
    [](int x, int y, int z, int step)
    {
      const double wave = 1 + 0.5 * std::sin(0.2 * x + 0.1 * step) * std::cos(0.15 * y + 0.1 * z);
      return x == y && z == 3 ? 2.5 * x : wave;
    });
  EncodeOptions options;
  const Written uniform(grid, steps, options);
  options.Quantizer.Map = TransformChoice::Adaptive;
  const Written adaptive(grid, steps, options);
  const Transform map = adaptive.Component().ValueTransform;
  ASSERT_EQ(map.Kind(), TransformKind::Table);
  const std::vector<TransformKnot>& knots = map.Knots();
  const auto f = [&knots](float x) -> long double
  {
    std::size_t j = 0;
    while (j + 2 < knots.size() && knots[j + 1].X <= x)
    {
      ++j;
    }
    const long double slope = (static_cast<long double>(knots[j + 1].Y) - knots[j].Y) /
                              (static_cast<long double>(knots[j + 1].X) - knots[j].X);
    return knots[j].Y + (x - static_cast<long double>(knots[j].X)) * slope;
  };
  EXPECT_LE(
    GreatestError(adaptive, steps, f), adaptive.Component().ErrorBoundAbsolute * (1 + 1e-9));
  const auto rmse = [](const Written& w)
  { return std::sqrt(w.Component().SumSquaredError / double(w.Component().FiniteCount)); };
  EXPECT_LT(rmse(adaptive), 0.5 * rmse(uniform));
}

TEST(Quantizers, PercentilesLetNoOutlierSetTheRange)
{
  const Grid grid = GridOf(Edge, 35, 30);
  const auto clean = Sample<float>(grid, 3, Wavy<float>);
  auto steps = clean;
  steps[1][12345] = 1e6f;
  steps[2][54] = -3e7f;
  steps[0][999] = 75.0f; // a little outside
  EncodeOptions options;
  options.Quantizer.Range.From = RangeRule::Source::Percentiles;
  options.Quantizer.Range.LowShare = 0.001;
  options.Quantizer.Range.HighShare = 0.999;
  const Written written(grid, steps, options);
  const ComponentIndex& component = written.Component();
  EXPECT_LT(component.ErrorBoundAbsolute, 100.0 / 512);
  EXPECT_LE(GreatestError(written, steps, Same), component.ErrorBoundAbsolute);
  EXPECT_EQ(written.Read(1)[12345], 1e6f);
  EXPECT_EQ(written.Read(2)[54], -3e7f);
  // What is near is on the lattice: only the two are kept beside it.
  EXPECT_EQ(written.Index.Statistics.ExceptionVoxels, 2);
  EXPECT_EQ(component.RangeFrom, RangeRule::Source::Percentiles);
  // It costs little beside the series without outliers, with the same absolute bound.
  EncodeOptions same;
  same.Mode = ErrorBoundMode::Absolute;
  same.ErrorBound = component.ErrorBoundAbsolute;
  EXPECT_LT(double(written.Bytes()), 1.1 * double(Written(grid, clean, same).Bytes()) + 200);
}

TEST(Quantizers, FillValuesAreBitExactAndSetNoRange)
{
  const Grid grid = GridOf(Edge, 35, 30);
  auto steps = Sample<float>(grid, 3, Wavy<float>);
  std::int64_t fills = 0;
  for (auto& step : steps)
  {
    for (std::size_t i = 0; i < step.size(); ++i)
    {
      if (i % Edge < 4) // 10 %
      {
        step[i] = i % 2 ? 1e20f : -9.0f; // one far away, one in the middle of the data
        ++fills;
      }
    }
  }
  EncodeOptions options;
  options.Quantizer.FillValues = { 1e20, -9 };
  const Written written(grid, steps, options);
  EXPECT_LT(written.Component().ErrorBoundAbsolute, 110.0 / 512);
  EXPECT_EQ(written.Component().FillCount, fills);
  for (int s = 0; s < 3; ++s)
  {
    const auto decoded = written.Read(s);
    for (std::size_t i = 0; i < decoded.size(); ++i)
    {
      if (i % Edge < 4)
      {
        ASSERT_TRUE(SameBits(decoded[i], steps[std::size_t(s)][i]));
      }
    }
  }
  EXPECT_LE(GreatestError(written, steps, Same), written.Component().ErrorBoundAbsolute);
  // The same with percentiles and no name for the one that is far away.
  options.Quantizer.FillValues.clear();
  options.Quantizer.Range = { RangeRule::Source::Percentiles, 0.0, 0.9, {}, false };
  const Written percentiles(grid, steps, options);
  EXPECT_LT(percentiles.Component().ErrorBoundAbsolute, 110.0 / 512);
  EXPECT_LE(GreatestError(percentiles, steps, Same), percentiles.Component().ErrorBoundAbsolute);
  // An absolute bound needs no counting beforehand; the lattice leaves fill values out all the
  // same.
  EncodeOptions absolute;
  absolute.Mode = ErrorBoundMode::Absolute;
  absolute.ErrorBound = 0.2;
  absolute.Quantizer.FillValues = { 1e20, -9 };
  const TemporaryFolder folder;
  ThreadPool pool(2);
  ArrayDescription description = Describe(steps);
  description.SeriesRanges.clear();
  SeriesEncoder encoder(folder / "a.banyan", grid, { description }, absolute, pool);
  encoder.AddStep(0, { { steps[0].data() } });
  const std::int64_t kept = encoder.Finish().Statistics.ExceptionVoxels;
  EXPECT_LE(kept, fills / 3);
  EXPECT_GE(kept, fills / 6); // but for those that the lattice happens to hold
}

TEST(Quantizers, ClampingIsCountedAndTheRestIsBounded)
{
  const Grid grid = GridOf(Edge, 35, 30);
  auto steps = Sample<float>(grid, 3, Wavy<float>);
  steps[0][5] = std::numeric_limits<float>::infinity();
  steps[1][6] = 1e20f;
  EncodeOptions options;
  options.Quantizer.Range = { RangeRule::Source::Given, 0, 1, { -10.0, 40.0 }, true };
  options.Quantizer.FillValues = { 1e20 };
  const Written written(grid, steps, options);
  const double bound = written.Component().ErrorBoundAbsolute;
  EXPECT_EQ(bound, 50.0 / 512);
  std::int64_t outside = 0;
  for (int s = 0; s < 3; ++s)
  {
    const auto decoded = written.Read(s);
    for (std::size_t i = 0; i < decoded.size(); ++i)
    {
      const float x = steps[std::size_t(s)][i];
      if (!std::isfinite(x) || x == 1e20f)
      {
        ASSERT_EQ(decoded[i], x);
        continue;
      }
      outside += x < -10 || x > 40 ? 1 : 0;
      ASSERT_LE(std::abs(double(decoded[i]) - std::min(std::max(double(x), -10.0), 40.0)), bound);
    }
  }
  EXPECT_GT(outside, 1000);
  EXPECT_EQ(written.Component().ClampedCount, outside);
  EXPECT_EQ(written.Component().FillCount, 1);
}

/// Blocks that lie in one interval with the samples around them have no payload, which they have
/// where all counts.
/// @param intervalOf of a value, 0 where it can be seen
template <class Function>
void ExpectInvisibleBlocksAreFree(
  const Written& visible, const Written& all, const Steps<float>& steps, const Function& intervalOf)
{
  const BrickLayout layout = visible.File->Layout(0);
  const glm::ivec3 n = layout.Samples();
  int free = 0;
  std::uint64_t spared = 0;
  for (int s = 0; s < static_cast<int>(steps.size()); ++s)
  {
    const FieldKey field{ s, 0, 0, 0 };
    const auto nodes = visible.File->Nodes(field), nodesOfAll = all.File->Nodes(field);
    for (std::int64_t brick = 0; brick < layout.BrickCount(); ++brick)
    {
      const Box block = layout.CellsOf(brick);
      const Box around{ glm::max(block.Lo - 1, glm::ivec3(0)), glm::min(block.Hi + 1, n) };
      bool hidden = true;
      const auto valueAt = [&](const glm::ivec3& p)
      { return steps[std::size_t(s)][(std::size_t(p.z) * n.y + p.y) * n.x + p.x]; };
      const int interval = intervalOf(valueAt(block.Lo));
      for (int z = around.Lo.z; z < around.Hi.z; ++z)
      {
        for (int y = around.Lo.y; y < around.Hi.y; ++y)
        {
          for (int x = around.Lo.x; x < around.Hi.x; ++x)
          {
            const float value = valueAt({ x, y, z });
            hidden =
              hidden && std::isfinite(value) && interval != 0 && intervalOf(value) == interval;
          }
        }
      }
      if (hidden)
      {
        EXPECT_EQ((*nodes)[std::size_t(brick)].PayloadBytes, 0u)
          << "step " << s << ", brick " << brick;
        spared += (*nodesOfAll)[std::size_t(brick)].PayloadBytes;
        ++free;
      }
    }
  }
  EXPECT_GT(free, 100);
  EXPECT_GT(spared, std::uint64_t(free) * 200);
}

TEST(Quantizers, InvisibleValuesCostNothingAndStayInvisible)
{
  // A ball of values around 1 in a noisy ambient, and a thin shell above 2 that is invisible too.
  const Grid grid = GridOf(70, 64, 50);
  auto steps = Sample<float>(grid, 5,
    [](int x, int y, int z, int step)
    {
      const double r = std::hypot(std::hypot(x - 20 - step, y - 30), z - 25);
      const double noise = std::sin(12.9898 * x + 78.233 * y + 37.719 * z + step);
      return r < 12 ? 1.0 + 0.3 * std::sin(0.4 * r) : r < 14 ? 2.6 : 0.2 + 0.1 * noise;
    });
  steps[3][3] = std::nanf("7");
  EncodeOptions options;
  options.Profile = EncodeProfile::Compact; // which the sizes below are of
  const Written all(grid, steps, options);
  options.Quantizer.Opacity = { { 0.4, 0.0 }, { 0.5, 0.8 }, { 2.0, 0.8 }, { 2.1, 0.0 } };
  const Written visible(grid, steps, options);
  const double bound = visible.Component().ErrorBoundAbsolute;
  EXPECT_EQ(bound, all.Component().ErrorBoundAbsolute);
  const auto intervalOf = [](float x) { return x <= 0.4f ? 1 : x >= 2.1f ? 2 : 0; };
  std::int64_t other = 0;
  double weighted = 0;
  for (int s = 0; s < 5; ++s)
  {
    const auto decoded = visible.Read(s);
    for (std::size_t i = 0; i < decoded.size(); ++i)
    {
      const float x = steps[std::size_t(s)][i];
      if (!std::isfinite(x))
      {
        ASSERT_TRUE(SameBits(decoded[i], x));
        continue;
      }
      const double error = std::abs(double(decoded[i]) - double(x));
      if (error > bound)
      {
        ++other;
        ASSERT_NE(intervalOf(x), 0);
        ASSERT_EQ(intervalOf(x), intervalOf(decoded[i]));
        // Nothing around it can be seen, so that no visible edge moved.
        for (const int step : { 1, 70, 70 * 64 })
        {
          ASSERT_EQ(intervalOf(steps[std::size_t(s)][i + step < decoded.size() ? i + step : i]),
            intervalOf(x));
          ASSERT_EQ(intervalOf(steps[std::size_t(s)][i >= std::size_t(step) ? i - step : i]),
            intervalOf(x));
        }
      }
      const double opacity = x <= 0.4f   ? 0
                             : x < 0.5f  ? 8.0 * (x - 0.4)
                             : x <= 2.0f ? 0.8
                             : x < 2.1f  ? 8.0 * (2.1 - x)
                                         : 0;
      weighted += opacity * error * error;
    }
  }
  EXPECT_GT(other, 100000);
  EXPECT_EQ(visible.Component().InvisibleCount, other);
  EXPECT_NEAR(visible.Component().SumWeightedError, weighted, 1e-5 * weighted);
  EXPECT_NEAR(visible.Component().OpacityWeightedError(),
    weighted / double(visible.Component().FiniteCount) /
      std::pow(visible.Component().Range.Width(), 2),
    1e-5 * visible.Component().OpacityWeightedError());
  EXPECT_LT(double(visible.Bytes()), 0.5 * double(all.Bytes()));
  EXPECT_LE(visible.Component().MeasuredMaxError, bound);
  ExpectInvisibleBlocksAreFree(visible, all, steps, intervalOf);
}

TEST(Quantizers, OptionsOfOneArray)
{
  const Grid grid = GridOf(20, 20, 20);
  const auto steps = Sample<float>(grid, 2, Decades);
  EncodeOptions options;
  options.QuantizerOfArray["values"].Map = TransformChoice::Asinh;
  options.QuantizerOfArray["values"].AsinhScale = 2.0;
  EXPECT_FALSE(options.NeedsHistogram("values"));
  const TemporaryFolder folder;
  const SeriesIndex index = Encode(folder / "a.banyan", grid, steps, options);
  EXPECT_EQ(index.Arrays[0].Components[0].ValueTransform, Transform::Asinh(2.0));
  options.QuantizerOfArray["other"].AsinhScale = 1;
  EXPECT_THROW(Encode(folder / "b.banyan", grid, steps, options), Error);
}

TEST(Quantizers, RefusesWhatDoesNotFit)
{
  const Grid grid = GridOf(8, 8, 8);
  const auto steps = Sample<float>(grid, 1, Wavy<float>);
  const TemporaryFolder folder;
  const auto refused = [&](auto&& change)
  {
    EncodeOptions options;
    change(options.Quantizer);
    EXPECT_THROW(Encode(folder / "a.banyan", grid, steps, options), Error);
  };
  refused([](QuantizerOptions& q) { q.Map = TransformChoice::Adaptive; }); // nothing was counted
  refused([](QuantizerOptions& q) { q.Range.From = RangeRule::Source::Percentiles; });
  refused([](QuantizerOptions& q) { q.Map = TransformChoice::Table; });
  refused([](QuantizerOptions& q) { q.Opacity = { { 0, 2 } }; });
  refused([](QuantizerOptions& q) { q.FillValues = { std::nan("") }; });
  refused(
    [](QuantizerOptions& q)
    {
      q.Map = TransformChoice::Asinh;
      q.AsinhScale = -1;
    });
  EXPECT_TRUE(folder.Empty());
}

} // namespace
} // namespace banyan::testing
