// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Series/Format/FieldLattice.h"

#include <functional>
#include <limits>

namespace banyan::testing
{
namespace
{

// Inputs at which other compressors lose values, leave the bound, give up, or crash. Every row: all
// finite voxels within the bound, everything else bit-exact, after writing and reading files.

const Grid Cube = GridOf(32, 32, 32);
constexpr float Fill = 1e20f;

double Smooth(int x, int y, int z, int step)
{
  return std::sin(0.2 * x + 0.3 * step) * std::cos(0.15 * y) + 0.5 * std::sin(0.1 * z + 0.2 * step);
}

template <class T = float>
Steps<T> SmoothSteps(int count, double scale = 1, double offset = 0)
{
  return Sample<T>(Cube, count,
    [scale, offset](int x, int y, int z, int step)
    { return offset + scale * Smooth(x, y, z, step); });
}

template <class T>
void Replace(Steps<T>& steps, double share, const std::function<T(std::mt19937&)>& by)
{
  std::mt19937 random(17);
  for (auto& step : steps)
  {
    for (T& value : step)
    {
      if (random() % 100000 < share * 1000)
      {
        value = by(random);
      }
    }
  }
}

struct Encoded
{
  SeriesIndex Index;
  double Bits = 0; ///< per voxel, index and tables counted
  std::int64_t Exceptions() const { return this->Index.Statistics.ExceptionVoxels; }
};

/// Encodes with a bound relative to `range`, and checks every voxel.
template <class T>
Encoded Check(const Steps<T>& steps, const ValueRange& range, EncodeOptions options = {})
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  ThreadPool pool(2);
  ArrayDescription description = Describe(steps);
  description.SeriesRanges = { range };
  SeriesEncoder encoder(path, Cube, { description }, options, pool);
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    encoder.AddStep(static_cast<double>(s), { { steps[s].data() } });
  }
  Encoded result;
  result.Index = encoder.Finish();
  const auto file = SeriesFile::Open(path);
  const double bound = result.Index.Arrays[0].Components[0].ErrorBoundAbsolute;
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    const auto decoded = ReadAll<T>(*file, { static_cast<int>(s), 0, 0, 0 });
    EXPECT_TRUE(WithinBound(steps[s], decoded, bound)) << "step " << s;
  }
  std::uint64_t bytes = std::filesystem::file_size(path);
  for (const SegmentIndex& segment : result.Index.Segments)
  {
    bytes += segment.Bytes;
  }
  result.Bits = 8.0 * static_cast<double>(bytes) /
                (static_cast<double>(steps.size()) * static_cast<double>(steps[0].size()));
  return result;
}

const ValueRange Unit{ -1.5, 1.5 };

TEST(FailureTable, OneNaNAndOneInfinity)
{
  auto steps = SmoothSteps(3);
  steps[1][12345] = std::numeric_limits<float>::quiet_NaN();
  steps[1][777] = -std::numeric_limits<float>::infinity();
  const double without = Check(SmoothSteps(3), Unit).Bits;
  const Encoded encoded = Check(steps, Unit);
  EXPECT_EQ(encoded.Index.Arrays[0].Components[0].NonFiniteCount, 2);
  EXPECT_EQ(encoded.Exceptions(), 2);
  EXPECT_LT(encoded.Bits, without + 0.1);
}

TEST(FailureTable, OnePercentNaNAndInfinity)
{
  auto steps = SmoothSteps(3);
  // Payload bits of NaN are data, too.
  Replace<float>(steps, 1.0,
    [](std::mt19937& random)
    {
      const std::uint32_t bits = 0x7f800000u | (static_cast<std::uint32_t>(random()) & 0x807fffffu);
      return BitCast<float>(random() % 3 == 0 ? 0xff800000u : bits);
    });
  const Encoded encoded = Check(steps, Unit);
  const ComponentIndex& component = encoded.Index.Arrays[0].Components[0];
  EXPECT_NEAR(static_cast<double>(component.NonFiniteCount), 0.01 * 3 * 32768, 150);
  EXPECT_EQ(encoded.Exceptions(), component.NonFiniteCount);
}

