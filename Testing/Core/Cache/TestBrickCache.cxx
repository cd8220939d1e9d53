// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Base/AvailableMemory.h"
#include "Base/CacheBudget.h"
#include "Base/Error.h"
#include "Series/Decode/CacheContext.h"

#include <atomic>
#include <fstream>
#include <thread>

#include <unistd.h>

namespace banyan::testing
{
namespace
{

/// A series of 4 x 2 x 2 bricks of 16; the bricks at x = 0 change from step to step, the upper half
/// of x = 3 is one macro voxel.
class BrickCacheTest : public ::testing::Test
{
protected:
  void SetUp() override
  {
    this->Values = Sample<float>(this->Domain, 4,
      [](int x, int y, int z, int s)
      { return x >= 48 && z >= 16 ? 1.0 : Wavy<float>(x, y, z, x < 16 ? s : 0); });
    EncodeOptions options;
    options.BrickCells = 16;
    Encode(this->Folder / "s.banyan", this->Domain, this->Values, options);
    this->File = SeriesFile::Open(this->Folder / "s.banyan");
  }

  std::vector<float> Brick(int step, std::int64_t brick) const
  {
    std::vector<float> values(
      static_cast<std::size_t>(this->File->Layout(0).SamplesOf(brick).Count()));
    this->File->DecodeBrick({ step, 0, 0, 0 }, brick, values.data());
    return values;
  }

  bool IsRight(const BrickValues& values, int step, std::int64_t brick) const
  {
    const std::vector<float> expected = this->Brick(step, brick);
    return values.Bytes.size() == expected.size() * 4 &&
           values.Samples == this->File->Layout(0).SamplesOf(brick) &&
           std::memcmp(values.Bytes.data(), expected.data(), values.Bytes.size()) == 0;
  }

