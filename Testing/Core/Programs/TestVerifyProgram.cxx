// SPDX-License-Identifier: BSD-3-Clause
#include "ProgramsTesting.h"

#include "Base/Error.h"
#include "VerifyOptions.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>

namespace banyan
{
namespace
{

using namespace testing;

/// A series and its source as one raw file.
struct RawSeries
{
  TemporaryFolder Folder;
  std::string Path = Folder / "series.banyan";
  std::string Raw = Folder / "source.raw";
  std::string Options = " --raw-type float32 --dims 80 48 34";

  RawSeries()
  {
    const Steps<float> steps = Sample<float>(CornersGrid(), 3, CornersAt);
    Encode(this->Path, CornersGrid(), steps, CornersOptions());
    std::ofstream file(this->Raw, std::ios::binary);
    for (const auto& step : steps)
    {
      file.write(
        reinterpret_cast<const char*>(step.data()), static_cast<std::streamsize>(4 * step.size()));
    }
  }

  ProgramResult Run(const std::string& arguments) const
  {
    return RunProgram(std::string(BANYAN_VERIFY) + " " + this->Path + " " + arguments);
  }
};

TEST(VerifyProgram, ItsExitStatusIsTheVerdict)
{
  const RawSeries series;
  const std::string against = "--against " + series.Raw + series.Options;
  ProgramResult result = series.Run(against + " --opacity 0:0,5:0,12:1");
  EXPECT_EQ(result.Status, 0) << result.Output;
  EXPECT_NE(result.Output.find("PROVEN"), std::string::npos) << result.Output;
  result = series.Run(against + " --json");
  EXPECT_EQ(result.Status, 0);
  EXPECT_TRUE(nlohmann::json::parse(result.Output)["proven"]);
  EXPECT_EQ(series.Run("--against " + series.Path).Status, 0);
  {
    std::fstream file(series.Raw, std::ios::binary | std::ios::in | std::ios::out);
    file.seekp(4 * (80 * 48 * 34 + 81)); // step 1, (1, 1, 0)
    const float other = -5.0f;
    file.write(reinterpret_cast<const char*>(&other), 4);
  }
  result = series.Run(against);
  EXPECT_EQ(result.Status, 1);
  EXPECT_NE(
    result.Output.find("Worst: step 1 (time 1), i j k = 1 1 0, original -5,"), std::string::npos)
    << result.Output;
}

TEST(VerifyProgram, SaysWhatCannotBeCompared)
{
  const RawSeries series;
  const auto expect = [&](const std::string& arguments, const std::string& sentence)
  {
    const ProgramResult result = series.Run(arguments);
    EXPECT_EQ(result.Status, 2) << arguments;
    EXPECT_NE(result.Output.find(sentence), std::string::npos) << arguments << "\n"
                                                               << result.Output;
  };
  const std::string against = "--against " + series.Raw;
  expect("", "Option --against is needed");
  expect("--against", "Option --against needs a value");
  expect(against, "raw files need --raw-type and --dims");
  expect(against + " --raw-type float32", "--raw-type and --dims are needed together");
  expect(against + " --raw-type float16 --dims 1 1 1", "float16");
  expect(against + " --raw-type float32 --dims 80 48", "Option --dims needs a value");
  expect(against + " --raw-type float32 --dims 80 48 0", "Option --dims needs a whole number");
  expect(against + " --raw-type float32 --dims 17 24 40", "the number of samples of the source");
  expect(against + " --raw-type float32 --dims 41 24 17", "is not a multiple of");
  expect(against + " --raw-type int32 --dims 80 48 34", "is int32 in the source");
  expect(against + series.Options + " --array other", "The series has no array \"other\"");
  expect(against + series.Options + " --opacity 3", "pairs value:opacity");
  expect(against + series.Options + " --opacity 3:x", "Option --opacity needs a number");
  expect(against + series.Options + " --opacity 3:0.5,2:0", "");
  expect(against + " --quick", "There is no option \"--quick\"");
  expect("--against " + (series.Folder / "none.banyan"), "none.banyan");
  expect("--stream < /dev/null", "The source was cut short");
}

} // namespace
} // namespace banyan