/// The fill value costs its positions, and does not set the range.
TEST(FailureTable, FillValueInTenPercent)
{
  auto steps = SmoothSteps(3);
  Replace<float>(steps, 10.0, [](std::mt19937&) { return Fill; });
  const Encoded encoded = Check(steps, Unit);
  EXPECT_NEAR(static_cast<double>(encoded.Exceptions()), 0.1 * 3 * 32768, 500);
  // Entropy of a mask of 10 % is 0.47 bits per voxel; levels hold it again.
  EXPECT_LT(encoded.Bits, Check(SmoothSteps(3), Unit).Bits + 2.0);
}

/// When the range is that of the values, fill values are ordinary ones, and the bound is wide.
TEST(FailureTable, FillValueThatSetsTheRange)
{
  auto steps = SmoothSteps(2);
  Replace<float>(steps, 10.0, [](std::mt19937&) { return Fill; });
  EXPECT_EQ(Check(steps, ValueRange{ -1.5, Fill }).Exceptions(), 0);
}

TEST(FailureTable, OneOutlier)
{
  auto steps = SmoothSteps(3);
  steps[2][20000] = 1e6f;
  const Encoded encoded = Check(steps, Unit);
  EXPECT_EQ(encoded.Exceptions(), 1);
  EXPECT_LT(encoded.Bits, Check(SmoothSteps(3), Unit).Bits + 0.1);
}

TEST(FailureTable, ConstantFields)
{
  for (const float value : { 0.0f, -0.0f, 3.25f, 1e-40f, 3e38f })
  {
    const Steps<float> steps(3, std::vector<float>(32768, value));
    const Encoded encoded = Check(steps, ValueRange{ value, value });
    EXPECT_EQ(encoded.Index.Statistics.MacroVoxelBricks, encoded.Index.Statistics.Bricks) << value;
    EXPECT_LT(encoded.Bits, 0.5) << value;
    // The value is the lattice, but for the zero that the lattice does not have.
    EXPECT_EQ(encoded.Exceptions(), std::signbit(value) ? 3 * 32768 : 0) << value;
  }
}

TEST(FailureTable, LosslessIsLossless)
{
  EncodeOptions options;
  options.ErrorBound = 0;
  auto steps = SmoothSteps(3);
  Replace<float>(steps, 1.0,
    [](std::mt19937& random) { return BitCast<float>(static_cast<std::uint32_t>(random())); });
  steps[0][5] = -0.0f;
  for (const ErrorBoundMode mode :
    { ErrorBoundMode::RelativeToSeriesRange, ErrorBoundMode::Absolute })
  {
    options.Mode = mode;
    const TemporaryFolder folder;
    Encode(folder / "s.banyan", Cube, steps, options);
    const auto file = SeriesFile::Open(folder / "s.banyan");
    for (int s = 0; s < 3; ++s)
    {
      const auto decoded = ReadAll<float>(*file, { s, 0, 0, 0 });
      EXPECT_EQ(std::memcmp(decoded.data(), steps[static_cast<std::size_t>(s)].data(),
                  decoded.size() * sizeof(float)),
        0);
    }
  }
}

/// The bound holds for what the type can say, not only for what double precision can.
TEST(FailureTable, BoundBelowOneUnitInTheLastPlace)
{
  const auto steps = SmoothSteps(2, 0.03, 1e6); // an ulp is 0.0625
  const Encoded encoded = Check(steps, ValueRange{ 1e6 - 0.05, 1e6 + 0.05 });
  EXPECT_LT(encoded.Index.Arrays[0].Components[0].ErrorBoundAbsolute, 0.0625);
  EXPECT_EQ(encoded.Exceptions(), 2 * 32768); // rounding leaves nothing for a lattice
}

TEST(FailureTable, Denormals)
{
  const auto steps = SmoothSteps(3, 1e-40);
  const Encoded encoded = Check(steps, ValueRange{ -1.5e-40, 1.5e-40 });
  EXPECT_GT(encoded.Index.Arrays[0].Components[0].ErrorBoundAbsolute, 0);
  // Doubles hold a lattice that floats of this size cannot.
  EXPECT_EQ(
    Check(SmoothSteps<double>(2, 1e-300), ValueRange{ -1.5e-300, 1.5e-300 }).Exceptions(), 0);
  Check(SmoothSteps<double>(2, 1e-310), ValueRange{ -1.5e-310, 1.5e-310 });
}

