// SPDX-License-Identifier: BSD-3-Clause
// The parts of banyan-generate around the physics, and the program itself.
#include "GenerateFixture.h"
#include "GenerateOptions.h"
#include "HotBlobs.h"
#include "ImageSeriesWriter.h"
#include "SeriesCatalog.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <set>

namespace fs = std::filesystem;

namespace
{

std::string Base64(const std::string& bytes)
{
  return banyan::EncodeBase64(reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size());
}

std::string ErrorOf(const std::vector<std::string>& arguments)
{
  try
  {
    banyan::ParseGenerateOptions(arguments);
  }
  catch (const banyan::Error& error)
  {
    return error.what();
  }
  return "";
}

} // namespace

TEST_F(Generate, Base64FollowsTheStandard)
{
  // The test vectors of RFC 4648, section 10.
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foob"), "Zm9vYg==");
  EXPECT_EQ(Base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Base64("\xff\xef\xbf"), "/++/");
}

TEST_F(Generate, OptionsAreRead)
{
  const auto options = banyan::ParseGenerateOptions({ "--output", "here", "--size", "32", "--seed",
    "7", "--arrays", "vorticity,temperature", "--duration", "1.5", "--steps", "3" });
  EXPECT_EQ(options.Output, "here");
  EXPECT_EQ(options.Size, 32);
  EXPECT_EQ(options.Seed, 7u);
  EXPECT_EQ(options.Steps, 3);
  EXPECT_EQ(options.Duration, 1.5);
  EXPECT_EQ(options.Arrays, (std::vector<std::string>{ "vorticity", "temperature" }));
}

TEST_F(Generate, WrongOptionsAreNamed)
{
  EXPECT_NE(ErrorOf({}).find("--output"), std::string::npos);
  EXPECT_NE(ErrorOf({ "--output" }).find("--output needs a value"), std::string::npos);
  EXPECT_NE(ErrorOf({ "--output", "o", "--size", "7" }).find("\"7\""), std::string::npos);
  EXPECT_NE(ErrorOf({ "--output", "o", "--size", "33" }).find("even"), std::string::npos);
  EXPECT_NE(ErrorOf({ "--output", "o", "--size", "32x" }).find("32x"), std::string::npos);
  EXPECT_NE(ErrorOf({ "--output", "o", "--seed", "-1" }).find("-1"), std::string::npos);
  EXPECT_NE(ErrorOf({ "--output", "o", "--duration", "nan" }).find("nan"), std::string::npos);
  EXPECT_NE(ErrorOf({ "--output", "o", "--arrays", "heat" }).find("heat"), std::string::npos);
  EXPECT_NE(ErrorOf({ "--output", "o", "--series", "tea" }).find("hot-blobs"), std::string::npos);
  EXPECT_NE(
    ErrorOf({ "--output", "o", "--series", "jet", "--arrays", "heat" }).find("concentration"),
    std::string::npos);
  EXPECT_NE(ErrorOf({ "--output", "o", "--fast" }).find("--fast"), std::string::npos);
}

TEST_F(Generate, BlobsAreHotInsideColdOutsideAndSeeded)
{
  const banyan::HotBlobs blobs(1, 0.1f), same(1, 0.1f), other(2, 0.1f);
  EXPECT_NEAR(blobs.Temperature(0.0f, 0.0f, 6.0f), 0.0f, 1e-3f);
  bool hot = false, differs = false;
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i)
  {
    const float x = random() % 6283 / 1000.0f, y = random() % 6283 / 1000.0f;
    const float t = blobs.Temperature(x, y, 1.3f);
    EXPECT_GE(t, 0.0f);
    EXPECT_LE(t, 1.0f);
    EXPECT_EQ(t, same.Temperature(x, y, 1.3f));
    hot = hot || t > 0.99f;
    differs = differs || std::abs(t - other.Temperature(x, y, 1.3f)) > 0.1f;
  }
  EXPECT_TRUE(hot);
  EXPECT_TRUE(differs);
}

TEST_F(Generate, EqualSeedsGiveEqualBytesWithAnyNumberOfThreads)
{
  const std::string common = " --size 16 --steps 3 --duration 0.5 --arrays "
                             "temperature,velocity,vorticity --output ";
  ASSERT_TRUE(this->Run("--seed 5 --threads 1" + common + (this->Folder / "a").string()));
  ASSERT_TRUE(this->Run("--seed 5 --threads 3" + common + (this->Folder / "b").string()));
  ASSERT_TRUE(this->Run("--seed 6 --threads 1" + common + (this->Folder / "c").string()));
  for (const char* name : { "flow_0000.vti", "flow_0001.vti", "flow_0002.vti", "flow.vti.series" })
  {
    ASSERT_FALSE(this->Text(fs::path("a") / name).empty()) << name;
    EXPECT_TRUE(this->Text(fs::path("a") / name) == this->Text(fs::path("b") / name)) << name;
  }
  EXPECT_FALSE(this->Text("a/flow_0002.vti") == this->Text("c/flow_0002.vti"));
}

TEST_F(Generate, TheSeriesFileNamesEveryStepAndTime)
{
  ASSERT_TRUE(this->Run("--size 8 --steps 5 --duration 2 --output " + this->Folder.string()))
    << this->Messages();
  const auto series = nlohmann::json::parse(this->Text("flow.vti.series"));
  ASSERT_EQ(series["files"].size(), 5u);
  for (int step = 0; step < 5; ++step)
  {
    const std::string name = series["files"][step]["name"];
    EXPECT_EQ(series["files"][step]["time"], 0.5 * step);
    const std::string text = this->Text(name);
    EXPECT_NE(text.find("WholeExtent=\"0 7 0 7 0 7\""), std::string::npos);
    EXPECT_EQ(text.find("appended"), std::string::npos);
    // 8 bytes of length and 512 floats, in base64.
    EXPECT_NE(text.find("format=\"binary\">\n"), std::string::npos);
  }
  EXPECT_NE(this->Messages().find("step 5 of 5"), std::string::npos);
}

