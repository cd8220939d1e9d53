// SPDX-License-Identifier: BSD-3-Clause
// The benchmark of the codec: what it measures is true, and it fails when it has to.
#include "CodecOptions.h"
#include "Deviation.h"
#include "Report.h"

#include "Base/Error.h"
#include "Series/SeriesTesting.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <random>
#include <set>
#include <sstream>

namespace banyan::bench
{
namespace
{

using testing::TemporaryFolder;

/// Waves that move, somewhat rough; `samples` is chosen so that bricks and blocks do not fit.
std::vector<float> Waves(const glm::ivec3& samples, int steps)
{
  std::mt19937 random(7);
  std::vector<float> values;
  for (int s = 0; s < steps; ++s)
    for (int z = 0; z < samples.z; ++z)
      for (int y = 0; y < samples.y; ++y)
        for (int x = 0; x < samples.x; ++x)
        {
          const double noise = 1e-10 * static_cast<double>(random());
          values.push_back(static_cast<float>(
            3.0 + std::sin(0.4 * x + 0.3 * s) * std::cos(0.3 * y - 0.2 * z) + 0.1 * noise));
        }
  return values;
}

CodecSettings SettingsFor(const RawSeries& series, int bits, const std::string& folder)
{
  return { bits, ErrorBoundFor(series, bits), folder };
}

/// Writes a series and its description; returns the path of the latter.
std::string Write(const TemporaryFolder& folder, const std::string& name,
  const std::vector<float>& values, const glm::ivec3& samples, int steps)
{
  std::ofstream raw(folder / (name + ".raw"), std::ios::binary);
  raw.write(reinterpret_cast<const char*>(values.data()),
    static_cast<std::streamsize>(values.size() * sizeof(float)));
  std::ofstream description(folder / (name + ".json"));
  description << nlohmann::json{ { "name", name }, { "file", name + ".raw" },
    { "samples", { samples.x, samples.y, samples.z } }, { "steps", steps } };
  return folder / (name + ".json");
}

/// All methods that were built.
class EachMethod : public ::testing::TestWithParam<std::size_t>
{
protected:
  EachMethod() { this->Methods = AllMethods(this->Missing); }
  CodecMethod& Method() { return *this->Methods[this->GetParam()]; }

