// SPDX-License-Identifier: BSD-3-Clause
// Who may save a series, and what a save removes.
#include "Series/ContainerTesting.h"
#include "Series/SeriesTesting.h"

#include "Series/Encode/SeriesLock.h"

#include <atomic>
#include <csignal>
#include <fstream>
#include <memory>
#include <set>
#include <thread>

#include <sched.h>
#include <sys/mount.h>
#include <sys/wait.h>
#include <unistd.h>

namespace banyan::testing
{
namespace
{

namespace fs = std::filesystem;

const Grid Tiny = GridOf(11, 9, 7);

Steps<float> TinySteps(double shift)
{
  return Sample<float>(
    Tiny, 4, [shift](int x, int y, int z, int s) { return shift + Wavy<float>(x, y, z, s); });
}

EncodeOptions OneStepEach()
{
  EncodeOptions options;
  options.KeyframeInterval = 1;
  return options;
}

std::set<std::string> NamesIn(const std::string& folder)
{
  std::set<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder))
  {
    names.insert(entry.path().filename().string());
  }
  return names;
}

/// All of the series is there, and nothing else.
void ExpectExactly(const std::string& path, const Steps<float>& steps)
{
  const auto file = SeriesFile::Open(path);
  ASSERT_EQ(file->Index().Steps(), static_cast<int>(steps.size()));
  std::set<std::string> named;
  for (const SegmentIndex& segment : file->Index().Segments)
  {
    named.insert(segment.File);
  }
  EXPECT_EQ(NamesIn(path + ".d"), named);
  for (std::size_t s = 0; s < steps.size(); ++s)
  {
    EXPECT_TRUE(WithinBound(steps[s], ReadAll<float>(*file, { static_cast<int>(s), 0, 0, 0 }),
      file->Index().Arrays[0].Components[0].ErrorBoundAbsolute));
  }
}

constexpr int Refused = 3, Strange = 4;

/// Starts a process that saves. @param killedAt the step at which it kills itself; -1: it does not
pid_t StartSaver(const std::string& path, double shift, int microseconds, int killedAt)
{
  const pid_t child = fork();
  if (child != 0)
  {
    return child;
  }
  usleep(static_cast<useconds_t>(microseconds));
  try
  {
    const auto steps = TinySteps(shift);
    ThreadPool pool(1);
    SeriesEncoder encoder(path, Tiny, { Describe(steps) }, OneStepEach(), pool);
    for (int s = 0; s < 4; ++s)
    {
      if (s == killedAt)
      {
        encoder.SetProgress([](double) { return kill(getpid(), SIGKILL) == 0; });
      }
      encoder.AddStep(s, { { steps[static_cast<std::size_t>(s)].data() } });
    }
    encoder.Finish();
    _exit(0);
  }
  catch (const Error& error)
  {
    const std::string said = error.what();
    const bool asItShould = said.find("Another save of this series is under way (process ") == 0 &&
                            said.find(", since 20") != std::string::npos;
    _exit(asItShould ? Refused : Strange);
  }
}

int StatusOf(pid_t child)
{
  int status = 0;
  waitpid(child, &status, 0);
  return status;
}

TEST(SeriesLock, OfManySaversAtOnceNoneSpoilsAnother)
{
  std::mt19937 random(1);
  int saved = 0, refused = 0, killed = 0;
  // In memory where that can be: to bring files to a disk takes longer than all the rest.
  if (access("/dev/shm", W_OK) == 0)
  {
    (void)setenv("TMPDIR", "/dev/shm", 1);
  }
  for (int round = 0; round < 100; ++round)
  {
    const TemporaryFolder folder;
    const std::string path = folder / "s.banyan";
    const bool replaces = round % 2 == 0;
    if (replaces)
    {
      Encode(path, Tiny, TinySteps(1000), OneStepEach(), 1);
    }
    std::vector<pid_t> savers;
    for (int k = 0; k < 4; ++k)
    {
      const int killedAt = random() % 4 == 0 ? static_cast<int>(random() % 4) : -1;
      savers.push_back(StartSaver(path, 10 * k, static_cast<int>(random() % 15000), killedAt));
    }
    std::vector<int> succeeded;
    for (int k = 0; k < 4; ++k)
    {
      const int status = StatusOf(savers[static_cast<std::size_t>(k)]);
      ASSERT_FALSE(WIFEXITED(status) && WEXITSTATUS(status) == Strange);
      killed += WIFSIGNALED(status) ? 1 : 0;
      refused += WIFEXITED(status) && WEXITSTATUS(status) == Refused ? 1 : 0;
      if (WIFEXITED(status) && WEXITSTATUS(status) == 0)
      {
        succeeded.push_back(k);
      }
    }
    saved += static_cast<int>(succeeded.size());
    if (!succeeded.empty() || replaces)
    {
      // It opens, and every segment that it names is there: of one that succeeded, or as it was
      // before.
      const auto file = SeriesFile::Open(path);
      const auto values = ReadAll<float>(*file, { 3, 0, 0, 0 });
      const double bound = file->Index().Arrays[0].Components[0].ErrorBoundAbsolute;
      bool known = succeeded.empty() && WithinBound(TinySteps(1000)[3], values, bound);
      for (const int k : succeeded)
      {
        known = known || WithinBound(TinySteps(10 * k)[3], values, bound);
      }
      EXPECT_TRUE(known) << "round " << round;
    }
    // Leftovers of savers that were killed are no hindrance, and go.
    Encode(path, Tiny, TinySteps(7), OneStepEach(), 1);
    ExpectExactly(path, TinySteps(7));
  }
  EXPECT_GT(saved, 20);
  EXPECT_GT(refused, 0);
  EXPECT_GT(killed, 0);
}