TEST_F(Generate, FailuresAreOneSentenceAndLeaveNothingHalfWritten)
{
  EXPECT_FALSE(this->Run("--size 8 --output /dev/null/folder"));
  EXPECT_NE(this->Messages().find("banyan-generate: "), std::string::npos);
  EXPECT_FALSE(this->Run("--size 12345"));
  // A folder in the way of the third file: the first two are whole, the third leaves no trace.
  fs::create_directories(this->Folder / "out" / "flow_0002.vti" / "x");
  EXPECT_FALSE(
    this->Run("--size 8 --steps 4 --duration 0.1 --output " + (this->Folder / "out").string()));
  EXPECT_FALSE(fs::exists(this->Folder / "out" / "flow.vti.series"));
  EXPECT_FALSE(fs::exists(this->Folder / "out" / "flow_0002.vti.partial"));
  EXPECT_TRUE(fs::is_regular_file(this->Folder / "out" / "flow_0001.vti"));
}

TEST_F(Generate, EverySeriesInTheCatalogueKeepsItsWord)
{
  std::set<std::string> names, files;
  for (const banyan::SeriesKind& kind : banyan::SeriesCatalog())
  {
    EXPECT_TRUE(names.insert(kind.Name).second) << kind.Name;
    EXPECT_TRUE(files.insert(kind.FileName).second) << kind.FileName;
    EXPECT_NE(banyan::GenerateHelp().find(kind.Description), std::string::npos) << kind.Name;
    if (kind.GenerateMesh)
    {
      EXPECT_FALSE(kind.Generate) << kind.Name;
      continue; // TestEarthquake
    }
    auto options = banyan::ParseGenerateOptions(
      { "--output", "o", "--series", kind.Name, "--size", "16", "--steps", "3", "--seed", "4" });
    EXPECT_EQ(options.Duration, kind.DefaultDuration);
    EXPECT_EQ(options.Arrays, std::vector<std::string>{ kind.Arrays[0] });
    options.Arrays = kind.Arrays;
    std::vector<std::vector<float>> results[2];
    for (const int threads : { 1, 3 })
    {
      banyan::ThreadPool pool(threads);
      double last = -1.0;
      kind.Generate(options, pool,
        [&](double time, const std::vector<banyan::ImageArray>& arrays)
        {
          EXPECT_GT(time, last);
          last = time;
          ASSERT_EQ(arrays.size(), kind.Arrays.size());
          for (std::size_t a = 0; a < arrays.size(); ++a)
          {
            EXPECT_EQ(arrays[a].Name, kind.Arrays[a]);
            ASSERT_EQ(arrays[a].Values.size(), 16u * 16 * 16 * arrays[a].Components);
            EXPECT_TRUE(std::all_of(arrays[a].Values.begin(), arrays[a].Values.end(),
              [](float value) { return std::isfinite(value); }))
              << kind.Name << ", " << arrays[a].Name;
            results[threads > 1].push_back(arrays[a].Values);
          }
        });
      EXPECT_DOUBLE_EQ(last, kind.DefaultDuration) << kind.Name;
    }
    ASSERT_EQ(results[0].size(), 3 * kind.Arrays.size()) << kind.Name;
    EXPECT_TRUE(results[0] == results[1]) << kind.Name << " depends on the number of threads";
    EXPECT_EQ(results[0].front() == results[0][2 * kind.Arrays.size()], kind.Steady) << kind.Name;
  }
}

TEST_F(Generate, TheSeedDecidesTurbulenceAndJet)
{
  for (const std::string name : { "turbulence", "jet" })
  {
    std::vector<std::vector<float>> results;
    for (const char* seed : { "1", "1", "2" })
    {
      const auto options = banyan::ParseGenerateOptions(
        { "--output", "o", "--series", name, "--size", "16", "--steps", "1", "--seed", seed });
      banyan::ThreadPool pool(2);
      banyan::FindSeriesKind(name).Generate(options, pool,
        [&](double, const std::vector<banyan::ImageArray>& arrays)
        { results.push_back(arrays[0].Values); });
    }
    ASSERT_EQ(results.size(), 3u);
    EXPECT_TRUE(results[0] == results[1]) << name;
    EXPECT_FALSE(results[0] == results[2]) << name;
  }
}

TEST_F(Generate, TheRawFileHoldsTheFirstArrayOfEveryStep)
{
  const std::string path = (this->Folder / "raw").string();
  ASSERT_TRUE(this->Run("--size 8 --steps 2 --duration 0.5 --arrays vorticity,temperature --raw " +
                        path + " --output " + this->Folder.string()))
    << this->Messages();
  const std::string raw = this->Text("raw");
  const std::size_t step = 8 * 8 * 8 * sizeof(float);
  ASSERT_EQ(raw.size(), 2 * step);
  for (int i = 0; i < 2; ++i)
  {
    // In the .vti file the same bytes follow their number.
    const std::string length("\0\x08\0\0\0\0\0\0", 8);
    EXPECT_NE(this->Text(i == 0 ? "flow_0000.vti" : "flow_0001.vti")
                .find(Base64(length + raw.substr(i * step, step))),
      std::string::npos);
  }
  EXPECT_FALSE(fs::exists(path + ".partial"));
  EXPECT_FALSE(this->Run("--size 8 --raw /dev/null/file"));
  EXPECT_NE(this->Messages().find("/dev/null/file"), std::string::npos);
}