  std::vector<std::string> Missing;
  MethodList Methods;
};

TEST_P(EachMethod, KeepsTheBoundAndDecodesBricksAsItDecodesSteps)
{
  const glm::ivec3 samples(19, 33, 18);
  const RawSeries series("waves", samples, Waves(samples, 3));
  for (const int bits : { 8, 10 })
  {
    const TemporaryFolder folder;
    const CodecSettings settings = SettingsFor(series, bits, folder.Path());
    this->Method().Prepare(series, settings);
    const auto encoded = this->Method().Encode(series, settings);
    EXPECT_GT(encoded->Bytes(), 100u);
    for (int step = 0; step < series.Steps(); ++step)
    {
      std::vector<float> values(series.VoxelsPerStep());
      encoded->DecodeStep(step, values.data());
      Deviation deviation;
      deviation.Include(series.Step(step), values.data(), values.size());
      // Uniform codes in float32 may cross the bound by their last digit; ours may not.
      const double slack = this->Method().Ours() ? 1.0 : 1.001;
      EXPECT_LE(deviation.Largest(), settings.ErrorBound * slack) << "step " << step;
      if (!encoded->DecodesBricks())
      {
        continue;
      }
      const Box box{ { 16, 16, 0 }, { 19, 32, 16 } };
      std::vector<float> brick(static_cast<std::size_t>(box.Count()));
      encoded->DecodeBrick(step, box, brick.data());
      for (int i = 0; i < box.Count(); ++i)
      {
        const int x = 16 + i % 3, y = 16 + i / 3 % 16, z = i / 48;
        ASSERT_EQ(brick[static_cast<std::size_t>(i)],
          values[static_cast<std::size_t>((z * samples.y + y) * samples.x + x)])
          << x << ' ' << y << ' ' << z;
      }
    }
  }
}

/// Steps in which nothing happens have broken peers.
TEST_P(EachMethod, DecodesAConstantStep)
{
  const glm::ivec3 samples(16, 16, 16);
  std::vector<float> values(2 * 4096, 1.0f);
  values[5000] = 2.0f;
  const RawSeries series("constant", samples, values);
  const TemporaryFolder folder;
  const CodecSettings settings = SettingsFor(series, 8, folder.Path());
  this->Method().Prepare(series, settings);
  const auto encoded = this->Method().Encode(series, settings);
  std::vector<float> decoded(4096);
  encoded->DecodeStep(0, decoded.data());
  Deviation deviation;
  deviation.Include(series.Step(0), decoded.data(), decoded.size());
  EXPECT_LE(deviation.Largest(), settings.ErrorBound * 1.001);
}

std::size_t MethodCount()
{
  std::vector<std::string> missing;
  return AllMethods(missing).size();
}

std::string MethodName(const ::testing::TestParamInfo<std::size_t>& info)
{
  std::vector<std::string> missing;
  std::string name = AllMethods(missing)[info.param]->Name();
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
}

INSTANTIATE_TEST_SUITE_P(
  Codec, EachMethod, ::testing::Range<std::size_t>(0, MethodCount()), MethodName);

TEST(Methods, BeginWithOursAndHaveDifferentNames)
{
  std::vector<std::string> missing;
  const MethodList methods = AllMethods(missing);
  EXPECT_EQ(methods.at(0)->Name(), "banyan");
  std::set<std::string> names;
  for (const auto& method : methods)
  {
    names.insert(method->Name());
  }
  EXPECT_EQ(names.size(), methods.size());
  EXPECT_TRUE(names.count("paper") == 1);
}

TEST(Deviation, IsTheLargestAndTheMeanOfSquares)
{
  const float original[] = { 0, 1, 2, 3 };
  const float decoded[] = { 0, 1.5f, 2, 1 };
  Deviation deviation;
  deviation.Include(original, decoded, 2);
  deviation.Include(original + 2, decoded + 2, 2);
  EXPECT_DOUBLE_EQ(deviation.Largest(), 2.0);
  EXPECT_DOUBLE_EQ(deviation.RootMeanSquare(), std::sqrt((0.25 + 4.0) / 4));
  EXPECT_DOUBLE_EQ(
    deviation.SignalToNoiseDecibels(3.0), 20 * std::log10(3.0 / deviation.RootMeanSquare()));
}

TEST(Deviation, WantsNonFiniteValuesBack)
{
  constexpr float nan = std::numeric_limits<float>::quiet_NaN();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const auto largest = [](float original, float decoded)
  {
    Deviation deviation;
    deviation.Include(&original, &decoded, 1);
    return deviation.Largest();
  };
  EXPECT_EQ(largest(nan, nan), 0.0);
  EXPECT_EQ(largest(infinity, infinity), 0.0);
  EXPECT_TRUE(std::isinf(largest(infinity, -infinity)));
  EXPECT_TRUE(std::isinf(largest(nan, 0.0f)));
  EXPECT_TRUE(std::isinf(largest(0.0f, nan)));
}

TEST(RawSeries, CutsTheRangeOfItsBoundsAtAPercentile)
{
  std::vector<float> values(1000);
  for (int i = 0; i < 1000; ++i)
  {
    values[static_cast<std::size_t>(i)] = static_cast<float>(i * 7 % 1000); // each of 0...999 once
  }
  values[3] = std::numeric_limits<float>::quiet_NaN();
  const RawSeries series("ramp", { 10, 10, 10 }, values, 90.0);
  EXPECT_EQ(series.FullRange().High, 999.0);
  EXPECT_NEAR(series.BoundRange().High, 900.0, 2.0);
  EXPECT_EQ(series.BoundRange().Low, 0.0);
  EXPECT_DOUBLE_EQ(ErrorBoundFor(series, 8), series.BoundRange().High / 512);
}

TEST(RawSeries, RefusesDescriptionsThatDoNotFit)
{
  const TemporaryFolder folder;
  const std::vector<float> values(64, 1.0f);
  EXPECT_EQ(RawSeries::Open(Write(folder, "good", values, { 4, 4, 2 }, 2)).Steps(), 2);
  EXPECT_THROW(RawSeries::Open(Write(folder, "short", values, { 4, 4, 4 }, 2)), Error);
  EXPECT_THROW(RawSeries::Open(Write(folder, "none", values, { 4, 4, 0 }, 2)), Error);
  EXPECT_THROW(RawSeries::Open(folder / "missing.json"), Error);
}

TEST(Options, AreCheckedBeforeAnythingRuns)
{
  const auto refused = [](const std::vector<std::string>& arguments)
  {
    try
    {
      ParseCodecOptions(arguments);
      return false;
    }
    catch (const Error&)
    {
      return true;
    }
  };
  EXPECT_FALSE(refused({ "--output", "a.csv", "b.json" }));
  EXPECT_EQ(
    ParseCodecOptions({ "--output", "a", "b", "--bits", "6,8" }).Bits, (std::vector<int>{ 6, 8 }));
  EXPECT_TRUE(ParseCodecOptions({ "--output", "a", "b", "--stages" }).Measuring.Stages);
  EXPECT_TRUE(refused({ "--output", "a.csv" }));
  EXPECT_TRUE(refused({ "--output", "a.csv", "b.json", "--bits", "0" }));
  EXPECT_TRUE(refused({ "--output", "a.csv", "b.json", "--repeat", "3x" }));
  EXPECT_TRUE(refused({ "--output", "a.csv", "b.json", "--fast" }));
  EXPECT_TRUE(refused({ "b.json", "--output" }));
}

std::vector<std::string> Split(const std::string& line)
{
  std::vector<std::string> cells;
  std::istringstream stream(line + ",");
  for (std::string cell; std::getline(stream, cell, ',');)
  {
    cells.push_back(cell);
  }
  return cells;
}

TEST(Program, WritesALinePerMethodAndAccuracy)
{
  const TemporaryFolder folder;
  const glm::ivec3 samples(17, 16, 15);
  const std::string series = Write(folder, "waves", Waves(samples, 3), samples, 3);
  const std::string csv = folder / "codec.csv";
  const std::string command = std::string("\"") + BANYAN_BENCH_CODEC + "\" --output \"" + csv +
                              "\" --methods banyan,banyan-every-step,paper --bits 6,8 --repeat 1 " +
                              "--bricks 10 \"" + series + "\" 2>/dev/null";
  ASSERT_EQ(std::system(command.c_str()), 0);
  std::ifstream stream(csv);
  std::string line;
  ASSERT_TRUE(std::getline(stream, line));
  const std::vector<std::string> header = Split(line);
  const std::vector<std::string> wanted = { "dataset", "method", "bits_of_accuracy",
    "max_error_over_bound", "psnr_db", "bits_per_voxel", "encode_mb_s", "decode_mb_s",
    "random_brick_us" };
  ASSERT_GE(header.size(), wanted.size());
  EXPECT_TRUE(std::equal(wanted.begin(), wanted.end(), header.begin()));
  int lines = 0;
  for (; std::getline(stream, line); ++lines)
  {
    const std::vector<std::string> cells = Split(line);
    ASSERT_EQ(cells.size(), header.size()) << line;
    EXPECT_LE(std::stod(cells[3]), 1.001) << line;
    EXPECT_GT(std::stod(cells[4]), 30.0) << line;
    EXPECT_GT(std::stod(cells[5]), 0.0) << line;
    EXPECT_EQ(cells[8].empty(), cells[1] == "paper") << line;
    EXPECT_EQ(cells[12].empty(), cells[1] == "paper") << line;
    EXPECT_EQ(cells[13].empty(), cells[1] == "paper") << line;
  }
  EXPECT_EQ(lines, 6);
}

/// Halves values: a method of ours with an error that has to be found.
class Wrong : public CodecMethod
{
public:
  using CodecMethod::CodecMethod;

