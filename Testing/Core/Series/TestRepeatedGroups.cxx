// SPDX-License-Identifier: BSD-3-Clause
/// Groups of equal content, which are stored once over the whole series.
#include "Series/ContainerTesting.h"

#include "Series/Decode/GroupReader.h"
#include "Series/Format/AtomicFile.h"
#include "Series/Format/IndexText.h"

#include <fstream>
#include <functional>
#include <map>
#include <set>

namespace banyan::testing
{
namespace
{

namespace fs = std::filesystem;

constexpr int Interval = 4;
constexpr int Period = 2 * Interval;

EncodeOptions Options()
{
  EncodeOptions options;
  options.KeyframeInterval = Interval;
  options.BrickCells = 16;
  return options;
}

/// Steps that come again after a period.
Steps<float> LoopingSteps(int count)
{
  const auto once = SmallSteps(Period);
  Steps<float> steps;
  for (int s = 0; s < count; ++s)
  {
    steps.push_back(once[static_cast<std::size_t>(s % Period)]);
  }
  return steps;
}

std::vector<std::string> FilesOf(const SeriesIndex& index)
{
  std::vector<std::string> files;
  for (const SegmentIndex& segment : index.Segments)
  {
    files.push_back(segment.File);
  }
  return files;
}

std::set<std::string> FilesIn(const std::string& folder)
{
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder))
  {
    files.insert(entry.path().filename().string());
  }
  return files;
}

std::uint64_t BytesIn(const std::string& folder)
{
  std::uint64_t bytes = 0;
  for (const auto& entry : fs::directory_iterator(folder))
  {
    bytes += entry.file_size();
  }
  return bytes;
}

void ExpectWithin(const Steps<float>& steps, const SeriesFile& file)
{
  for (std::size_t s = steps.size(); s-- > 0;)
  {
    EXPECT_TRUE(WithinBound(steps[s], ReadAll<float>(file, { static_cast<int>(s), 0, 0, 0 }),
      file.Index().Arrays[0].Components[0].ErrorBoundAbsolute))
      << "step " << s;
  }
}

/// What bricks of equal identity decode to, over all steps and levels.
class IdentityChecker
{
public:
  void Check(const SeriesFile& file)
  {
    for (int s = 0; s < file.Index().Steps(); ++s)
    {
      for (int level = 0; level < file.Index().Levels; ++level)
      {
        const FieldKey field{ s, 0, 0, level };
        const auto nodes = file.Nodes(field);
        for (std::size_t brick = 0; brick < nodes->size(); ++brick)
        {
          const Box samples = file.Layout(level).SamplesOf(static_cast<std::int64_t>(brick));
          std::vector<float> values(static_cast<std::size_t>(samples.Count()));
          file.DecodeBrick(field, static_cast<std::int64_t>(brick), values.data());
          const PayloadIdentity& identity = (*nodes)[brick].Identity;
          const auto [known, isNew] =
            this->Known.try_emplace({ identity.Low, identity.High }, values);
          this->Equal += isNew ? 0 : 1;
          EXPECT_EQ(known->second, values) << "step " << s << ", level " << level << ", " << brick;
        }
      }
    }
  }

  int Equal = 0; ///< bricks whose identity was known

private:
  std::map<std::pair<std::uint64_t, std::uint64_t>, std::vector<float>> Known;
};

TEST(RepeatedGroups, OfALoopAreStoredOnce)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const auto steps = LoopingSteps(4 * Period + 1);
  const SeriesIndex index = Encode(path, Small, steps, Options());
  // The first group refers to nothing before it, all others do, and the last one is a key frame.
  const auto files = FilesOf(index);
  ASSERT_EQ(files.size(), 9u);
  EXPECT_EQ(std::set<std::string>(files.begin(), files.end()).size(), 4u);
  for (const std::size_t group : { 4u, 6u })
  {
    EXPECT_EQ(files[group], files[2]);
    EXPECT_EQ(files[group + 1], files[1]);
  }
  EXPECT_EQ(files[3], files[1]);
  EXPECT_EQ(FilesIn(path + ".d"), std::set<std::string>(files.begin(), files.end()));

  const EncodeStatistics& statistics = index.Statistics;
  EXPECT_EQ(statistics.RepeatedSegments, 5);
  EXPECT_EQ(statistics.RepeatedBytes, 3 * index.Segments[1].Bytes + 2 * index.Segments[2].Bytes);
  EXPECT_EQ(statistics.PayloadBytes + statistics.TableBytes, BytesIn(path + ".d"));

  const auto file = SeriesFile::Open(path);
  EXPECT_EQ(file->Index().Statistics.RepeatedSegments, 5);
  EXPECT_EQ(file->Index().Statistics.RepeatedBytes, statistics.RepeatedBytes);
  ExpectWithin(steps, *file);
  // From the second period on bricks are known to be those of the period before.
  for (int level = 0; level < index.Levels; ++level)
  {
    for (int s = Period; s + Period < 4 * Period; ++s)
    {
      const auto now = file->Nodes({ s, 0, 0, level });
      const auto then = file->Nodes({ s + Period, 0, 0, level });
      for (std::size_t brick = 0; brick < now->size(); ++brick)
      {
        EXPECT_EQ((*now)[brick].Identity, (*then)[brick].Identity) << "step " << s;
      }
    }
  }
  IdentityChecker checker;
  checker.Check(*file);
  EXPECT_GT(checker.Equal, 0);
}