/// Lattices have up to 2^24 places for the range; with a closer bound all is kept exactly.
TEST(FailureTable, RangeOverBoundOfTwoToThe31)
{
  for (const double power : { 16, 20, 22, 23, 24, 26, 27, 29, 31, 40 })
  {
    EncodeOptions options;
    options.ErrorBound = std::pow(2.0, -power);
    auto steps = SmoothSteps<double>(2);
    SCOPED_TRACE(power);
    const Encoded encoded = Check(steps, Unit, options);
    if (power <= 23)
    {
      EXPECT_EQ(encoded.Exceptions(), 0);
      EXPECT_LT(encoded.Bits, 0.5 * power);
    }
    else
    {
      // What is exactly 0 lies on any lattice.
      EXPECT_GT(static_cast<double>(encoded.Exceptions()), 0.99 * 2 * 32768);
      EXPECT_EQ(encoded.Index.Arrays[0].Components[0].MeasuredMaxError, 0.0);
      EXPECT_LT(encoded.Bits, 45.0);
    }
  }
}

TEST(FailureTable, WhiteNoise)
{
  std::mt19937 random(5);
  std::uniform_real_distribution<float> unit(0, 1);
  auto steps = Sample<float>(Cube, 8, [&](int, int, int, int) { return unit(random); });
  const Encoded encoded = Check(steps, ValueRange{ 0, 1 });
  EXPECT_LE(encoded.Bits, 9.0); // 8 bits carry the bound; nothing can be less
  EXPECT_GE(encoded.Bits, 8.0);
  RecordProperty("MilliBits", static_cast<int>(1000 * encoded.Bits));
}

/// Values over many decades: late steps would vanish below one bound for all of them. asinh keeps
/// the bound relative where values are large, and absolute at zero.
TEST(FailureTable, DecadesOfRange)
{
  const auto steps = Sample<float>(Cube, 5,
    [](int x, int y, int z, int step)
    { return Smooth(x, y, z, step) * std::pow(10.0, -2 * step); });
  Check(steps, Unit);
  constexpr double scale = 1e-10;
  EncodeOptions options;
  options.Quantizer.Map = TransformChoice::Asinh;
  options.Quantizer.AsinhScale = scale;
  const TemporaryFolder folder;
  const SeriesIndex index = Encode(folder / "s.banyan", Cube, steps, options);
  const double bound = index.Arrays[0].Components[0].ErrorBoundAbsolute;
  EXPECT_LT(bound, 0.1); // of a value far above the scale this is the relative error
  const auto file = SeriesFile::Open(folder / "s.banyan");
  for (int s = 0; s < 5; ++s)
  {
    const auto decoded = ReadAll<float>(*file, { s, 0, 0, 0 });
    double greatest = 0, relative = 0;
    for (std::size_t i = 0; i < decoded.size(); ++i)
    {
      const double original = steps[static_cast<std::size_t>(s)][i];
      greatest =
        std::max(greatest, std::abs(std::asinh(decoded[i] / scale) - std::asinh(original / scale)));
      relative = std::abs(original) > 10 * scale
                   ? std::max(relative, std::abs(decoded[i] - original) / std::abs(original))
                   : relative;
    }
    EXPECT_LE(greatest, bound * (1 + 1e-9)) << "step " << s;
    EXPECT_GT(greatest, 0.5 * bound) << "step " << s;
    EXPECT_LT(relative, 0.11) << "step " << s << ", whose values are 10^" << -2 * s;
  }
  Check(Sample<float>(Cube, 3,
          [](int x, int y, int z, int step)
          { return std::pow(10.0, 38 * Smooth(x, y, z, step) / 1.51); }),
    ValueRange{ 0, 3e38 });
}

TEST(FailureTable, WavesThatMoveFastAreNotLargerThanStepsByThemselves)
{
  // A packet that moves three of its lengths per step.
  const auto steps = Sample<float>(Cube, 8,
    [](int x, int y, int z, int step)
    {
      const double phase = 0.9 * (x + 0.3 * y - 0.2 * z) - 17.3 * step;
      return std::sin(phase) * (1 + 0.3 * std::sin(0.11 * y + 5.7 * step));
    });
  EncodeOptions options;
  options.BrickCells = 16;
  const Encoded grouped = Check(steps, Unit, options);
  options.KeyframeInterval = 1;
  const Encoded single = Check(steps, Unit, options);
  EXPECT_LE(static_cast<double>(grouped.Index.Statistics.PayloadBytes),
    1.02 * static_cast<double>(single.Index.Statistics.PayloadBytes));
  EXPECT_LE(grouped.Bits, 1.02 * single.Bits);
}

} // namespace
} // namespace banyan::testing