  std::unique_ptr<EncodedSeries> Encode(
    const RawSeries& series, const CodecSettings&) const override
  {
    class Half : public EncodedSeries
    {
    public:
      explicit Half(const RawSeries& series)
        : Series(series)
      {
      }
      std::uint64_t Bytes() const override { return 10; }
      void DecodeStep(int step, float* values) override
      {
        std::transform(this->Series.Step(step),
          this->Series.Step(step) + this->Series.VoxelsPerStep(), values,
          [](float value) { return 0.5f * value; });
      }
      const RawSeries& Series;
    };
    return std::make_unique<Half>(series);
  }
};

TEST(Measuring, SeesABrokenBound)
{
  const TemporaryFolder folder;
  const RawSeries series("step", { 4, 4, 4 }, std::vector<float>(128, 4.0f));
  std::vector<float> values(128, 0.0f);
  values[100] = 4.0f;
  const RawSeries peak("peak", { 4, 4, 4 }, values);
  Wrong method("banyan-wrong");
  MeasureOptions options;
  options.WorkFolder = folder.Path();
  const Measurement measurement = Measure(method, peak, 8, options);
  EXPECT_DOUBLE_EQ(measurement.LargestError, 2.0);
  EXPECT_DOUBLE_EQ(measurement.ErrorOverBound(), 256.0);
  EXPECT_DOUBLE_EQ(measurement.BitsPerVoxel, 80.0 / 128);
  EXPECT_FALSE(measurement.RandomBrickMicroseconds.has_value());
  // A bound of 0 is broken by any error.
  EXPECT_TRUE(std::isinf(Measure(method, series, 8, options).ErrorOverBound()));
}

/// Ours have to keep their bounds; a peer that does not is a line of the report.
TEST(Reporting, FailsWhenOursBreaksItsBound)
{
  const TemporaryFolder folder;
  std::vector<float> values(128, 0.0f);
  values[100] = 4.0f;
  const RawSeries series("peak", { 4, 4, 4 }, values);
  MeasureOptions options;
  options.WorkFolder = folder.Path();
  for (const std::string name : { "banyan-wrong", "wrong" })
  {
    MethodList methods;
    methods.push_back(std::make_unique<Wrong>(name));
    std::ostringstream csv, messages;
    EXPECT_EQ(Report(series, methods, { 8 }, options, csv, messages), name == "wrong");
    EXPECT_EQ(csv.str().find("peak," + name + ",8,256,"), 0u) << csv.str();
  }
}

} // namespace
} // namespace banyan::bench
