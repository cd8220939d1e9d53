// SPDX-License-Identifier: BSD-3-Clause
// Groups of steps, encoded apart from each other, make the same series as one encoder does.
#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Series/Encode/BackgroundEncoder.h"
#include "Series/Encode/EncodePlan.h"
#include "Series/Encode/GroupEncoder.h"
#include "Series/Encode/GroupMessage.h"
#include "Series/Encode/SeriesAssembly.h"

#include <fstream>
#include <iterator>
#include <map>
#include <thread>

#include <sys/wait.h>
#include <unistd.h>

namespace banyan::testing
{
namespace
{

namespace fs = std::filesystem;

constexpr int StepCount = 7;
constexpr int Interval = 2;
constexpr int GroupCount = 4;
const Grid Domain = GridOf(34, 19, 17);

std::string Content(const std::string& path)
{
  std::ifstream file(path, std::ios::binary);
  return { std::istreambuf_iterator<char>(file), {} };
}

/// Every file of a series by name: the index, and all that is in its folder.
std::map<std::string, std::string> FilesOf(const std::string& path)
{
  std::map<std::string, std::string> files;
  files["index"] = Content(path);
  for (const auto& entry : fs::directory_iterator(path + ".d"))
  {
    if (entry.path().extension() != ".files") // goes when its SegmentFolder does
    {
      files[entry.path().filename().string()] = Content(entry.path().string());
    }
  }
  return files;
}

enum class Kind
{
  Relative,
  Absolute, ///< without ranges: no group refers to another
  Clamped,
  Hidden,   ///< by an opacity function
  Repeated, ///< the steps of the first group come again and again
  Static    ///< the vectors rest from the last step of the first group on
};

/// Vectors of floats with some NaN, and scalars of a short type, in two arrays.
class Groups : public ::testing::TestWithParam<Kind>
{
protected:
  Groups()
  {
    for (int step = 0; step < StepCount; ++step)
    {
      const int repeated = GetParam() == Kind::Repeated ? step % Interval : step;
      const int s = GetParam() == Kind::Static ? std::min(step, Interval - 1) : repeated;
      this->Vectors.push_back(Sample<float>(GridOf(34 * 3, 19, 17), 1,
        [s](int x, int y, int z, int) {
          return x == 5 && y == 3 ? std::nan("") : Wavy<float>(x / 3, y, z + 7 * (x % 3), s);
        }).front());
      this->Scalars.push_back(Sample<std::int16_t>(Domain, 1,
        [repeated](int x, int y, int z, int) {
          return Wavy<std::int16_t>(x, y, z, repeated);
        }).front());
    }
    this->Options.KeyframeInterval = Interval;
    const bool absolute = GetParam() == Kind::Absolute;
    this->Options.Mode =
      absolute ? ErrorBoundMode::Absolute : ErrorBoundMode::RelativeToSeriesRange;
    this->Options.ErrorBound = absolute ? 0.2 : 1.0 / 300.0;
    QuantizerOptions& quantizer = this->Options.Quantizer;
    if (GetParam() == Kind::Clamped)
    {
      quantizer.Range.From = RangeRule::Source::Given;
      quantizer.Range.Given = { -20.0, 40.0 };
      quantizer.Range.ClampOutside = true;
      quantizer.FillValues = { 20.0 };
    }
    if (GetParam() == Kind::Hidden)
    {
      quantizer.Opacity = { { 20.0, 0.0 }, { 30.0, 0.8 } };
    }
    this->Descriptions = { { "v", ScalarType::Float32, { "x", "y", "z" }, {} },
      { "s", ScalarType::Int16, { "" }, {} } };
    if (!absolute)
    {
      this->Descriptions[0].SeriesRanges.assign(3, ValueRange{ -40.0, 90.0 });
      this->Descriptions[1].SeriesRanges.assign(1, ValueRange{ -32768.0, 32767.0 });
    }
  }

  SeriesIndex Plan() const { return PlanSeries(Domain, this->Descriptions, this->Options); }