TEST(SeriesLock, OfOneThatIsKilledIsFree)
{
  for (const bool replaces : { false, true })
  {
    const TemporaryFolder folder;
    const std::string path = folder / "s.banyan";
    const std::string foreign = path + ".d/0123456789abcdef-0123456789abcdef.seg";
    if (replaces)
    {
      Encode(path, Tiny, TinySteps(1), OneStepEach());
    }
    fs::create_directory(path + ".d");
    std::ofstream(foreign) << "of somebody else";
    std::ofstream(path + ".d/notes.txt") << "mine";
    const auto before = NamesIn(path + ".d");
    ASSERT_TRUE(WIFSIGNALED(StatusOf(StartSaver(path, 2, 0, 3))));
    EXPECT_GT(NamesIn(path + ".d").size(), before.size() + 3) << "segments, and who wrote them";
    if (replaces)
    {
      EXPECT_EQ(SeriesFile::Open(path)->Index().Steps(), 4);
    }
    Encode(path, Tiny, TinySteps(3), OneStepEach());
    EXPECT_TRUE(fs::remove(foreign));
    EXPECT_TRUE(fs::remove(path + ".d/notes.txt"));
    ExpectExactly(path, TinySteps(3));
  }
}

TEST(SeriesLock, IsNotThatOfProcessesThatItsHolderStarted)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  int ends[2] = {};
  ASSERT_EQ(pipe(ends), 0);
  const pid_t holder = fork();
  if (holder == 0)
  {
    const SeriesLock lock(path);
    const pid_t started = fork();
    if (started == 0)
    {
      pause(); // and keeps all files open
    }
    (void)!write(ends[1], &started, sizeof(started));
    pause();
  }
  pid_t started = 0;
  ASSERT_EQ(read(ends[0], &started, sizeof(started)), static_cast<ssize_t>(sizeof(started)));
  ExpectError([&] { const SeriesLock lock(path); }, "process " + std::to_string(holder) + " on ");
  kill(holder, SIGKILL);
  StatusOf(holder);
  EXPECT_NO_THROW(Encode(path, Tiny, TinySteps(0), OneStepEach()));
  kill(started, SIGKILL);
  close(ends[0]);
  close(ends[1]);
  ExpectExactly(path, TinySteps(0));
}

TEST(SeriesLock, ACopyInAnotherProcessEndsNothing)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  const auto steps = TinySteps(0);
  ThreadPool pool(1);
  auto encoder = std::make_unique<SeriesEncoder>(
    path, Tiny, std::vector<ArrayDescription>{ Describe(steps) }, OneStepEach(), pool);
  encoder->AddStep(0, { { steps[0].data() } });
  const pid_t child = fork();
  if (child == 0)
  {
    encoder.reset();
    _exit(0);
  }
  EXPECT_EQ(StatusOf(child), 0);
  EXPECT_EQ(WEXITSTATUS(StatusOf(StartSaver(path, 1, 0, -1))), Refused);
  ExpectError([&] { Encode(path, Tiny, steps, OneStepEach()); }, "under way");
  for (int s = 1; s < 4; ++s)
  {
    encoder->AddStep(s, { { steps[static_cast<std::size_t>(s)].data() } });
  }
  encoder->Finish();
  EXPECT_EQ(WEXITSTATUS(StatusOf(StartSaver(path, 1, 0, -1))), 0) << "it is finished";
  ExpectExactly(path, TinySteps(1));
}

