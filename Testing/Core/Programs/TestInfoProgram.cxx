// SPDX-License-Identifier: BSD-3-Clause
#include "ProgramsTesting.h"

#include "Base/Error.h"
#include "InfoOptions.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <sstream>

namespace banyan
{
namespace
{

using namespace testing;

TEST(InfoProgram, PrintsTextJsonAndTheTable)
{
  const TemporaryFolder folder;
  const std::string path = folder / "series.banyan";
  Encode(path, CornersGrid(), Sample<float>(CornersGrid(), 4, CornersAt), CornersOptions());
  const std::string info = std::string(BANYAN_INFO) + " " + path;

  const ProgramResult text = RunProgram(info + " --time --between");
  EXPECT_EQ(text.Status, 0);
  for (const char* phrase : { "80 x 48 x 34 samples, 4 steps", "1/512 of the range",
         "bits per value", "steps to decode for a brick", "unchanged subtrees",
         "a random brick, cold", "between steps, estimated" })
  {
    EXPECT_NE(text.Output.find(phrase), std::string::npos) << phrase << "\n" << text.Output;
  }

  const ProgramResult json = RunProgram(info + " --json --step 2 --csv " + (folder / "steps.csv"));
  EXPECT_EQ(json.Status, 0);
  const auto parsed = nlohmann::json::parse(json.Output);
  EXPECT_EQ(parsed["components"][0]["steps"].size(), 1u);
  EXPECT_EQ(parsed["components"][0]["steps"][0]["step"], 2);
  EXPECT_EQ(parsed["grid"]["extent"], (std::vector<int>{ 0, 79, 0, 47, 0, 33 }));
  EXPECT_FALSE(parsed.contains("microseconds"));
  std::ifstream csv(folder / "steps.csv");
  std::string heading;
  std::getline(csv, heading);
  EXPECT_EQ(heading.rfind("array,step,time,low,high,", 0), 0u);
}

TEST(InfoProgram, SaysWhatIsWrong)
{
  const TemporaryFolder folder;
  const std::string path = folder / "series.banyan";
  Encode(path, GridOf(5, 5, 5), Sample<float>(GridOf(5, 5, 5), 2, CornersAt), {});
  const auto expect = [](const std::string& arguments, const std::string& sentence)
  {
    const ProgramResult result = RunProgram(std::string(BANYAN_INFO) + " " + arguments);
    EXPECT_EQ(result.Status, 1) << arguments;
    EXPECT_NE(result.Output.find(sentence), std::string::npos) << arguments << "\n"
                                                               << result.Output;
  };
  expect("", "The name of a series is needed");
  expect(path + " --step", "Option --step needs a value");
  expect(path + " --step -1", "Option --step needs a whole number from 0");
  expect(path + " --step 2", "step");
  expect(path + " --array other", "The series has no array \"other\"");
  expect(path + " --jason", "There is no option \"--jason\"");
  expect(path + " " + path, "One series is looked at at a time");
  expect(folder / "nothing.banyan", "nothing.banyan");
  std::ofstream(folder / "text.banyan") << "hello";
  expect(folder / "text.banyan", "text.banyan");
}

} // namespace
} // namespace banyan
