// SPDX-License-Identifier: BSD-3-Clause
// Whatever becomes of the files of a series while it is open, values are never wrong.
#include "Series/ContainerTesting.h"
#include "Series/SeriesTesting.h"

#include "Series/Decode/CacheContext.h"
#include "Series/Format/SegmentFile.h"

#include <atomic>
#include <fstream>
#include <limits>
#include <thread>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace banyan::testing
{
namespace
{

namespace fs = std::filesystem;

/// Nothing of the files is in memory.
void ForgetAll()
{
  CacheContext::Process()->Blocks().ForgetAll();
  CacheContext::Process()->Payloads().Shrink(0);
}

void Flip(const std::string& path, std::uint64_t place, int bit)
{
  std::fstream file(path, std::ios::in | std::ios::out | std::ios::binary);
  file.seekg(static_cast<std::streamoff>(place));
  const int old = file.get();
  file.seekp(static_cast<std::streamoff>(place));
  file.put(static_cast<char>(old ^ 1 << bit));
}

std::vector<std::string> SegmentsOf(const std::string& path)
{
  std::vector<std::string> files;
  for (const auto& entry : fs::directory_iterator(path + ".d"))
  {
    files.push_back(entry.path().string());
  }
  std::sort(files.begin(), files.end());
  return files;
}

template <class T>
Steps<T> ReadSteps(const SeriesFile& file, int level)
{
  Steps<T> steps;
  for (int s = 0; s < file.Index().Steps(); ++s)
  {
    steps.push_back(ReadAll<T>(file, { s, 0, 0, level }));
  }
  return steps;
}

template <class T>
bool Same(const std::vector<T>& a, const std::vector<T>& b)
{
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// How often reading gave the right values, and how often a sentence that names a file.
struct Outcomes
{
  int Right = 0, Refused = 0;

  template <class T>
  void Read(const SeriesFile& file, const Steps<T>& right, int step, int level)
  {
    try
    {
      const bool same =
        Same(ReadAll<T>(file, { step, 0, 0, level }), right[static_cast<std::size_t>(step)]);
      EXPECT_TRUE(same) << "other values, and nothing said";
      ++this->Right;
    }
    catch (const Error& error)
    {
      EXPECT_NE(std::string(error.what()).find(".banyan.d/"), std::string::npos) << error.what();
      ++this->Refused;
    }
  }
};

template <class T>
class FilesWhileOpen : public ::testing::Test
{
protected:
  FilesWhileOpen()
  {
    auto steps = Sample<T>(Small, 7, Wavy<T>);
    if (std::numeric_limits<T>::has_quiet_NaN)
    {
      for (auto& step : steps)
      {
        step[100] = std::numeric_limits<T>::quiet_NaN(); // a payload of exceptions
        step[4000] = std::numeric_limits<T>::infinity();
      }
    }
    EncodeOptions options;
    options.KeyframeInterval = 3;
    Encode(this->Path, Small, steps, options);
    this->File = SeriesFile::Open(this->Path);
    for (int level = 0; level < 2; ++level)
    {
      this->Right.push_back(ReadSteps<T>(*this->File, level));
    }
  }

  const TemporaryFolder Folder;
  const std::string Path = Folder / "s.banyan";
  std::shared_ptr<SeriesFile> File;
  std::vector<Steps<T>> Right; ///< by level
};

using Types = ::testing::Types<float, double, std::int16_t>;
TYPED_TEST_SUITE(FilesWhileOpen, Types);

TYPED_TEST(FilesWhileOpen, BitsThatFlipAreNeverWrongValues)
{
  std::mt19937 random(1);
  const auto files = SegmentsOf(this->Path);
  Outcomes outcomes;
  for (int i = 0; i < 300; ++i)
  {
    const std::string& file = files[random() % files.size()];
    const std::uint64_t place = random() % fs::file_size(file);
    const int bit = static_cast<int>(random() % 8);
    const int step = static_cast<int>(random() % 7);
    const int level = static_cast<int>(random() % 2);
    Flip(file, place, bit);
    if (i % 4 != 0)
    {
      ForgetAll();
    }
    outcomes.Read<TypeParam>(*this->File, this->Right[level], step, level);
    Flip(file, place, bit);
    EXPECT_TRUE(Same(ReadAll<TypeParam>(*this->File, { step, 0, 0, level }),
      this->Right[level][static_cast<std::size_t>(step)]))
      << "good again, and not read";
  }
  EXPECT_GT(outcomes.Right, 20);
  EXPECT_GT(outcomes.Refused, 20);
}

TYPED_TEST(FilesWhileOpen, AFileThatIsCutShortIsASentence)
{
  std::mt19937 random(2);
  const auto files = SegmentsOf(this->Path);
  Outcomes outcomes;
  for (int i = 0; i < 100; ++i)
  {
    const std::string& file = files[random() % files.size()];
    const std::string whole = file + ".whole";
    fs::copy_file(file, whole);
    fs::resize_file(file, random() % fs::file_size(file)); // the same file: it is open
    ForgetAll();
    const int level = static_cast<int>(random() % 2);
    outcomes.Read<TypeParam>(
      *this->File, this->Right[level], static_cast<int>(random() % 7), level);
    fs::copy_file(whole, file, fs::copy_options::overwrite_existing);
    fs::remove(whole);
  }
  EXPECT_GT(outcomes.Right, 5);
  EXPECT_GT(outcomes.Refused, 20);
  for (int step = 0; step < 7; ++step)
  {
    outcomes.Read<TypeParam>(*this->File, this->Right[0], step, 0);
  }
}

TYPED_TEST(FilesWhileOpen, FilesThatAreReplacedOrGoneAreReadOn)
{
  for (const std::string& file : SegmentsOf(this->Path))
  {
    fs::remove(file);
    std::ofstream(file) << "something else";
  }
  ForgetAll();
  EXPECT_TRUE(Same(ReadAll<TypeParam>(*this->File, { 6, 0, 0, 0 }), this->Right[0][6]));
  fs::remove_all(this->Path + ".d");
  fs::remove(this->Path);
  ForgetAll();
  for (std::size_t step = 0; step < 7; ++step)
  {
    EXPECT_TRUE(Same(
      ReadAll<TypeParam>(*this->File, { static_cast<int>(step), 0, 0, 0 }), this->Right[0][step]));
  }
}

TYPED_TEST(FilesWhileOpen, TakeNoMoreMemoryThanTheyMay)
{
  const auto some = std::make_shared<CacheContext>(4 << 20);
  (void)ReadSteps<TypeParam>(*SeriesFile::Open(this->Path, some), 0);
  const auto file = SeriesFile::Open(this->Path, some);
  (void)ReadSteps<TypeParam>(*file, 0);
  EXPECT_GT(some->Payloads().Bytes(), 0u);
  EXPECT_LE(some->Payloads().Bytes(), some->Payloads().BudgetBytes());
  const auto none = std::make_shared<CacheContext>(0);
  const auto other = SeriesFile::Open(this->Path, none);
  (void)ReadSteps<TypeParam>(*other, 0);
  EXPECT_EQ(none->Payloads().Bytes(), 0u);
}

TYPED_TEST(FilesWhileOpen, MayBeForgottenWhileThreadsRead)
{
  std::atomic<int> wrong{ 0 }, running{ 3 };
  std::vector<std::thread> threads;
  for (unsigned t = 0; t < 3; ++t)
  {
    threads.emplace_back(
      [&, t]
      {
        std::mt19937 random(t);
        for (int i = 0; i < 20; ++i)
        {
          const std::size_t step = random() % 7;
          wrong += Same(ReadAll<TypeParam>(*this->File, { static_cast<int>(step), 0, 0, 0 }),
                     this->Right[0][step])
                     ? 0
                     : 1;
        }
        --running;
      });
  }
  while (running > 0)
  {
    ForgetAll();
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
}

/// The answer of a process that may open only a few files.
std::string SaidWithFewFiles(const std::string& path, bool replaced)
{
  int ends[2] = {};
  EXPECT_EQ(pipe(ends), 0);
  const pid_t child = fork();
  if (child == 0)
  {
    const struct rlimit few = { 40, 40 };
    (void)setrlimit(RLIMIT_NOFILE, &few);
    std::string said;
    try
    {
      const auto file = SeriesFile::Open(path);
      if (replaced)
      {
        fs::remove_all(path + ".d");
      }
      const std::vector<float> first = ReadAll<float>(*file, { 0, 0, 0, 0 });
      for (int turn = 0; turn < 2; ++turn)
      {
        (void)ReadSteps<float>(*file, 0);
        ForgetAll();
      }
      said = Same(first, ReadAll<float>(*file, { 0, 0, 0, 0 })) ? "right" : "wrong";
    }
    catch (const std::exception& error)
    {
      said = error.what();
    }
    (void)!write(ends[1], said.data(), said.size());
    _exit(0);
  }
  close(ends[1]);
  std::string said(4096, '\0');
  const ssize_t got = read(ends[0], said.data(), said.size());
  close(ends[0]);
  said.resize(static_cast<std::size_t>(std::max<ssize_t>(got, 0)));
  int status = 1;
  waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  return said;
}

TEST(FilesWhileOpen, MoreThanTheProcessMayOpen)
{
  const TemporaryFolder folder;
  const std::string path = folder / "s.banyan";
  EncodeOptions options;
  options.KeyframeInterval = 1;
  Encode(path, Small, SmallSteps(60), options);
  ASSERT_EQ(SegmentsOf(path).size(), 60u);
  EXPECT_EQ(SaidWithFewFiles(path, false), "right");
  const std::string said = SaidWithFewFiles(path, true);
  EXPECT_NE(said.find("open it again"), std::string::npos) << said;
}

} // namespace
} // namespace banyan::testing