TEST(SeriesLock, HoldsBetweenThreads)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  std::atomic<int> inside{ 0 }, taken{ 0 }, refused{ 0 };
  std::vector<std::thread> threads;
  for (int t = 0; t < 6; ++t)
  {
    threads.emplace_back(
      [&]
      {
        for (int i = 0; i < 100; ++i)
        {
          try
          {
            const SeriesLock lock(path);
            EXPECT_EQ(++inside, 1);
            ++taken;
            std::this_thread::sleep_for(std::chrono::microseconds(50));
            --inside;
          }
          catch (const Error& error)
          {
            EXPECT_NE(std::string(error.what()).find("under way"), std::string::npos)
              << error.what();
            ++refused;
            std::this_thread::sleep_for(std::chrono::microseconds(20));
          }
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_GT(taken, 5); // how often threads meet is the system's affair
  EXPECT_TRUE(folder.Empty());
}

TEST(SeriesLock, RefusesAtOnceWhatCannotBeWritten)
{
  const TemporaryFolder folder;
  const auto steps = TinySteps(0);
  const auto encode = [&](const std::string& name) { Encode(folder / name, Tiny, steps, {}); };
  fs::create_directory(folder / "folder.banyan");
  ExpectError([&] { encode("folder.banyan"); }, "a folder has its name");
  ASSERT_EQ(mkfifo((folder / "pipe.banyan").c_str(), 0600), 0);
  ExpectError([&] { encode("pipe.banyan"); }, "something other than a file");
  std::ofstream(folder / "file.banyan.d") << "a file";
  ExpectError([&] { encode("file.banyan"); }, "file.banyan.d");
  ExpectError([&] { encode("missing/s.banyan"); }, "No such file or directory");
  fs::create_symlink("nowhere", folder / "lost.banyan.d");
  ExpectError([&] { encode("lost.banyan"); }, "a link that leads nowhere");
  // Not only when all is encoded, and somebody waits for the index.
  const auto take = [&](const std::string& name) { const SeriesLock lock(folder / name); };
  ExpectError([&] { take(std::string(251, 'x')); }, "too long");
  fs::create_directory(folder / "full.banyan.part");
  ExpectError([&] { take("full.banyan"); }, "full.banyan.part");
  fs::remove(folder / "full.banyan.part");
  // A download of somebody's stays, and a leftover of a killed save goes.
  std::ofstream(folder / "full.banyan.part") << "a download";
  ExpectError([&] { take("full.banyan"); }, "full.banyan.part");
  EXPECT_EQ(fs::file_size(folder / "full.banyan.part"), 10u);
  std::ofstream(folder / "full.banyan.part") << "BanyanSeries 1 0123";
  take("full.banyan");
  fs::create_directories(folder / "locked.banyan.d/saving.lock");
  ExpectError([&] { take("locked.banyan"); }, "locked.banyan.d/saving.lock");
  fs::remove(folder / "locked.banyan.d/saving.lock");
  fs::create_symlink("saving.lock", folder / "locked.banyan.d/saving.lock");
  ExpectError([&] { take("locked.banyan"); }, "locked.banyan.d/saving.lock");
  fs::remove_all(folder / "locked.banyan.d");
  EXPECT_EQ(NamesIn(folder.Path()),
    (std::set<std::string>{ "folder.banyan", "pipe.banyan", "file.banyan.d", "lost.banyan.d" }));
}

/// A disk of so many kilobytes, in a process of its own.
int WithSmallDisk(const std::string& folder, int kilobytes, const std::function<int()>& body)
{
  const pid_t child = fork();
  if (child == 0)
  {
    const std::string size = "size=" + std::to_string(kilobytes) + "k";
    if (unshare(CLONE_NEWNS) != 0 ||
        mount(nullptr, "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
        mount("tmpfs", folder.c_str(), "tmpfs", 0, size.c_str()) != 0)
    {
      _exit(77);
    }
    _exit(body());
  }
  return WEXITSTATUS(StatusOf(child));
}

TEST(SeriesLock, AFullDiskLosesNothing)
{
  std::mt19937 random(2);
  const Grid grid = GridOf(64, 64, 16);
  const auto noise = Sample<float>(grid, 1, [&](int, int, int, int) { return random() % 65536; });
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  for (const int kilobytes : { 40, 48, 60, 80, 100 })
  {
    const int status = WithSmallDisk(folder.Path(), kilobytes,
      [&]
      {
        Encode(path, Tiny, TinySteps(5), OneStepEach(), 1);
        for (const std::string& name : { path, folder / "other.banyan" })
        {
          try
          {
            Encode(name, grid, noise, {}, 1);
            return 2;
          }
          catch (const Error& error)
          {
            const std::string said = error.what();
            if (said.find("No space left") == std::string::npos ||
                said.find(name) == std::string::npos)
            {
              return 3;
            }
          }
        }
        ExpectExactly(path, TinySteps(5));
        return ::testing::Test::HasFailure() || NamesIn(folder.Path()).size() != 2 ? 4 : 0;
      });
    if (status == 77)
    {
      GTEST_SKIP() << "disks can be mounted by the administrator only";
    }
    EXPECT_EQ(status, 0) << kilobytes;
  }
}

} // namespace
} // namespace banyan::testing