  std::vector<ArrayValues> Values(int step) const
  {
    return { { this->Vectors[static_cast<std::size_t>(step)].data() },
      { this->Scalars[static_cast<std::size_t>(step)].data() } };
  }

  std::vector<double> TimesOf(int group) const
  {
    std::vector<double> times;
    for (int s = group * Interval; s < std::min((group + 1) * Interval, StepCount); ++s)
    {
      times.push_back(0.5 * s);
    }
    return times;
  }

  std::vector<std::vector<ArrayValues>> StepsOf(int group) const
  {
    std::vector<std::vector<ArrayValues>> steps;
    for (std::size_t i = 0; i < this->TimesOf(group).size(); ++i)
    {
      steps.push_back(this->Values(group * Interval + static_cast<int>(i)));
    }
    return steps;
  }

  /// The step before a group; none before the first one.
  std::vector<ArrayValues> Before(int group) const
  {
    return group == 0 ? std::vector<ArrayValues>() : this->Values(group * Interval - 1);
  }

  /// What one encoder writes.
  std::map<std::string, std::string> Reference(int threads) const
  {
    const TemporaryFolder folder;
    ThreadPool pool(threads);
    SeriesEncoder encoder(folder / "s.banyan", Domain, this->Descriptions, this->Options, pool);
    for (int s = 0; s < StepCount; ++s)
    {
      encoder.AddStep(0.5 * s, this->Values(s));
    }
    encoder.Finish();
    return FilesOf(folder / "s.banyan");
  }