  const TemporaryFolder Folder;
  const Grid Domain = GridOf(65, 33, 33);
  Steps<float> Values;
  std::shared_ptr<SeriesFile> File;
};

constexpr std::uint64_t Plenty = std::uint64_t{ 1 } << 30;

TEST_F(BrickCacheTest, DecodesOnceAndServesUnchangedBricksOfLaterSteps)
{
  BrickCache cache(Plenty);
  for (int step = 0; step < 4; ++step)
  {
    for (const std::int64_t brick : { 0, 1 })
    {
      EXPECT_TRUE(this->IsRight(*cache.Get(*this->File, { step, 0, 0, 0 }, brick), step, brick));
    }
  }
  EXPECT_EQ(cache.GetStatistics().Misses, 4u + 1u);
  EXPECT_EQ(cache.GetStatistics().Hits, 3u);
  EXPECT_EQ(cache.Get(*this->File, { 0, 0, 0, 0 }, 1), cache.Get(*this->File, { 3, 0, 0, 0 }, 1));
}

TEST_F(BrickCacheTest, CountsSecondsOfDecodingAndOfThoseWhoWaitForIt)
{
  BrickCache cache(Plenty);
  (void)cache.GetAhead(*this->File, {}, 0);
  const auto ahead = cache.GetStatistics();
  EXPECT_GT(ahead.DecodeSeconds, 0.0);
  EXPECT_EQ(ahead.WaitSeconds, 0.0);
  (void)cache.Get(*this->File, {}, 0);
  const auto held = cache.GetStatistics();
  EXPECT_EQ(held.DecodeSeconds, ahead.DecodeSeconds);
  EXPECT_EQ(held.WaitSeconds, 0.0);
  (void)cache.Get(*this->File, {}, 1);
  const auto waited = cache.GetStatistics();
  EXPECT_GT(waited.WaitSeconds, 0.0);
  EXPECT_NEAR(waited.DecodeSeconds - held.DecodeSeconds, waited.WaitSeconds, 1e-9);
}

TEST_F(BrickCacheTest, MacroVoxelsTakeNoRoomAndNoDecoding)
{
  BrickCache cache(Plenty);
  const BrickLayout layout = this->File->Layout(0);
  const std::int64_t uniform = layout.IndexOf({ 3, 1, 1 });
  ASSERT_TRUE((*this->File->Nodes({}))[static_cast<std::size_t>(uniform)].Uniform);
  const auto values = cache.Get(*this->File, {}, uniform);
  EXPECT_EQ(values->As<float>()[100],
    (*this->File->Nodes({}))[static_cast<std::size_t>(uniform)].Range.Low);
  EXPECT_EQ(cache.GetStatistics().Bytes, 0u);
  EXPECT_EQ(this->File->BricksDecoded(), 0u);
}

TEST_F(BrickCacheTest, StaysWithinItsBudgetAndEvictsTheLeastRecentlyUsed)
{
  BrickCache large(Plenty);
  (void)large.Get(*this->File, {}, 1);
  const std::uint64_t one = large.GetStatistics().Bytes;
  EXPECT_GE(one, 17u * 17 * 17 * 4);
  large.Clear();
  EXPECT_EQ(large.GetStatistics().Bytes, 0u);

  BrickCache cache(3 * one);
  EXPECT_EQ(cache.Budget(), 3 * one);
  for (const std::int64_t brick : { 0, 1, 2 })
  {
    (void)cache.Get(*this->File, {}, brick);
  }
  (void)cache.Get(*this->File, {}, 0); // makes 1 the least recently used
  (void)cache.Get(*this->File, {}, 5);
  const auto before = cache.GetStatistics();
  EXPECT_EQ(before.Evictions, 1u);
  EXPECT_EQ(before.Bytes, 3 * one);
  (void)cache.Get(*this->File, {}, 0);
  (void)cache.Get(*this->File, {}, 2);
  (void)cache.Get(*this->File, {}, 5);
  EXPECT_EQ(cache.GetStatistics().Misses, before.Misses);
  (void)cache.Get(*this->File, {}, 1);
  EXPECT_EQ(cache.GetStatistics().Misses, before.Misses + 1);
  EXPECT_LE(cache.GetStatistics().PeakBytes, 3 * one);

  cache.Reserve(static_cast<std::int64_t>(2 * one));
  EXPECT_EQ(cache.GetStatistics().Bytes, one);
  const auto held = cache.Get(*this->File, {}, 1); // the one that stayed
  cache.Reserve(static_cast<std::int64_t>(one));
  EXPECT_EQ(cache.GetStatistics().Bytes, 0u);
  EXPECT_TRUE(this->IsRight(*held, 0, 1)) << "what somebody holds outlives eviction";
  EXPECT_TRUE(this->IsRight(*cache.Get(*this->File, {}, 2), 0, 2));
  EXPECT_EQ(cache.GetStatistics().Bytes, 0u);
}

TEST_F(BrickCacheTest, ManyThreadsDecodeEachBrickOnce)
{
  BrickCache cache(Plenty);
  std::atomic<int> wrong{ 0 };
  std::vector<std::vector<float>> expected;
  for (std::int64_t b = 0; b < this->File->Layout(0).BrickCount(); ++b)
  {
    expected.push_back(this->Brick(2, b));
  }
  const std::uint64_t decodedBefore = this->File->BricksDecoded();
  std::vector<std::thread> threads;
  for (int t = 0; t < 16; ++t)
  {
    threads.emplace_back(
      [&, t]
      {
        for (std::size_t i = 0; i < expected.size(); ++i)
        {
          const std::size_t b = (i + static_cast<std::size_t>(t) / 4) % expected.size();
          const auto values = cache.Get(*this->File, { 2, 0, 0, 0 }, static_cast<std::int64_t>(b));
          wrong += std::memcmp(values->Bytes.data(), expected[b].data(), values->Bytes.size()) != 0;
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_EQ(this->File->BricksDecoded() - decodedBefore, cache.GetStatistics().Misses);
  EXPECT_LE(cache.GetStatistics().Misses, expected.size());
}

TEST_F(BrickCacheTest, SixteenThreadsReadOneFileThroughASmallCache)
{
  BrickCache cache(100000); // so that eviction happens all the time
  std::atomic<int> wrong{ 0 };
  std::vector<std::thread> threads;
  for (int t = 0; t < 16; ++t)
  {
    threads.emplace_back(
      [&, t]
      {
        std::mt19937 random(static_cast<unsigned>(t));
        for (int round = 0; round < 12; ++round)
        {
          const int step = static_cast<int>(random() % 4);
          const int x = static_cast<int>(random() % 60);
          const Box box = { { x, 0, 0 }, { x + 5, 33, 33 } };
          std::vector<float> values(static_cast<std::size_t>(box.Count()));
          ReadRegion(cache, *this->File, { step, 0, 0, 0 }, box, values.data(), 1, 0);
          const double bound = this->File->Index().Arrays[0].Components[0].ErrorBoundAbsolute;
          for (std::size_t i = 0; i < values.size(); ++i)
          {
            const float original = this->Values[static_cast<std::size_t>(step)]
                                               [i / 5 * 65 + i % 5 + static_cast<std::size_t>(x)];
            wrong +=
              std::abs(static_cast<double>(values[i]) - static_cast<double>(original)) > bound;
          }
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(wrong, 0);
  EXPECT_LE(cache.GetStatistics().PeakBytes, 100000u);
}

TEST_F(BrickCacheTest, DamageIsAnErrorForEveryoneAndIsNotKept)
{
  const std::string segment = this->Folder / ("s.banyan.d/" + this->File->Index().Segments[0].File);
  std::fstream stream(segment, std::ios::binary | std::ios::in | std::ios::out);
  stream.seekp(64);
  stream.put('\x7f'); // in the first payload, which is brick 0 of step 0
  stream.close();
  BrickCache cache(Plenty);
  std::atomic<int> errors{ 0 };
  std::vector<std::thread> threads;
  for (int t = 0; t < 8; ++t)
  {
    threads.emplace_back(
      [&]
      {
        try
        {
          (void)cache.Get(*this->File, {}, 0);
        }
        catch (const Error& failure)
        {
          errors += std::string(failure.what()).find("checksum") != std::string::npos;
        }
      });
  }
  for (std::thread& thread : threads)
  {
    thread.join();
  }
  EXPECT_EQ(errors, 8);
  EXPECT_EQ(cache.GetStatistics().Bytes, 0u);
  EXPECT_THROW(this->File->VerifyBricks({}, { 0 }), Error);
  // Steps of later segments lie in other files.
  const int later = this->File->Index().Segments.back().FirstStep;
  if (later > 0)
  {
    EXPECT_NO_THROW(this->File->VerifyBricks({ later, 0, 0, 0 }, { 0, 1, 2, 3 }));
    EXPECT_TRUE(this->IsRight(*cache.Get(*this->File, { later, 0, 0, 0 }, 1), later, 1));
  }
}

TEST_F(BrickCacheTest, QuestionsBeyondTheSeriesAreErrors)
{
  BrickCache cache(Plenty);
  EXPECT_THROW((void)cache.Get(*this->File, {}, -1), Error);
  EXPECT_THROW((void)cache.Get(*this->File, {}, 99), Error);
  EXPECT_THROW((void)cache.Get(*this->File, { 4, 0, 0, 0 }, 0), Error);
}

int UsualMegabytes()
{
  return static_cast<int>(UsualCacheBudget(MachineMemory(), RanksStartedHere()) >> 20);
}

/// MiB of the whole budget; 99 when its parts are not as they should be.
int BudgetWith(const char* megabytes)
{
  setenv("BANYAN_CACHE_MB", megabytes, 1);
  CacheContext& caches = *CacheContext::Process();
  const std::uint64_t all = caches.BudgetBytes();
  return caches.Blocks().BudgetBytes() == all / 4 && BrickCache::Of(caches).Budget() == all / 8 * 3
           ? static_cast<int>(all >> 20)
           : 99;
}

TEST(ProcessCacheDeathTest, TakesItsBudgetFromTheEnvironment)
{
  // Each expectation runs in a new process, where the cache is not made yet.
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const auto exits = [](int code) { return ::testing::ExitedWithCode(code); };
  EXPECT_EXIT(_exit(BudgetWith("7")), exits(7), "");
  EXPECT_EXIT(_exit(BudgetWith("0")), exits(0), "");
  for (const char* const wrong : { "many", "-1", "", "64MB" })
  {
    EXPECT_EXIT(_exit(BudgetWith(wrong) == UsualMegabytes() ? 5 : 6), exits(5), "");
  }
}

/// Values of step 1, from a series that was just opened.
std::vector<float> FirstBrick(
  const std::string& path, const std::shared_ptr<CacheContext>& caches = nullptr)
{
  const auto file = SeriesFile::Open(path, caches);
  const BrickLayout layout = file->Layout(0);
  std::vector<float> values(static_cast<std::size_t>(layout.SamplesOf(0).Count()));
  file->DecodeBrick({ 1, 0, 0, 0 }, 0, values.data());
  return values;
}

TEST(ProcessCacheDeathTest, WithoutACacheBricksAreTheSame)
{
  ::testing::FLAGS_gtest_death_test_style = "threadsafe";
  const TemporaryFolder folder;
  const auto steps = Sample<float>(GridOf(33, 18, 19), 5, Wavy<float>);
  Encode(folder / "s.banyan", GridOf(33, 18, 19), steps, {});
  const auto compare = [&folder]
  {
    setenv("BANYAN_CACHE_MB", "0", 1);
    const std::vector<float> without = FirstBrick(folder / "s.banyan");
    const bool nothing = CacheContext::Process()->Blocks().Bytes() == 0;
    return nothing && without == FirstBrick(folder / "s.banyan", CacheContext::WithBudget(4 << 20))
             ? 5
             : 6;
  };
  EXPECT_EXIT(_exit(compare()), ::testing::ExitedWithCode(5), "");
}

TEST(CacheBudget, IsAWholeNumberOfMegabytesOrASentence)
{
  const TemporaryFolder folder;
  Encode(folder / "s.banyan", GridOf(5, 5, 5), Sample<float>(GridOf(5, 5, 5), 1, Wavy<float>), {});
  for (const char* const text :
    { "64MB", "many", "-1", "", " 7", "7 ", "1.5", "99999999999999999999" })
  {
    setenv("BANYAN_CACHE_MB", text, 1);
    try
    {
      (void)SeriesFile::Open(folder / "s.banyan");
      ADD_FAILURE() << "'" << text << "' was taken";
    }
    catch (const Error& error)
    {
      EXPECT_NE(std::string(error.what()).find("BANYAN_CACHE_MB is \"" + std::string(text) + "\""),
        std::string::npos)
        << error.what();
    }
    EXPECT_EQ(CacheBudgetBytes() >> 20, static_cast<std::uint64_t>(UsualMegabytes()));
  }
  setenv("BANYAN_CACHE_MB", "0", 1);
  EXPECT_EQ(CacheBudgetAskedFor(), 0u);
  setenv("BANYAN_CACHE_MB", "64", 1);
  EXPECT_EQ(CacheBudgetAskedFor(), std::uint64_t{ 64 } << 20);
  EXPECT_NO_THROW((void)SeriesFile::Open(folder / "s.banyan"));
  unsetenv("BANYAN_CACHE_MB");
  EXPECT_EQ(CacheBudgetAskedFor() >> 20, static_cast<std::uint64_t>(UsualMegabytes()));
}

TEST(CacheBudget, IsUsuallyAnEighthOfTheMachineSharedByItsRanks)
{
  constexpr std::uint64_t GiB = std::uint64_t{ 1 } << 30;
  EXPECT_EQ(UsualCacheBudget(64 * GiB, 1), 8 * GiB);
  EXPECT_EQ(UsualCacheBudget(64 * GiB, 4), 2 * GiB);
  EXPECT_EQ(UsualCacheBudget(64 * GiB, 0), 8 * GiB);
  EXPECT_EQ(UsualCacheBudget(64 * GiB, 64), GiB / 2) << "the least";
  EXPECT_EQ(UsualCacheBudget(0, 1), GiB / 2) << "not known";
  EXPECT_EQ(UsualCacheBudget(2048 * GiB, 2), 16 * GiB) << "the most";
  EXPECT_GT(MachineMemory(), 0u);
}

/// With nothing of it in the environment but one variable.
int RanksSaidBy(const char* name, const char* text)
{
  for (const char* const other :
    { "OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "SLURM_TASKS_PER_NODE" })
  {
    unsetenv(other);
  }
  setenv(name, text, 1);
  const int ranks = RanksStartedHere();
  unsetenv(name);
  return ranks;
}

TEST(CacheBudget, KnowsTheRanksOfAMachineFromTheEnvironment)
{
  EXPECT_EQ(RanksSaidBy("OMPI_COMM_WORLD_LOCAL_SIZE", "16"), 16);
  EXPECT_EQ(RanksSaidBy("MPI_LOCALNRANKS", "3"), 3);
  EXPECT_EQ(RanksSaidBy("SLURM_TASKS_PER_NODE", "4(x2),3"), 4);
  EXPECT_EQ(RanksSaidBy("MPI_LOCALNRANKS", "many"), 1);
  EXPECT_EQ(RanksSaidBy("MPI_LOCALNRANKS", "-2"), 1);
  EXPECT_EQ(RanksSaidBy("HOME_OF_NOBODY", "4"), 1);
}

} // namespace
} // namespace banyan::testing
