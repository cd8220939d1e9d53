// SPDX-License-Identifier: BSD-3-Clause
/// Blocks that rest between steps where they move, at the field's end: what lies beyond the end is
/// predicted anew at each step, and later steps refer to it.
#include "Series/SeriesTesting.h"

#include <cmath>

namespace banyan::testing
{
namespace
{

constexpr int Samples = 32; ///< two whole blocks: the layer behind them lies beyond the end

/// Everything moves but in the steps 3 and 7, which refer to one another. Of these the second is a
/// little higher in the field's last layer along an axis: less than what makes a block move, and
/// enough to move the coarser samples that stand for what lies beyond.
/// @param higher in the number of lattice steps
Steps<float> MovingSteps(int axis, double higher)
{
  const double lattice = 1.0 / 256 / 31; // the bound is 1/512, and a bin has 31
  return Sample<float>(GridOf(Samples, Samples, Samples), 8,
    [=](int x, int y, int z, int step)
    {
      const int along = axis == 0 ? x : axis == 1 ? y : z;
      double value =
        0.5 + 0.01 * std::sin(0.04 * x) * std::cos(0.03 * y + 0.5) * std::sin(0.05 * z + 0.4);
      if (step == 7 && along == Samples - 1)
      {
        value += higher * lattice;
      }
      if (step % 4 != 3)
      {
        value += 0.05 * std::sin(0.9 * x + 1.7 * step) * std::sin(0.7 * y) *
                 std::cos(0.8 * z + 0.3 * step);
      }
      return value;
    });
}

class StaticBlocks : public ::testing::TestWithParam<int>
{
};

TEST_P(StaticBlocks, AtTheEndDecodeToWhatTheEncoderMeasured)
{
  for (const double higher : { 6.0, 8.0, 9.0, 10.0, 12.0 })
  {
    SCOPED_TRACE(higher);
    const auto steps = MovingSteps(GetParam(), higher);
    const TemporaryFolder folder;
    const std::string path = folder / "s.banyan";
    ThreadPool pool(2);
    EncodeOptions options;
    options.BrickCells = 16;
    ArrayDescription description = Describe(steps);
    description.SeriesRanges = { ValueRange{ 0, 1 } };
    SeriesEncoder encoder(path, GridOf(Samples, Samples, Samples), { description }, options, pool);
    for (std::size_t s = 0; s < steps.size(); ++s)
    {
      encoder.AddStep(static_cast<double>(s), { { steps[s].data() } });
    }
    const SeriesIndex index = encoder.Finish();
    EXPECT_GE(index.Statistics.MergedBricks, 4) << "too little rests for this to be a test";
    const ComponentIndex& component = index.Arrays[0].Components[0];
    const auto file = SeriesFile::Open(path);
    double sum = 0;
    for (std::size_t s = 0; s < steps.size(); ++s)
    {
      const auto decoded = ReadAll<float>(*file, { static_cast<int>(s), 0, 0, 0 });
      EXPECT_TRUE(WithinBound(steps[s], decoded, component.ErrorBoundAbsolute)) << "step " << s;
      for (std::size_t i = 0; i < decoded.size(); ++i)
      {
        const double error = double{ steps[s][i] } - double{ decoded[i] };
        sum += error * error;
      }
    }
    // The bound is wide: numbers that differ within it show here only.
    EXPECT_NEAR(component.SumSquaredError, sum, 1e-9 * sum);
  }
}

INSTANTIATE_TEST_SUITE_P(AllAxes, StaticBlocks, ::testing::Values(0, 1, 2));

} // namespace
} // namespace banyan::testing