TEST(RepeatedGroups, OfAFieldAtRestAreStoredOnce)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  // It moves, rests, and moves again.
  auto steps = SmallSteps(8 * Interval);
  for (int s = 2 * Interval; s < 6 * Interval; ++s)
  {
    steps[static_cast<std::size_t>(s)] = steps[2 * Interval - 1];
  }
  const auto files = FilesOf(Encode(path, Small, steps, Options()));
  EXPECT_EQ(std::set<std::string>(files.begin(), files.end()).size(), 5u);
  for (std::size_t group = 3; group < 6; ++group)
  {
    EXPECT_EQ(files[group], files[2]);
  }
  const auto file = SeriesFile::Open(path);
  ExpectWithin(steps, *file);
  IdentityChecker().Check(*file);
}

/// A segment may be named behind another one than it was encoded behind: what it says of steps that
/// refer to it is then something else, which drawing must not take for the same.
TEST(RepeatedGroups, BehindOthersHaveIdentitiesOfTheirOwn)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  SeriesIndex index = Encode(path, Small, SmallSteps(4 * Interval), Options());
  for (std::size_t group = 1; group < 4; ++group)
  {
    GroupReader reader(path + ".d", index.Segments[group], 1);
    const Bytes head = reader.Section(reader.HeadSection(0));
    ASSERT_TRUE(group::UnpackHead(head.data(), head.size()).Open);
  }
  const int first = index.Segments[3].FirstStep;
  index.Segments[3] = index.Segments[1];
  index.Segments[3].FirstStep = first;
  WriteFileAtomically(path, IndexToText(index));
  const auto file = SeriesFile::Open(path);
  int different = 0;
  for (int s = 0; s < Interval; ++s)
  {
    different += ReadAll<float>(*file, { Interval + s, 0, 0, 0 }) ==
                     ReadAll<float>(*file, { 3 * Interval + s, 0, 0, 0 })
                   ? 0
                   : 1;
  }
  EXPECT_GT(different, 0) << "nothing refers to the step before: this is no test";
  IdentityChecker().Check(*file);
}

TEST(RepeatedGroups, AreAllDamagedWithTheirSegment)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const auto steps = LoopingSteps(3 * Period);
  const SeriesIndex index = Encode(path, Small, steps, Options());
  ASSERT_EQ(index.Segments[3].File, index.Segments[5].File);
  const std::string segment = path + ".d/" + index.Segments[3].File;
  std::fstream(segment, std::ios::in | std::ios::out | std::ios::binary).seekp(100).put('\x5a');
  const auto file = SeriesFile::Open(path);
  for (const int group : { 1, 3, 5 })
  {
    ExpectError(
      [&] {
        (void)ReadAll<float>(*file, { group * Interval, 0, 0, 0 });
      },
      "Payloads of the segment are damaged");
  }
  (void)ReadAll<float>(*file, { 0, 0, 0, 0 });
  fs::remove(segment);
  ExpectError([&] { (void)SeriesFile::Open(path); }, index.Segments[3].File);
}

TEST(RepeatedGroups, HaveTheSameContentInTheIndex)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const SeriesIndex good = Encode(path, Small, LoopingSteps(3 * Period), Options());
  ASSERT_EQ(good.Segments[3].File, good.Segments[5].File);
  EXPECT_NO_THROW((void)IndexFromText(IndexToText(good), path));
  const std::vector<std::function<void(SegmentIndex&)>> changes{ [](SegmentIndex& s) { ++s.Bytes; },
    [](SegmentIndex& s) { ++s.HashLow; }, [](SegmentIndex& s) { ++s.HashHigh; } };
  for (const auto& change : changes)
  {
    SeriesIndex bad = good;
    change(bad.Segments[5]);
    ExpectError([&] { (void)IndexToText(bad); }, "not the same content");
  }
  SeriesIndex shorter = good;
  shorter.Segments[5].Steps -= 1;
  shorter.Times.pop_back();
  shorter.Arrays[0].Components[0].StepRmse.pop_back();
  ExpectError([&] { (void)IndexToText(shorter); }, "not the same content");
}

TEST(RepeatedGroups, OfTheSeriesThatIsReplacedStayWithIt)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const auto steps = LoopingSteps(3 * Period);
  Encode(path, Small, steps, Options());
  const auto before = FilesIn(path + ".d");
  {
    ThreadPool pool(2);
    SeriesEncoder encoder(path, Small, { Describe(steps) }, Options(), pool);
    for (int s = 0; s < 2 * Period; ++s)
    {
      encoder.AddStep(s, { { steps[static_cast<std::size_t>(s)].data() } });
    }
  } // given up
  EXPECT_EQ(FilesIn(path + ".d"), before);
  ExpectWithin(steps, *SeriesFile::Open(path));
  Encode(path, Small, steps, Options());
  EXPECT_EQ(FilesIn(path + ".d"), before);
  ExpectWithin(steps, *SeriesFile::Open(path));
}

} // namespace
} // namespace banyan::testing
