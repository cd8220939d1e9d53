// SPDX-License-Identifier: BSD-3-Clause
#include "VerifyTesting.h"

#include "RawSource.h"
#include "SeriesSource.h"
#include "StreamSource.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <sstream>

namespace banyan
{
namespace
{

using namespace testing;

TEST(Sources, ASeriesIsWithinTheBoundOfItself)
{
  const Encoded encoded;
  SeriesSource source(SeriesFile::Open(encoded.Path));
  const Verification result = Verify(*SeriesFile::Open(encoded.Path), source, {});
  EXPECT_TRUE(result.Proven());
  EXPECT_EQ(result.Components[0].All.Greatest, 0.0);
  EXPECT_EQ(result.Components[0].All.NonFinite, 9 * StepCount);
}

TEST(Sources, RawFilesHoldOneStepOrMore)
{
  const Encoded encoded;
  const auto write = [&](const std::string& name, int first, int end)
  {
    std::ofstream file(encoded.Folder / name, std::ios::binary);
    for (int step = first; step < end; ++step)
    {
      const auto bytes = BytesFrom(encoded.Original[static_cast<std::size_t>(step)]);
      file.write(
        reinterpret_cast<const char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
    }
    return encoded.Folder / name;
  };
  const SourceArray array{ "values", ScalarType::Float32, 1 };
  const std::vector<std::string> files{ write("a.raw", 0, 1), write("b.raw", 1, 4),
    write("c.raw", 4, 5) };
  RawSource source(files, array, { 20, 15, 9 });
  EXPECT_TRUE(Verify(*SeriesFile::Open(encoded.Path), source, {}).Proven());
  EXPECT_THROW(RawSource(files, array, { 20, 15, 10 }), Error);
  EXPECT_THROW(RawSource({ encoded.Folder / "none.raw" }, array, { 20, 15, 9 }), Error);
  std::ofstream(encoded.Folder / "empty.raw").flush();
  EXPECT_THROW(RawSource({ encoded.Folder / "empty.raw" }, array, { 20, 15, 9 }), Error);
}

/// What a program would send for steps in memory.
std::string StreamOf(const MemorySource& source)
{
  std::string stream;
  for (const MemorySource::Step& step : source.Steps)
  {
    const Grid& grid = *step.Description.Domain;
    nlohmann::json json;
    json["time"] = *step.Description.Time;
    json["extent"] = { grid.Extent.Lo.x, grid.Extent.Hi.x - 1, grid.Extent.Lo.y,
      grid.Extent.Hi.y - 1, grid.Extent.Lo.z, grid.Extent.Hi.z - 1 };
    json["origin"] = { grid.Origin.x, grid.Origin.y, grid.Origin.z };
    json["spacing"] = { grid.Spacing.x, grid.Spacing.y, grid.Spacing.z };
    json["direction"] = { 1, 0, 0, 0, 1, 0, 0, 0, 1 };
    for (const SourceArray& array : step.Description.Arrays)
    {
      json["arrays"].push_back({ { "name", array.Name }, { "type", NameOf(array.Type) },
        { "components", array.Components } });
    }
    stream += json.dump() + "\n";
    for (const auto& values : step.Values)
    {
      stream.append(values.begin(), values.end());
    }
  }
  return stream;
}

TEST(Sources, TakeStepsFromAStream)
{
  Encoded encoded;
  for (MemorySource::Step& step : encoded.Source.Steps)
  {
    // An array that nobody asks for, in front and behind: its bytes are passed over.
    step.Description.Arrays.insert(
      step.Description.Arrays.begin(), { "more", ScalarType::UInt8, 2 });
    step.Values.insert(step.Values.begin(), std::vector<std::uint8_t>(2 * 20 * 15 * 9, '\n'));
    step.Description.Arrays.push_back({ "last", ScalarType::UInt8, 1 });
    step.Values.emplace_back(20 * 15 * 9, '{');
  }
  const auto verify = [&](const std::string& text)
  {
    std::istringstream stream(text);
    StreamSource source(stream);
    return Verify(*SeriesFile::Open(encoded.Path), source, { { "values" }, {} });
  };
  const std::string steps = StreamOf(encoded.Source);
  EXPECT_TRUE(verify(steps + "{\"end\": true}\n").Proven());
  EXPECT_THROW(verify(steps), Error);
  EXPECT_THROW(verify(steps.substr(0, steps.size() / 2)), Error);
  EXPECT_THROW(verify("hello\n"), Error);
  EXPECT_THROW(verify("{}\n"), Error);
  EXPECT_THROW(verify("{\"end\": true}\n"), Error);
  try
  {
    verify("{\"error\": \"It cannot be read.\"}\n");
    ADD_FAILURE() << "an error was sent";
  }
  catch (const Error& error)
  {
    EXPECT_STREQ(error.what(), "It cannot be read.");
  }
}

} // namespace
} // namespace banyan
