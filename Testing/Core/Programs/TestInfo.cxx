// SPDX-License-Identifier: BSD-3-Clause
#include "ProgramsTesting.h"

#include "DecodeTimes.h"
#include "InfoJson.h"
#include "InfoText.h"
#include "SeriesReport.h"
#include "StepTable.h"

#include "Base/Error.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <filesystem>
#include <numeric>
#include <set>
#include <sstream>

namespace banyan
{
namespace
{

using namespace testing;

constexpr int StepCount = 7;

/// An encoded series of corners, with the originals.
struct Corners
{
  TemporaryFolder Folder;
  std::string Path = Folder / "corners.banyan";
  Steps<float> Original = Sample<float>(CornersGrid(), StepCount, CornersAt);
  std::shared_ptr<SeriesFile> File;

  Corners()
  {
    Encode(this->Path, CornersGrid(), this->Original, CornersOptions());
    this->File = SeriesFile::Open(this->Path);
  }

  SeriesReport Report(const ReportChoice& choice = {}) const
  {
    return ReportSeries(*this->File, choice);
  }

  std::vector<float> Brick(int step, std::int64_t brick) const
  {
    std::vector<float> values(
      static_cast<std::size_t>(this->File->Layout(0).SamplesOf(brick).Count()));
    this->File->DecodeBrick({ step, 0, 0, 0 }, brick, values.data());
    return values;
  }
};

TEST(Info, BricksAreCountedAsTheyDecode)
{
  const Corners corners;
  const SeriesReport report = corners.Report();
  ASSERT_EQ(report.Components.size(), 1u);
  ASSERT_EQ(report.Components[0].Steps.size(), std::size_t{ StepCount });
  const BrickLayout layout = corners.File->Layout(0);
  for (int step = 0; step < StepCount; ++step)
  {
    std::int64_t uniform = 0;
    std::int64_t unchanged = 0;
    ValueRange range;
    for (std::int64_t brick = 0; brick < layout.BrickCount(); ++brick)
    {
      const std::vector<float> values = corners.Brick(step, brick);
      uniform += std::set<float>(values.begin(), values.end()).size() == 1 ? 1 : 0;
      unchanged += step > 0 && values == corners.Brick(step - 1, brick) ? 1 : 0;
      range.Include(RangeOf(values));
    }
    const StepReport& reported = report.Components[0].Steps[static_cast<std::size_t>(step)];
    const BrickCounts& counts = reported.Levels[0];
    EXPECT_EQ(reported.Time, step);
    EXPECT_EQ(counts.Bricks, layout.BrickCount());
    EXPECT_EQ(counts.MacroVoxels, uniform) << "step " << step;
    EXPECT_EQ(counts.Unchanged, unchanged) << "step " << step;
    EXPECT_EQ(counts.Stored + counts.Shared, layout.BrickCount() - uniform);
    EXPECT_EQ(reported.Range.Low, range.Low);
    EXPECT_EQ(reported.Range.High, range.High);
    EXPECT_GT(uniform, 0);
    EXPECT_EQ(unchanged > 0, step > 0);
  }
}

TEST(Info, UnchangedSubtreesCoverTheUnchangedBricks)
{
  const Corners corners;
  const SeriesReport report = corners.Report();
  for (const StepReport& step : report.Components[0].Steps)
  {
    // A node stands over at most 8^level bricks, and each unchanged brick is below exactly one.
    std::int64_t least = 0;
    std::int64_t most = 0;
    for (std::size_t level = 0; level < step.Unchanged.size(); ++level)
    {
      least += step.Unchanged[level];
      most += step.Unchanged[level] << (3 * level);
    }
    EXPECT_LE(least, step.Levels[0].Unchanged);
    EXPECT_GE(most, step.Levels[0].Unchanged);
    EXPECT_EQ(step.Levels[0].Unchanged == 0, most == 0);
  }
}

TEST(Info, PayloadsAreCountedOncePerSegment)
{
  const Corners corners;
  const ComponentReport component = corners.Report().Components[0];
  std::uint64_t bytes = 0;
  for (int level = 0; level < corners.File->Index().Levels; ++level)
  {
    bytes += component.Sum(level).StoredBytes;
  }
  // The planes that no level shows have some too.
  EXPECT_LE(bytes, corners.File->Index().Statistics.PayloadBytes);
  EXPECT_GT(4 * bytes, 3 * corners.File->Index().Statistics.PayloadBytes);
  // The still corner is shared within the segments of 3 steps.
  EXPECT_GT(component.Steps[1].Levels[0].Shared, 0);
}

TEST(Info, ErrorsAreThoseOfTheDecodedValues)
{
  const Corners corners;
  double squares = 0.0;
  double greatest = 0.0;
  std::vector<double> meanSquares;
  for (int step = 0; step < StepCount; ++step)
  {
    const auto decoded = ReadAll<float>(*corners.File, { step, 0, 0, 0 });
    for (std::size_t i = 0; i < decoded.size(); ++i)
    {
      const double error =
        std::abs(double{ decoded[i] } - corners.Original[static_cast<std::size_t>(step)][i]);
      squares += error * error;
      greatest = std::max(greatest, error);
    }
    meanSquares.push_back(squares / static_cast<double>(decoded.size()));
  }
  const SeriesReport report = corners.Report();
  const double rmse = std::sqrt(squares / static_cast<double>(report.Values()));
  EXPECT_EQ(report.Values(), 80 * 48 * 34 * StepCount);
  EXPECT_NEAR(report.Components[0].Rmse(), rmse, 1e-12);
  for (std::size_t step = StepCount; step-- > 0;)
  {
    const double before = step > 0 ? meanSquares[step - 1] : 0.0; // sums up to there
    const double own = std::sqrt(meanSquares[step] - before);
    const ComponentReport& component = report.Components[0];
    EXPECT_NEAR(component.RmseOf(component.Steps[step]).value(), own, 0.006 * own);
  }
  const auto json = nlohmann::json::parse(InfoToJson(corners.Report(), nullptr));
  const auto& error = json["components"][0]["error"];
  EXPECT_EQ(error["max"], greatest);
  EXPECT_GT(error["max"], 0.0);
  EXPECT_LE(error["maxOverBound"], 1.0);
  const auto& range = json["components"][0]["range"];
  EXPECT_NEAR(
    error["psnr"], 20 * std::log10((range[1].get<double>() - range[0].get<double>()) / rmse), 1e-9);
}

TEST(Info, JsonHasWhatTheTextSaysOfChainsAndSteps)
{
  const Corners corners;
  const auto json = nlohmann::json::parse(InfoToJson(corners.Report(), nullptr));
  const EncodeStatistics statistics = corners.File->Index().Statistics;
  EXPECT_EQ(json["stepsToDecode"]["most"], statistics.ChainMost);
  EXPECT_GE(json["stepsToDecode"]["mean"], 1.0);
  EXPECT_LE(json["stepsToDecode"]["mean"], json["stepsToDecode"]["most"]);
  EXPECT_GT(json["stepsToDecode"]["most"], 1); // steps of a group refer to each other
  for (const auto& step : json["components"][0]["steps"])
  {
    const double width = step["high"].get<double>() - step["low"].get<double>();
    EXPECT_NEAR(
      step["psnr_of_own_range"], 20 * std::log10(width / step["rmse"].get<double>()), 1e-9);
  }
  // Versions that did not count chains.
  SeriesReport older = corners.Report();
  older.Index.Statistics.ChainBricks = 0;
  EXPECT_TRUE(nlohmann::json::parse(InfoToJson(older, nullptr))["stepsToDecode"].is_null());
}

TEST(Info, SizesAreThoseOnTheDisk)
{
  const Corners corners;
  std::uint64_t bytes = std::filesystem::file_size(corners.Path);
  for (const auto& entry : std::filesystem::directory_iterator(corners.Path + ".d"))
  {
    bytes += entry.file_size();
  }
  const auto json = nlohmann::json::parse(InfoToJson(corners.Report(), nullptr))["size"];
  const double values = 80.0 * 48 * 34 * StepCount;
  EXPECT_EQ(json["encodedBytes"], bytes);
  EXPECT_EQ(json["rawBytes"], 4 * values);
  EXPECT_DOUBLE_EQ(json["bitsPerValue"], 8.0 * static_cast<double>(bytes) / values);
  EXPECT_DOUBLE_EQ(json["savedAgainstRaw"], 1 - static_cast<double>(bytes) / (4 * values));
  EXPECT_DOUBLE_EQ(json["savedAgainst8Bit"], 1 - static_cast<double>(bytes) / values);
}

TEST(Info, ChoosesStepsAndArrays)
{
  const Corners corners;
  const ComponentReport whole = corners.Report().Components[0];
  for (const int step : { 0, 4, StepCount - 1 })
  {
    const ComponentReport one = corners.Report({ step, "values" }).Components[0];
    ASSERT_EQ(one.Steps.size(), 1u);
    const BrickCounts& a = one.Steps[0].Levels[0];
    const BrickCounts& b = whole.Steps[static_cast<std::size_t>(step)].Levels[0];
    EXPECT_EQ(one.Steps[0].Step, step);
    EXPECT_EQ(a.Unchanged, b.Unchanged);
    EXPECT_EQ(a.Stored, b.Stored);
    EXPECT_EQ(a.Shared, b.Shared);
    EXPECT_EQ(a.StoredBytes, b.StoredBytes);
  }
  EXPECT_THROW(corners.Report({ StepCount, "" }), Error);
  EXPECT_THROW(corners.Report({ -1, "other" }), Error);
}

TEST(Info, SegmentsThatAreStoredOnceAreCountedOnce)
{
  const TemporaryFolder folder;
  const std::string path = folder / "loop.banyan";
  Steps<float> steps;
  for (int step = 0; step < 15; ++step)
  {
    steps.push_back(Sample<float>(CornersGrid(), 1,
      [step](int x, int y, int z, int) {
        return CornersAt(x, y, z, step % 3);
      }).front());
  }
  Encode(path, CornersGrid(), steps, CornersOptions()); // 3 steps per segment
  const auto file = SeriesFile::Open(path);
  const SeriesReport report = ReportSeries(*file, {});
  // All but the first refer to the same step before.
  ASSERT_EQ(file->Index().Statistics.RepeatedSegments, 3);
  std::uint64_t bytes = 0;
  for (const auto& entry : std::filesystem::directory_iterator(path + ".d"))
  {
    bytes += entry.file_size();
  }
  EXPECT_EQ(report.SegmentBytes, bytes);
  std::uint64_t stored = 0;
  for (int level = 0; level < file->Index().Levels; ++level)
  {
    stored += report.Components[0].Sum(level).StoredBytes;
  }
  EXPECT_LE(stored, file->Index().Statistics.PayloadBytes);
  EXPECT_GT(report.Components[0].Steps[3].Levels[0].Stored, 0);
  EXPECT_EQ(report.Components[0].Steps[9].Levels[0].Stored, 0);
  EXPECT_GT(report.Components[0].Steps[9].Levels[0].Shared, 0);
  const auto size = nlohmann::json::parse(InfoToJson(report, nullptr))["size"];
  EXPECT_EQ(size["segmentBytes"], bytes);
  EXPECT_EQ(size["repeatedSegments"], 3);
  EXPECT_EQ(size["repeatedBytes"], 3 * file->Index().Segments[1].Bytes);
  EXPECT_NE(InfoToText(report, nullptr).find("not stored again: 3 segments"), std::string::npos);
}

TEST(Info, TheTableOfStepsIsTheSameInCsvAndJson)
{
  const Corners corners;
  const SeriesReport report = corners.Report();
  const auto steps = nlohmann::json::parse(InfoToJson(report, nullptr))["components"][0]["steps"];
  std::istringstream csv(StepCsv(report));
  std::vector<std::vector<std::string>> rows;
  for (std::string line; std::getline(csv, line);)
  {
    rows.emplace_back();
    std::istringstream fields(line);
    for (std::string field; std::getline(fields, field, ',');)
    {
      rows.back().push_back(field);
    }
  }
  ASSERT_EQ(rows.size(), std::size_t{ StepCount + 1 });
  ASSERT_EQ(steps.size(), std::size_t{ StepCount });
  for (std::size_t r = 1; r < rows.size(); ++r)
  {
    ASSERT_EQ(rows[r].size(), rows[0].size());
    EXPECT_EQ(rows[r][0], "\"values\"");
    for (std::size_t c = 1; c < rows[r].size(); ++c)
    {
      EXPECT_EQ(std::stod(rows[r][c]), steps[r - 1][rows[0][c]].get<double>()) << rows[0][c];
    }
  }
  for (const char* name : { "unchanged_4096", "macro_voxels_32768" })
  {
    EXPECT_EQ(std::count(rows[0].begin(), rows[0].end(), name), 1) << name;
  }
}

TEST(Info, VectorsFlatGridsAndMissingValuesAreReported)
{
  const TemporaryFolder folder;
  const std::string path = folder / "flat.banyan";
  const Grid grid = GridOf(20, 20, 1);
  std::vector<float> values(800, std::nanf(""));
  ArrayDescription description{ "wind", ScalarType::Float32, { "u", "v" },
    { ValueRange{ 0, 1 }, ValueRange{} } };
  for (std::size_t i = 0; i < 400; ++i)
  {
    values[2 * i] = static_cast<float>(i % 2); // v is missing everywhere
  }
  ThreadPool pool(1);
  SeriesEncoder encoder(path, grid, { description }, CornersOptions(), pool);
  encoder.AddStep(0.5, { { values.data() } });
  encoder.Finish();
  const SeriesReport report = ReportSeries(*SeriesFile::Open(path), {});
  ASSERT_EQ(report.Components.size(), 2u);
  EXPECT_EQ(report.Components[0].Name, "wind[u]");
  EXPECT_EQ(report.VoxelsBelow(1), 1024); // 32 x 32 of a flat grid
  const auto json = nlohmann::json::parse(InfoToJson(report, nullptr));
  EXPECT_TRUE(json["components"][1]["range"].is_null());
  EXPECT_TRUE(json["components"][1]["error"]["psnr"].is_null());
  EXPECT_TRUE(json["components"][1]["steps"][0]["low"].is_null());
  EXPECT_EQ(json["components"][1]["nonFinite"], 400);
  EXPECT_EQ(json["components"][1]["levels"][0]["withNonFinite"], 4);
  EXPECT_NE(InfoToText(report, nullptr).find("wind[v]"), std::string::npos);
}

TEST(Info, TimesAreMeasuredWhereThereIsSomethingToDecode)
{
  const Corners corners;
  const DecodeTimes times = MeasureDecodeTimes(corners.Path, 0, 1);
  EXPECT_GT(times.Warm.Count, 0);
  EXPECT_EQ(times.Cold.Count, 100);
  EXPECT_GT(times.SequentialBytesPerSecond, 0.0);
  const auto json = nlohmann::json::parse(InfoToJson(corners.Report(), &times));
  EXPECT_EQ(json["microseconds"]["warmBrick"]["count"], times.Warm.Count);
  EXPECT_EQ(json["microseconds"]["finestPlaneOfBrick"]["count"], times.Warm.Count);
}

TEST(Info, SummariesOfTimes)
{
  EXPECT_EQ(Summarize({}).Count, 0);
  std::vector<double> times(100);
  std::iota(times.rbegin(), times.rend(), 1.0);
  const TimeSummary summary = Summarize(times);
  EXPECT_EQ(summary.Count, 100);
  EXPECT_EQ(summary.Median, 50.5);
  EXPECT_EQ(summary.Mean, 50.5);
  EXPECT_EQ(summary.Percentile95, 95.0);
  EXPECT_EQ(Summarize({ 3.0, 9.0, 4.0 }).Median, 4.0);
}

} // namespace
} // namespace banyan
