// SPDX-License-Identifier: BSD-3-Clause
// The estimated error between steps, of series whose error there is known.
#include "InfoJson.h"
#include "InfoText.h"
#include "InterpolationError.h"
#include "ProgramsTesting.h"
#include "SeriesReport.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <numeric>

namespace banyan
{
namespace
{

using namespace testing;

/// Values that grow with the square of the time, x times as fast at x: between times a and b they
/// are off by x (b - a)^2 / 4 at most.
double Square(int x, double time)
{
  return x * time * time;
}

class InterpolationErrorTest : public ::testing::Test
{
protected:
  template <class T>
  std::shared_ptr<SeriesFile> Series(const std::vector<double>& times, const Grid& grid,
    const std::vector<double>& fillValues = {}, T inOneCorner = T(0))
  {
    Steps<T> steps;
    for (const double time : times)
    {
      steps.push_back(
        Sample<T>(grid, 1, [&](int x, int, int, int) { return Square(x, time); }).front());
    }
    if (inOneCorner != T(0))
    {
      steps.back().back() = inOneCorner;
    }
    const std::string path = this->Folder / ("series" + std::to_string(++this->Made) + ".banyan");
    EncodeOptions options;
    options.Mode = ErrorBoundMode::Absolute;
    options.ErrorBound = 0.0;
    options.Quantizer.FillValues = fillValues;
    ThreadPool pool(1);
    SeriesEncoder encoder(path, grid, { Describe(steps) }, options, pool);
    for (std::size_t i = 0; i < times.size(); ++i)
    {
      encoder.AddStep(times[i], { { steps[i].data() } });
    }
    encoder.Finish();
    return SeriesFile::Open(path);
  }

  TemporaryFolder Folder;
  int Made = 0;
};

TEST_F(InterpolationErrorTest, IsThatOfValuesWithAKnownOne)
{
  const Grid grid = GridOf(17, 6, 5);
  const auto even = this->Series<float>({ 0, 1, 2, 3, 4 }, grid);
  const InterpolationError error = EstimateInterpolation(*even, 0, 0);
  EXPECT_EQ(error.Steps, 3);
  EXPECT_EQ(error.EveryNth, 1);
  EXPECT_FLOAT_EQ(error.LargestLeftOut, 16.0);
  EXPECT_FLOAT_EQ(error.Largest, 4.0) << "16 (1 s)^2 / 4";
  double squares = 0.0;
  for (int x = 0; x < 17; ++x)
  {
    squares += x * x / 16.0;
  }
  EXPECT_FLOAT_EQ(error.Rms, std::sqrt(squares / 17));

  const auto uneven = this->Series<double>({ 0, 1, 3 }, grid);
  const InterpolationError longer = EstimateInterpolation(*uneven, 0, 0);
  EXPECT_EQ(longer.Steps, 1);
  EXPECT_DOUBLE_EQ(longer.LargestLeftOut, 32.0);
  EXPECT_DOUBLE_EQ(longer.Largest, 16.0) << "16 (2 s)^2 / 4";
}

TEST_F(InterpolationErrorTest, LeavesOutWhatIsNoValue)
{
  const Grid grid = GridOf(9, 5, 4);
  for (const float none : { -1e9f, std::nanf("") })
  {
    const auto series = this->Series<float>({ 0, 1, 2 }, grid, { -1e9 }, none);
    const InterpolationError error = EstimateInterpolation(*series, 0, 0);
    EXPECT_FLOAT_EQ(error.LargestLeftOut, 7.0 + 1.0);
  }
}

TEST_F(InterpolationErrorTest, LooksAtAPartOfLargeSeries)
{
  const auto series = this->Series<float>({ 0, 1, 2, 3 }, GridOf(129, 65, 65));
  const InterpolationError error = EstimateInterpolation(*series, 0, 0);
  EXPECT_EQ(error.EveryNth, 2);
  EXPECT_FLOAT_EQ(error.Largest, 128 / 4.0) << "the last sample is one of them";
  std::vector<double> times(100);
  std::iota(times.begin(), times.end(), 0.0);
  EXPECT_EQ(EstimateInterpolation(*this->Series<float>(times, GridOf(4, 3, 2)), 0, 0).Steps, 64);
}

TEST_F(InterpolationErrorTest, IsToldWhereItIsAskedFor)
{
  const Grid grid = GridOf(9, 5, 4);
  SeriesReport report = ReportSeries(*this->Series<float>({ 0, 1, 2 }, grid), {});
  EXPECT_EQ(InfoToText(report, nullptr).find("between steps"), std::string::npos);
  EXPECT_EQ(InfoToJson(report, nullptr).find("estimatedBetweenSteps"), std::string::npos);
  const auto told = [&](const SeriesFile& series)
  {
    report.Components[0].Between = EstimateInterpolation(series, 0, 0);
    EXPECT_NE(InfoToText(report, nullptr).find("between steps, estimated"), std::string::npos);
    return nlohmann::json::parse(
      InfoToJson(report, nullptr))["components"][0]["estimatedBetweenSteps"];
  };
  EXPECT_EQ(told(*this->Series<float>({ 0, 1, 2 }, grid))["max"], 2.0);
  EXPECT_TRUE(told(*this->Series<float>({ 0, 1 }, grid)).is_null()) << "two steps";
  EXPECT_TRUE(told(*this->Series<std::int16_t>({ 0, 1, 2 }, grid)).is_null()) << "labels";
}

} // namespace
} // namespace banyan