  std::vector<std::vector<float>> Vectors;
  std::vector<std::vector<std::int16_t>> Scalars;
  EncodeOptions Options;
  std::vector<ArrayDescription> Descriptions;
};

INSTANTIATE_TEST_SUITE_P(Kinds, Groups,
  ::testing::Values(
    Kind::Relative, Kind::Absolute, Kind::Clamped, Kind::Hidden, Kind::Repeated, Kind::Static),
  [](const auto& info)
  {
    const std::vector<std::string> names(
      { "Relative", "Absolute", "Clamped", "Hidden", "Repeated", "Static" });
    return names[static_cast<std::size_t>(info.param)];
  });

TEST_P(Groups, OfAnyProcessInAnyOrderGiveTheSameBytes)
{
  const auto reference = this->Reference(3);
  // The second and the third group, which refer to the same step before, are stored once.
  EXPECT_EQ(reference.size(), GetParam() == Kind::Repeated ? GroupCount : 1u + GroupCount);
  EXPECT_EQ(this->Reference(1), reference);

  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  SeriesAssembly assembly(path, this->Plan());
  int inOrder[] = { 0, 1, 1, 4 };
  int added = 0;
  for (const int group : { 3, 0, 2, 1 })
  {
    const pid_t child = fork();
    if (child == 0)
    {
      ThreadPool pool(1);
      SegmentFolder segments(path);
      const Bytes message = PackGroup(EncodeGroup(this->Plan(), this->Options, segments,
        { group, this->TimesOf(group), this->StepsOf(group), this->Before(group) }, nullptr, pool,
        nullptr));
      std::ofstream file(folder / "message", std::ios::binary);
      file.write(reinterpret_cast<const char*>(message.data()),
        static_cast<std::streamsize>(message.size()));
      file.close();
      _exit(file ? 0 : 1);
    }
    int status = 1;
    ASSERT_EQ(waitpid(child, &status, 0), child);
    ASSERT_EQ(status, 0);
    const std::string message = Content(folder / "message");
    assembly.Add(group, UnpackGroup(Bytes(message.begin(), message.end())));
    // The index names the groups that are complete in order, and opens with them.
    const int expected = inOrder[added++];
    EXPECT_EQ(fs::exists(path), expected > 0);
    EXPECT_EQ(assembly.SegmentsInFile().size(), static_cast<std::size_t>(expected));
    if (expected > 0)
    {
      EXPECT_EQ(SeriesFile::Open(path)->Index().Steps(), std::min(expected * Interval, StepCount));
    }
  }
  assembly.Finish();
  EXPECT_EQ(FilesOf(path), reference);
}

TEST_P(Groups, NeedTheStepBeforeWhereTheyReferToIt)
{
  const TemporaryFolder folder;
  SegmentFolder segments(folder / "s.banyan");
  ThreadPool pool(1);
  const bool refers = GetParam() != Kind::Absolute;
  EXPECT_EQ(MayReferBefore(this->Plan(), this->Options), refers);
  EncodeOptions closed = this->Options;
  closed.ClosedGroups = true;
  EXPECT_FALSE(MayReferBefore(this->Plan(), closed));
  const auto encode = [&](const std::vector<ArrayValues>& before)
  {
    return EncodeGroup(this->Plan(), this->Options, segments,
      { 1, this->TimesOf(1), this->StepsOf(1), before }, nullptr, pool, nullptr)
      .Segment;
  };
  const SegmentIndex whole = encode(this->Before(1));
  if (refers)
  {
    EXPECT_THROW(encode({}), Error);
    EXPECT_NE(encode(this->Values(0)).HashLow, whole.HashLow);
    return;
  }
  EXPECT_EQ(encode({}).HashLow, whole.HashLow);
}

TEST_P(Groups, OfTheBackgroundAreTheSame)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  SeriesAssembly assembly(path, this->Plan());
  SegmentFolder segments(path);
  BackgroundEncoder encoder(this->Plan(), this->Options, segments, 2);
  EXPECT_FALSE(encoder.Take().has_value());
  for (int group = 0; group < GroupCount; ++group)
  {
    // Once it is brought although it is known, and then it has to be brought.
    const bool brought = group >= 2;
    encoder.Start(group, this->TimesOf(group), this->StepsOf(group),
      brought ? this->Before(group) : std::vector<ArrayValues>());
    encoder.Wait([] {});
    EXPECT_FALSE(encoder.Busy());
    auto encoded = encoder.Take();
    ASSERT_TRUE(encoded.has_value());
    EXPECT_EQ(encoded->first, group);
    EXPECT_FALSE(encoder.Take().has_value());
    assembly.Add(group, std::move(encoded->second));
  }
  assembly.Finish();
  EXPECT_EQ(FilesOf(path), this->Reference(2));
}

TEST_P(Groups, AnInterruptedOneIsNotThere)
{
  const TemporaryFolder folder;
  SegmentFolder segments(folder / "s.banyan");
  {
    BackgroundEncoder encoder(this->Plan(), this->Options, segments, 1);
    encoder.Interrupt();
    encoder.Start(0, this->TimesOf(0), this->StepsOf(0));
    encoder.Wait([] {});
    EXPECT_THROW((void)encoder.Take(), Error);
    EXPECT_FALSE(encoder.Take().has_value());
    encoder.Start(1, this->TimesOf(1), this->StepsOf(1), this->Before(1)); // and left alone
  }
  segments.RemoveOwn();
  EXPECT_TRUE(folder.Empty());
}

TEST_P(Groups, AnErrorOfTheBackgroundComesBack)
{
  const TemporaryFolder folder;
  SegmentFolder segments(folder / "s.banyan");
  BackgroundEncoder encoder(this->Plan(), this->Options, segments, 1);
  fs::remove(segments.Path());
  encoder.Start(0, this->TimesOf(0), this->StepsOf(0));
  encoder.Wait([] {});
  try
  {
    (void)encoder.Take();
    ADD_FAILURE() << "no error";
  }
  catch (const Error& error)
  {
    EXPECT_NE(std::string(error.what()).find("s.banyan.d"), std::string::npos) << error.what();
  }
}

TEST_P(Groups, MissingOnesAreNoticedAndWithdrawnOnesLeaveNothing)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  SegmentFolder first(path);
  SegmentFolder second(path);
  EXPECT_TRUE(first.MadeHere());
  EXPECT_FALSE(second.MadeHere());
  ThreadPool pool(1);
  SeriesAssembly assembly(path, this->Plan());
  EXPECT_THROW(assembly.Finish(), Error);
  for (const int group : { 0, 2 })
  {
    assembly.Add(
      group, EncodeGroup(this->Plan(), this->Options, group == 0 ? first : second,
               { group, this->TimesOf(group), this->StepsOf(group), this->Before(group) }, nullptr,
               pool, nullptr));
  }
  EXPECT_THROW(assembly.Finish(), Error);
  second.RemoveOwn(assembly.SegmentsInFile());
  first.RemoveOwn(assembly.SegmentsInFile());
  EXPECT_EQ(FilesOf(path).size(), 2u);
  EXPECT_EQ(SeriesFile::Open(path)->Index().Steps(), Interval);
  assembly.Withdraw();
  first.RemoveOwn();
  EXPECT_TRUE(folder.Empty());
}

