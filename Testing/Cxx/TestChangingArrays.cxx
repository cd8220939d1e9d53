// SPDX-License-Identifier: BSD-3-Clause
// Arrays that come and go, and sources that do not have the times that they list: nothing is lost
// without a word.
#include "WriterRobustness.h"

#include "vtkBanyanSeriesReader.h"

#include "vtkDataArray.h"
#include "vtkDataArraySelection.h"
#include "vtkDataObject.h"
#include "vtkInformation.h"
#include "vtkPointData.h"

#include "Series/Decode/SeriesFile.h"

#include <random>

namespace
{

using banyan::ScalarType;

constexpr int Steps = 4;
const std::vector<std::string> Names = { "p", "q", "r" };

/// Which arrays are there, by step.
using Presence = std::vector<std::set<std::string>>;

vtkSmartPointer<TestSource> SourceOf(const Presence& there)
{
  const auto source = WaveSource(SimpleGrid({ 4, 3, 5 }), { 0.0, 1.0, 2.0, 3.0 });
  source->Fill = [there](vtkImageData* image, double time)
  {
    for (const std::string& name : there[static_cast<std::size_t>(time)])
    {
      image->GetPointData()->AddArray(
        WaveArray(ScalarType::Float32, name, 1, image->GetExtent(), time, 1.0, 0.0));
    }
  };
  return source;
}

struct Expected
{
  bool Refused = false;
  std::set<std::string> Written;
  std::set<std::string> Warned; ///< parts of the sentence
};

/// The rule: what is chosen (everything, where nothing is) is written or all is refused; where
/// everything that there is at first is chosen, what comes later is told.
Expected Expect(const Presence& there, const std::set<std::string>& chosen)
{
  Expected expected;
  expected.Written = chosen.empty() ? there[0] : chosen;
  const bool allOfFirst = expected.Written == there[0];
  for (std::size_t step = 0; step < Steps; ++step)
  {
    for (const std::string& name : expected.Written)
    {
      expected.Refused = expected.Refused || there[step].count(name) == 0;
    }
    for (const std::string& name : there[step])
    {
      const bool late = there[0].count(name) == 0 && expected.Written.count(name) == 0;
      expected.Refused = expected.Refused || (late && chosen.empty());
      bool earlier = false;
      for (std::size_t before = 0; before < step; ++before)
      {
        earlier = earlier || there[before].count(name) != 0;
      }
      if (late && allOfFirst && !earlier)
      {
        expected.Warned.insert(
          "point array " + name + " first appears at step " + std::to_string(step) + " (time ");
      }
    }
  }
  return expected;
}

TEST(ChangingArrays, AreNeverLostWithoutAWord)
{
  std::mt19937 random(27);
  int refused = 0, warned = 0;
  for (int number = 0; number < 150; ++number)
  {
    SCOPED_TRACE("number " + std::to_string(number));
    Presence there(Steps);
    for (std::size_t step = 0; step < Steps; ++step)
    {
      for (const std::string& name : Names)
      {
        // Arrays that never change are as frequent as those that do.
        const bool same = step > 0 && random() % 8 != 0;
        if (same ? there[step - 1].count(name) != 0 : random() % 3 != 0)
        {
          there[step].insert(name);
        }
      }
      there[step].insert("always");
    }
    std::set<std::string> chosen;
    if (number % 3 == 1)
    {
      chosen = there[0];
    }
    else if (number % 3 == 2)
    {
      chosen = { "always", Names[random() % Names.size()] };
    }
    const Expected expected = Expect(there, chosen);
    TemporaryFolder folder;
    const auto source = SourceOf(there);
    vtkNew<vtkBanyanSeriesWriter> writer;
    Messages messages(writer);
    writer->SetInputConnection(source->GetOutputPort());
    writer->SetFileName((folder / "a.banyan").c_str());
    writer->SetErrorBoundMode(number % 2);
    for (const std::string& name : chosen)
    {
      writer->GetPointArraySelection()->EnableArray(name.c_str());
    }
    EXPECT_EQ(writer->Write(), expected.Refused ? 0 : 1) << messages.Errors;
    refused += expected.Refused ? 1 : 0;
    if (expected.Refused)
    {
      EXPECT_TRUE(folder.Entries().empty());
      continue;
    }
    warned += expected.Warned.empty() ? 0 : 1;
    EXPECT_EQ(messages.Warnings.empty(), expected.Warned.empty()) << messages.Warnings;
    for (const std::string& part : expected.Warned)
    {
      EXPECT_NE(messages.Warnings.find(part), std::string::npos) << part << messages.Warnings;
    }
    std::set<std::string> written;
    const auto file = banyan::SeriesFile::Open(folder / "a.banyan");
    for (const banyan::ArrayIndex& array : file->Index().Arrays)
    {
      written.insert(array.Name);
    }
    EXPECT_EQ(written, expected.Written);
  }
  EXPECT_GT(refused, 20);
  EXPECT_GT(warned, 10);
}

/// Delivers the time that a function makes of the one that was asked for.
vtkSmartPointer<TestSource> SourceWithTimes(
  const std::vector<double>& times, const std::function<double(double)>& delivered)
{
  const auto source = WaveSource(SimpleGrid({ 4, 3, 5 }), times);
  const auto fill = source->Fill;
  source->Fill = [=](vtkImageData* image, double time)
  {
    fill(image, time);
    image->GetInformation()->Set(vtkDataObject::DATA_TIME_STEP(), delivered(time));
  };
  return source;
}

class TimesOfSources : public WriterRobustness
{
};

TEST_P(TimesOfSources, ThePresentIsNotThePast)
{
  const auto present = [](double) { return 3.0; };
  this->ExpectRefused(SourceWithTimes({ 0.0, 1.0, 3.0 }, present),
    { "At step 0 (time 0)", "lists the time 0, and delivers data of time 3", "Write Time Steps" });
  this->ExpectRefused(SourceWithTimes({ 0.0 }, present), { "delivers data of time 3" });
  // Asked for another step, it gives the one before.
  this->ExpectRefused(
    SourceWithTimes({ 0.0, 1.0, 2.0 }, [](double time) { return time == 2.0 ? 1.0 : time; }),
    { "At step 2 (time 2)", "delivers data of time 1" });
  // Steps that lie closer than rounding.
  this->ExpectRefused(SourceWithTimes({ 1e6, 1e6 + 0.1 }, [](double) { return 1e6 + 0.1; }),
    { "delivers data of time 1000000.1" });
}

TEST_P(TimesOfSources, MayBeRounded)
{
  const auto rounded = [](double time) { return static_cast<double>(static_cast<float>(time)); };
  const auto source = SourceWithTimes({ 0.0, 0.1, 0.7, 1234.56789 }, rounded);
  const int mode = GetParam();
  WriteSeries(source, this->Folder / "a.banyan",
    [mode](vtkBanyanSeriesWriter* writer) { writer->SetErrorBoundMode(mode); });
  const auto file = banyan::SeriesFile::Open(this->Folder / "a.banyan");
  EXPECT_EQ(file->Index().Times, source->Times);
}

TEST_P(TimesOfSources, ThePresentStepIsSavedWhateverIsListed)
{
  // A Catalyst script may have a time twice.
  const auto source = SourceWithTimes({ 0.0, 0.0, 1.0 }, [](double) { return 2.5; });
  this->ExpectRefused(source, { "do not increase" });
  const int mode = GetParam();
  WriteSeries(source, this->Folder / "b.banyan",
    [mode](vtkBanyanSeriesWriter* writer)
    {
      writer->SetErrorBoundMode(mode);
      writer->WriteTimeStepsOff();
    });
  const auto file = banyan::SeriesFile::Open(this->Folder / "b.banyan");
  EXPECT_EQ(file->Index().Times, std::vector<double>{ 2.5 });
}

INSTANTIATE_TEST_SUITE_P(Writer, TimesOfSources, testing::Values(0, 1));

} // namespace
