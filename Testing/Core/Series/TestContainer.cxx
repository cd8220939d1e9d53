// SPDX-License-Identifier: BSD-3-Clause
#include "Series/ContainerTesting.h"

#include <csignal>
#include <fstream>
#include <functional>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace banyan::testing
{
namespace
{

namespace fs = std::filesystem;

void ExpectHolds(const std::string& path, const Steps<float>& steps, int count)
{
  const auto file = SeriesFile::Open(path);
  ASSERT_EQ(file->Index().Steps(), count);
  const double bound = file->Index().Arrays[0].Components[0].ErrorBoundAbsolute;
  for (int s = 0; s < count; ++s)
  {
    EXPECT_TRUE(WithinBound(
      steps[static_cast<std::size_t>(s)], ReadAll<float>(*file, { s, 0, 0, 0 }), bound));
  }
}

std::size_t FilesIn(const std::string& folder)
{
  return static_cast<std::size_t>(
    std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST(Container, GrowsSegmentBySegment)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const auto steps = SmallSteps(5);
  ThreadPool pool(2);
  SeriesEncoder encoder(path, Small, { Describe(steps) }, TwoPerSegment(), pool);
  for (int s = 0; s < 5; ++s)
  {
    encoder.AddStep(s, { { steps[static_cast<std::size_t>(s)].data() } });
    if (s == 0)
    {
      EXPECT_FALSE(fs::exists(path));
    }
    else
    {
      ExpectHolds(path, steps, (s + 1) / 2 * 2);
    }
  }
  encoder.Finish();
  ExpectHolds(path, steps, 5);
  EXPECT_EQ(FilesIn(path + ".d"), 3u);
}

TEST(Container, DestroyedWithoutFinishLeavesNothing)
{
  const TemporaryFolder folder;
  const auto steps = SmallSteps(3);
  ThreadPool pool(1);
  {
    SeriesEncoder encoder(folder / "s.banyan", Small, { Describe(steps) }, TwoPerSegment(), pool);
    for (int s = 0; s < 3; ++s)
    {
      encoder.AddStep(s, { { steps[static_cast<std::size_t>(s)].data() } });
    }
    EXPECT_FALSE(folder.Empty());
  }
  EXPECT_TRUE(folder.Empty());
}

TEST(Container, AnOldSeriesStaysUntilTheNewOneIsWhole)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const auto old = SmallSteps(4);
  const auto fresh = SmallSteps(5, 1000);
  Encode(path, Small, old, TwoPerSegment());
  const auto open = SeriesFile::Open(path);
  ThreadPool pool(1);
  {
    SeriesEncoder abandoned(path, Small, { Describe(fresh) }, TwoPerSegment(), pool);
    abandoned.AddStep(0, { { fresh[0].data() } });
    abandoned.AddStep(1, { { fresh[1].data() } });
    ExpectHolds(path, old, 4);
  }
  ExpectHolds(path, old, 4);
  EXPECT_EQ(FilesIn(path + ".d"), 2u);
  {
    SeriesEncoder encoder(path, Small, { Describe(fresh) }, TwoPerSegment(), pool);
    for (int s = 0; s < 5; ++s)
    {
      encoder.AddStep(s, { { fresh[static_cast<std::size_t>(s)].data() } });
      ExpectHolds(path, old, 4);
    }
    encoder.Finish();
  }
  ExpectHolds(path, fresh, 5);
  EXPECT_EQ(FilesIn(path + ".d"), 3u) << "segments of the old series are still there";
  // Who had the old series open goes on reading it.
  EXPECT_TRUE(WithinBound(old[3], ReadAll<float>(*open, { 3, 0, 0, 0 }),
    open->Index().Arrays[0].Components[0].ErrorBoundAbsolute));
}

TEST(Container, FilesOfOthersStay)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  fs::create_directory(path + ".d");
  std::ofstream(path + ".d/notes.txt") << "mine";
  const auto steps = SmallSteps(1);
  Encode(path, Small, steps, {});
  EXPECT_TRUE(fs::exists(path + ".d/notes.txt"));
  EXPECT_EQ(FilesIn(path + ".d"), 2u);
}

/// Runs `body` in a process of its own; returns how it ended, as waitpid says.
int InChild(const std::function<void()>& body)
{
  const pid_t child = fork();
  if (child == 0)
  {
    try
    {
      body();
    }
    catch (...)
    {
      _exit(99);
    }
    _exit(0);
  }
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(Container, AKilledWriterLeavesWhatWasIndexed)
{
  const auto steps = SmallSteps(7);
  for (const int killedAfter : { 1, 2, 3, 5, 6 })
  {
    const TemporaryFolder folder;
    const std::string path = folder / "s.banyan";
    const int status = InChild(
      [&]
      {
        ThreadPool pool(1);
        SeriesEncoder encoder(path, Small, { Describe(steps) }, TwoPerSegment(), pool);
        for (int s = 0; s < 7; ++s)
        {
          if (s == killedAfter)
          {
            // In the middle of a step: some of its payloads are written.
            encoder.SetProgress([](double) { return kill(getpid(), SIGKILL) == 0; });
          }
          encoder.AddStep(s, { { steps[static_cast<std::size_t>(s)].data() } });
        }
        encoder.Finish(); // the last group is encoded here
      });
    ASSERT_TRUE(WIFSIGNALED(status));
    const int whole = killedAfter / 2 * 2;
    if (whole == 0)
    {
      EXPECT_FALSE(fs::exists(path));
    }
    else
    {
      ExpectHolds(path, steps, whole);
    }
    // The next run clears away what was left.
    Encode(path, Small, steps, TwoPerSegment());
    ExpectHolds(path, steps, 7);
    EXPECT_EQ(FilesIn(path + ".d"), 4u);
  }
}

TEST(Container, AFullDiskIsAnErrorThatNamesTheFileAndLeavesNothing)
{
  // Noise, so that a step takes much more than the limit on the size of a file.
  std::mt19937 random(2);
  const Grid grid = GridOf(64, 64, 40);
  const auto steps = Sample<float>(grid, 1, [&](int, int, int, int) { return random() % 65536; });
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  for (const rlim_t limit : { 0, 10, 64, 1000, 50000, 150000 })
  {
    const int status = InChild(
      [&]
      {
        signal(SIGXFSZ, SIG_IGN);
        const rlimit small = { limit, limit };
        setrlimit(RLIMIT_FSIZE, &small);
        try
        {
          Encode(path, grid, steps, {}, 1);
        }
        catch (const Error& failure)
        {
          _exit(std::string(failure.what()).find("s.banyan") != std::string::npos ? 42 : 43);
        }
      });
    ASSERT_TRUE(WIFEXITED(status));
    EXPECT_EQ(WEXITSTATUS(status), 42) << "limit " << limit;
    EXPECT_TRUE(folder.Empty()) << "limit " << limit;
  }
}

TEST(Container, AFullDiskAtTheIndexLeavesNothing)
{
  // Macro voxels only: the segment is smaller than the index.
  const auto steps = Sample<float>(Small, 1, [](int, int, int, int) { return 2; });
  const TemporaryFolder folder;
  const int status = InChild(
    [&]
    {
      signal(SIGXFSZ, SIG_IGN);
      const rlimit small = { 800, 800 };
      setrlimit(RLIMIT_FSIZE, &small);
      try
      {
        Encode(folder / "s.banyan", Small, steps, {}, 1);
      }
      catch (const Error& failure)
      {
        _exit(failure.Place().File == folder / "s.banyan" ? 42 : 43);
      }
    });
  EXPECT_EQ(WEXITSTATUS(status), 42);
  EXPECT_TRUE(folder.Empty());
}

TEST(Container, AFullDiskSparesTheOldSeries)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const auto old = SmallSteps(2);
  Encode(path, Small, old, TwoPerSegment());
  const int status = InChild(
    [&]
    {
      signal(SIGXFSZ, SIG_IGN);
      const rlimit small = { 3000, 3000 };
      setrlimit(RLIMIT_FSIZE, &small);
      Encode(path, Small, SmallSteps(3, 5), TwoPerSegment(), 1);
    });
  EXPECT_EQ(WEXITSTATUS(status), 99);
  ExpectHolds(path, old, 2);
  EXPECT_EQ(FilesIn(path + ".d"), 1u);
}

TEST(Container, MissingLongAndShortSegmentsAreNoticedWhenOpening)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const SeriesIndex index = Encode(path, Small, SmallSteps(4), TwoPerSegment());
  const std::string segment = path + ".d/" + index.Segments[1].File;
  fs::resize_file(segment, index.Segments[1].Bytes - 1);
  ExpectError([&] { SeriesFile::Open(path); }, "size");
  fs::resize_file(segment, index.Segments[1].Bytes + 1);
  ExpectError([&] { SeriesFile::Open(path); }, "size");
  fs::remove(segment);
  ExpectError([&] { SeriesFile::Open(path); }, index.Segments[1].File);
  fs::create_directory(segment);
  ExpectError([&] { SeriesFile::Open(path); }, index.Segments[1].File);
  ExpectError([&] { SeriesFile::Open(folder / "nothing.banyan"); }, "nothing.banyan");
  ExpectError([&] { SeriesFile::Open(folder.Path()); }, "This is a folder");
}

TEST(Container, SegmentsOfAnotherSeriesAreNoticed)
{
  // One brick of bytes that cannot be compressed: the segments differ in nothing but values.
  const TemporaryFolder folder;
  const Grid grid = GridOf(17, 17, 17);
  EncodeOptions options;
  options.BrickCells = 16;
  options.ErrorBound = 0;
  std::mt19937 random(8);
  const auto make = [&](const std::string& name)
  {
    auto steps = Sample<std::uint8_t>(grid, 1, [&](int, int, int, int) { return random() % 256; });
    steps[0][0] = 0;
    steps[0][1] = 255;
    return Encode(folder / name, grid, steps, options).Segments[0];
  };
  const SegmentIndex mine = make("a.banyan");
  SegmentIndex other = make("b.banyan");
  while (other.Bytes != mine.Bytes)
  {
    other = make("b.banyan");
  }
  fs::copy_file(folder / ("b.banyan.d/" + other.File), folder / ("a.banyan.d/" + mine.File),
    fs::copy_options::overwrite_existing);
  const auto file = SeriesFile::Open(folder / "a.banyan");
  ExpectError([&] { (void)file->Nodes({ 0, 0, 0, 0 }); }, "not the one that the index names");
}

} // namespace
} // namespace banyan::testing