TEST(GroupMessage, KeepsEveryBit)
{
  EncodedGroup group;
  group.Segment = { "0123456789abcdef-000002.seg", 16, 3, 1234567890123u, 5u, ~std::uint64_t{ 0 } };
  group.Times = { -0.0, 1e-310, 3.0 };
  group.Measured.resize(2);
  group.Measured[0].resize(3);
  group.Measured[1].resize(1);
  group.Measured[0][2].Range = { -0.0, 7.25 };
  group.Measured[0][2].SumSquaredError = std::numeric_limits<double>::infinity();
  group.Measured[1][0].MeasuredMaxError = 0.1;
  group.Measured[1][0].MeasuredMaxErrorTransformed = 0.2;
  group.Measured[1][0].FiniteCount = 17;
  group.Measured[1][0].StepRmse = { 0.25, 0.0 };
  group.Measured[1][0].NonFiniteCount = 18;
  group.Magnitudes = { { {}, { 1.0, 2.0 } }, {} };
  group.Statistics.ChainMost = 9;
  group.Statistics.RepeatedBytes = 11;
  group.Statistics.PayloadBytes = 10;
  group.BytesIn = 11;

  const Bytes message = PackGroup(group);
  const EncodedGroup copy = UnpackGroup(message);
  EXPECT_EQ(PackGroup(copy), message);
  EXPECT_EQ(copy.Segment.File, group.Segment.File);
  EXPECT_EQ(copy.Segment.FirstStep, 16);
  EXPECT_EQ(copy.Segment.HashHigh, ~std::uint64_t{ 0 });
  EXPECT_TRUE(std::signbit(copy.Times[0]));
  EXPECT_EQ(copy.Times, group.Times);
  EXPECT_TRUE(std::signbit(copy.Measured[0][2].Range.Low));
  EXPECT_TRUE(std::isinf(copy.Measured[0][2].SumSquaredError));
  EXPECT_EQ(copy.Measured[1][0].MeasuredMaxError, 0.1);
  EXPECT_EQ(copy.Measured[1][0].MeasuredMaxErrorTransformed, 0.2);
  EXPECT_EQ(copy.Measured[1][0].FiniteCount, 17);
  EXPECT_EQ(copy.Measured[1][0].StepRmse, group.Measured[1][0].StepRmse);
  EXPECT_EQ(copy.Measured[1][0].NonFiniteCount, 18);
  EXPECT_TRUE(copy.Magnitudes[0][0].Empty());
  EXPECT_EQ(copy.Magnitudes[0][1].High, 2.0);
  EXPECT_EQ(copy.Statistics.ChainMost, 9);
  EXPECT_EQ(copy.Statistics.RepeatedBytes, 11u);
  EXPECT_EQ(copy.Statistics.PayloadBytes, 10u);
  EXPECT_EQ(copy.BytesIn, 11u);

  for (std::size_t length = 0; length < message.size(); ++length)
  {
    EXPECT_THROW(
      UnpackGroup(Bytes(message.begin(), message.begin() + static_cast<long>(length))), Error);
  }
  Bytes longer = message;
  longer.push_back(0);
  EXPECT_THROW(UnpackGroup(longer), Error);
}

} // namespace
} // namespace banyan::testing
