// SPDX-License-Identifier: BSD-3-Clause
#include "VerifyTesting.h"

#include "Series/Quantize/FillValues.h"
#include "VerifyReport.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace banyan
{
namespace
{

using namespace testing;

TEST(Verification, ProvesAGoodSeries)
{
  Encoded encoded;
  const Verification result = encoded.Run();
  EXPECT_TRUE(result.Proven());
  ASSERT_EQ(result.Components.size(), 1u);
  const ComponentVerification& component = result.Components[0];
  ASSERT_EQ(component.Steps.size(), std::size_t{ StepCount });
  EXPECT_EQ(component.All.Finite + component.All.NonFinite, 20 * 15 * 9 * StepCount);
  EXPECT_EQ(component.All.NonFinite, 9 * StepCount);
  EXPECT_GT(component.All.Greatest, 0.0);
  EXPECT_LE(component.All.Greatest, component.Bound);
  // What the index says was measured by the encoder, in its own way.
  const ComponentIndex index = SeriesFile::Open(encoded.Path)->Index().Arrays[0].Components[0];
  EXPECT_EQ(component.All.Greatest, index.MeasuredMaxError);
  EXPECT_EQ(component.All.Finite, index.FiniteCount);
  EXPECT_NEAR(component.All.SumSquared, index.SumSquaredError, 1e-9 * index.SumSquaredError);
  EXPECT_LT(component.All.SumWeighted, component.All.SumSquared);
  EXPECT_NE(
    VerificationToText(result, "x.banyan").find("PROVEN: in x.banyan all "), std::string::npos);
}

TEST(Verification, FindsABoundThatIsNotKept)
{
  Encoded encoded(1.0 / 16);
  encoded.ChangeIndex(
    [](SeriesIndex& index)
    {
      index.ErrorBound = 1.0 / 512;
      index.Arrays[0].Components[0].ErrorBoundAbsolute /= 32;
    });
  const Verification result = encoded.Run();
  EXPECT_FALSE(result.Proven());
  EXPECT_GT(result.Components[0].All.OutOfBound, 1000);
  EXPECT_NE(VerificationToText(result, "x").find("NOT AS PROMISED"), std::string::npos);
}

TEST(Verification, FindsABoundThatIsLooserThanAskedFor)
{
  Encoded encoded(1.0 / 16);
  encoded.ChangeIndex([](SeriesIndex& index) { index.ErrorBound = 1.0 / 512; });
  const Verification result = encoded.Run();
  EXPECT_FALSE(result.Proven());
  EXPECT_EQ(result.Components[0].All.OutOfBound, 0);
  EXPECT_NE(VerificationToText(result, "x").find("what was asked for comes to"), std::string::npos);
}

TEST(Verification, NamesTheChangedVoxel)
{
  Encoded encoded;
  // (i, j, k) = (7, 2, 5) from the first sample on.
  encoded.At(3, (5 * 15 + 2) * 20 + 7) += 10.0f;
  const Verification result = encoded.Run();
  EXPECT_FALSE(result.Proven());
  EXPECT_EQ(result.Components[0].All.OutOfBound, 1);
  ASSERT_TRUE(result.Components[0].Worst.has_value());
  const WorstValue& worst = *result.Components[0].Worst;
  EXPECT_EQ(worst.Step, 3);
  EXPECT_EQ(worst.Index, glm::ivec3(4, 7, 5)); // in the extent, which begins at -3, 5, 0
  EXPECT_EQ(std::stof(worst.Original), encoded.At(3, (5 * 15 + 2) * 20 + 7));
  EXPECT_NEAR(worst.Error, 10.0, 1.0);
  const std::string text = VerificationToText(result, "x");
  EXPECT_NE(text.find("1 value out of bound"), std::string::npos) << text;
  EXPECT_NE(
    text.find("step 3 (time 3), i j k = 4 7 5, original " + worst.Original), std::string::npos)
    << text;
}

TEST(Verification, FindsAChangedNaN)
{
  for (const float instead : { 1.0f, -std::nanf(""), std::nanf("77") })
  {
    Encoded encoded;
    float& nan = encoded.At(1, 4 * 20 + 3);
    ASSERT_TRUE(std::isnan(nan));
    nan = instead;
    const Verification result = encoded.Run();
    EXPECT_FALSE(result.Proven()) << instead;
    const ValueErrors& all = result.Components[0].All;
    EXPECT_EQ(all.NonFiniteChanged + all.OutOfBound, 1);
    EXPECT_EQ(result.Components[0].Worst->Index, glm::ivec3(0, 9, 0));
    EXPECT_EQ(result.Components[0].Worst->Decoded.rfind("NaN (bits 0x", 0), 0u);
  }
}

TEST(Verification, WeighsByTheGivenOpacity)
{
  Encoded encoded;
  const VerificationChoice nothing{ {}, OpacityFunction({ { 0.0, 0.0 } }) };
  EXPECT_EQ(encoded.Run(nothing).Components[0].All.SumWeighted, 0.0);
  Encoded again;
  const VerificationChoice all{ {}, OpacityFunction({ { 0.0, 1.0 } }) };
  const ValueErrors errors = again.Run(all).Components[0].All;
  EXPECT_EQ(errors.SumWeighted, errors.SumSquared);
}

/// An encoded series of Wavy values (-30 .. 70) with some fill values, quantized as it is said.
struct Quantized : Encoded
{
  explicit Quantized(const QuantizerOptions& quantizer)
  {
    EncodeOptions options;
    options.Quantizer = quantizer;
    ArrayDescription description = Describe(this->Original);
    description.Histograms.resize(1);
    for (std::size_t step = 0; step < this->Original.size(); ++step)
    {
      std::vector<float>& values = this->Original[step];
      values[100] = -999.0f;
      std::memcpy(&this->At(static_cast<int>(step), 100), &values[100], sizeof(float));
      CountComponent(ScalarType::Float32, values.data(), static_cast<std::int64_t>(values.size()),
        1, 0, quantizer.FillValues, description.Histograms[0]);
    }
    ThreadPool pool(2);
    SeriesEncoder encoder(this->Path, OddGrid(), { description }, options, pool);
    for (std::size_t step = 0; step < this->Original.size(); ++step)
    {
      encoder.AddStep(static_cast<double>(step), { { this->Original[step].data() } });
    }
    (void)encoder.Finish();
  }
};

QuantizerOptions FillsAreNamed()
{
  QuantizerOptions quantizer;
  quantizer.FillValues = { -999 };
  return quantizer;
}

TEST(Verification, ComparesFillValuesBitByBit)
{
  Quantized encoded(FillsAreNamed());
  const Verification result = encoded.Run();
  EXPECT_TRUE(result.Proven());
  EXPECT_EQ(result.Components[0].All.Fill, StepCount);
  EXPECT_LT(result.Components[0].Bound, 110.0 / 512);
  EXPECT_NE(VerificationToText(result, "x").find("5 values without meaning (fill values)"),
    std::string::npos);
  Quantized wrong(FillsAreNamed());
  wrong.At(1, 200) = -999.0f; // was none when it was encoded
  EXPECT_EQ(wrong.Run().Components[0].All.OutOfBound, 1);
}

TEST(Verification, JudgesClampedValuesByTheEndOfTheRange)
{
  QuantizerOptions quantizer = FillsAreNamed();
  quantizer.Range = { RangeRule::Source::Percentiles, 0.1, 0.9, {}, true };
  Quantized encoded(quantizer);
  const Verification result = encoded.Run();
  EXPECT_TRUE(result.Proven());
  const ComponentIndex index = SeriesFile::Open(encoded.Path)->Index().Arrays[0].Components[0];
  EXPECT_GT(result.Components[0].Clamped, 1000);
  EXPECT_EQ(result.Components[0].Clamped, index.ClampedCount);
  EXPECT_NE(VerificationToText(result, "x").find("judged by the end"), std::string::npos);
}

TEST(Verification, AcceptsInvisibleValuesThatStayInvisible)
{
  QuantizerOptions quantizer = FillsAreNamed();
  quantizer.Opacity = { { 100, 0 }, { 200, 1 } }; // all of Wavy is invisible
  Quantized encoded(quantizer);
  const Verification result = encoded.Run();
  EXPECT_TRUE(result.Proven());
  const ComponentIndex index = SeriesFile::Open(encoded.Path)->Index().Arrays[0].Components[0];
  EXPECT_GE(result.Components[0].All.Invisible, 0);
  EXPECT_EQ(result.Components[0].All.Invisible, index.InvisibleCount);
  // One that can be seen in the source and is not there is found.
  Quantized wrong(quantizer);
  wrong.At(2, 7) = 150.0f;
  EXPECT_EQ(wrong.Run().Components[0].All.OutOfBound, 1);
  // Without the function in the index nothing is accepted that is out of bound.
  Quantized again(quantizer);
  again.ChangeIndex(
    [](SeriesIndex& changed) {
      changed.Arrays[0].Components[0].Opacity = { { 0, 1 } };
    });
  EXPECT_EQ(again.Run().Components[0].All.OutOfBound, index.InvisibleCount);
}

TEST(Verification, RefusesOtherNumbersOfSteps)
{
  Encoded fewer;
  fewer.Source.Steps.pop_back();
  fewer.ExpectRefusal("The source ends after 4 time steps, and the series has 5.");
  Encoded more;
  more.Source.Steps.push_back(more.Source.Steps.back());
  more.ExpectRefusal("The source has more time steps than the 5 of the series.");
}

TEST(Verification, RefusesOtherTimesAndGrids)
{
  const auto refuse = [](const std::string& phrase, void (*change)(SourceStep&))
  {
    Encoded encoded;
    change(encoded.Source.Steps[2].Description);
    encoded.ExpectRefusal(phrase);
  };
  refuse("At step 2 the time of the source is 7 and that of the series 2.",
    [](SourceStep& step) { step.Time = 7.0; });
  refuse("At step 2 the extent of the source is -2..17 5..19 0..8 and that of the series -3..16",
    [](SourceStep& step)
    {
      ++step.Domain->Extent.Lo.x;
      ++step.Domain->Extent.Hi.x;
    });
  refuse("At step 2 the number of samples",
    [](SourceStep& step)
    {
      step.Domain.reset();
      step.Samples.z = 1;
    });
  refuse("At step 2 the origin of the source is (1.5, -2, 1)",
    [](SourceStep& step) { step.Domain->Origin.z = 1; });
  refuse("spacing", [](SourceStep& step) { step.Domain->Spacing.x = 1; });
  refuse("direction", [](SourceStep& step) { step.Domain->Direction[0][1] = 1e-9; });
}

TEST(Verification, RefusesOtherArrays)
{
  const auto refuse = [](const std::string& phrase, void (*change)(std::vector<SourceArray>&))
  {
    Encoded encoded;
    change(encoded.Source.Steps[1].Description.Arrays);
    encoded.ExpectRefusal(phrase);
  };
  refuse("At step 1 the source has no array \"values\"",
    [](std::vector<SourceArray>& arrays) { arrays[0].Name = "Values"; });
  refuse("the source has the array \"more\", which the series does not hold",
    [](std::vector<SourceArray>& arrays) {
      arrays.push_back({ "more", ScalarType::Int8, 1 });
    });
  refuse("several arrays \"values\"",
    [](std::vector<SourceArray>& arrays) { arrays.push_back(arrays[0]); });
  refuse("the array \"values\" is float64 in the source and float32 in the series",
    [](std::vector<SourceArray>& arrays) { arrays[0].Type = ScalarType::Float64; });
  refuse("the array \"values\" has 3 components in the source and 1",
    [](std::vector<SourceArray>& arrays) { arrays[0].Components = 3; });
  Encoded encoded;
  encoded.ExpectRefusal("The series has no array \"other\"", { { "other" }, {} });
}

TEST(Verification, LooksAtTheNamedArraysOnly)
{
  Encoded encoded;
  for (MemorySource::Step& step : encoded.Source.Steps)
  {
    step.Description.Arrays.insert(
      step.Description.Arrays.begin(), { "more", ScalarType::Int8, 1 });
    step.Values.insert(step.Values.begin(), std::vector<std::uint8_t>());
  }
  EXPECT_TRUE(encoded.Run({ { "values" }, {} }).Proven());
}

TEST(Verification, VectorsAreComparedByComponent)
{
  const TemporaryFolder folder;
  const std::string path = folder / "wind.banyan";
  const Grid grid = GridOf(18, 10, 3);
  std::vector<double> values;
  for (int i = 0; i < 540; ++i)
  {
    values.insert(values.end(), { std::sin(0.1 * i), 1000.0 * std::cos(0.05 * i) });
  }
  ThreadPool pool(1);
  SeriesEncoder encoder(path, grid,
    { { "wind", ScalarType::Float64, { "u", "" }, { { -1, 1 }, { -1000, 1000 } } } }, {}, pool);
  encoder.AddStep(0.5, { { values.data() } });
  encoder.Finish();
  MemorySource source;
  source.Steps.push_back({ { 0.5, grid, grid.Samples(), { { "wind", ScalarType::Float64, 2 } } },
    { BytesFrom(values) } });
  reinterpret_cast<double*>(source.Steps[0].Values[0].data())[2 * 100 + 1] += 50.0;
  const Verification result = Verify(*SeriesFile::Open(path), source, {});
  ASSERT_EQ(result.Components.size(), 2u);
  EXPECT_EQ(result.Components[0].Name, "wind[u]");
  EXPECT_TRUE(result.Components[0].Proven());
  EXPECT_EQ(result.Components[1].Name, "wind[1]");
  EXPECT_FALSE(result.Components[1].Proven());
  EXPECT_EQ(result.Components[1].Worst->Index, glm::ivec3(100 % 18, 100 / 18, 0));
}

TEST(Verification, JsonSaysTheSame)
{
  Encoded encoded;
  encoded.At(2, 0) = static_cast<float>(std::numeric_limits<double>::infinity());
  const Verification result = encoded.Run();
  const auto json = nlohmann::json::parse(VerificationToJson(result, "x.banyan"));
  const auto& component = json["components"][0];
  EXPECT_EQ(json["proven"], false);
  EXPECT_EQ(component["all"]["maxError"], result.Components[0].All.Greatest);
  EXPECT_EQ(component["all"]["nonFiniteChanged"], 1);
  EXPECT_EQ(component["steps"].size(), std::size_t{ StepCount });
  EXPECT_EQ(component["steps"][2]["nonFiniteChanged"], 1);
  EXPECT_EQ(component["worst"]["original"], "inf");
  EXPECT_TRUE(component["worst"]["error"].is_null());
  const ValueErrors& step = result.Components[0].Steps[1];
  EXPECT_EQ(component["steps"][1]["rmse"], std::sqrt(step.SumSquared / step.Finite));
  EXPECT_DOUBLE_EQ(component["steps"][1]["psnrOfOwnRange"],
    20 * std::log10(step.Range.Width() / std::sqrt(step.SumSquared / step.Finite)));
}

} // namespace
} // namespace banyan
