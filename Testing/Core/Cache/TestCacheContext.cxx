// SPDX-License-Identifier: BSD-3-Clause
// Series with caches of their own: each stays within its budget, and knows nothing of the others.
#include "Series/SeriesTesting.h"

#include "Cache/BackgroundDecoder.h"
#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Fields/SeriesField.h"
#include "Render/Steps/StepSource.h"
#include "Series/Decode/CacheContext.h"

namespace banyan::testing
{
namespace
{

/// All that a context tells of its caches.
struct Figures
{
  std::uint64_t Bricks, Hits, Misses, Evictions, Blocks, Payloads;

  explicit Figures(CacheContext& caches)
    : Blocks(caches.Blocks().Bytes())
    , Payloads(caches.Payloads().Bytes())
  {
    const BrickCache::Statistics bricks = BrickCache::Of(caches).GetStatistics();
    this->Bricks = bricks.Bytes;
    this->Hits = bricks.Hits;
    this->Misses = bricks.Misses;
    this->Evictions = bricks.Evictions;
  }
  friend bool operator==(const Figures& a, const Figures& b)
  {
    return a.Bricks == b.Bricks && a.Hits == b.Hits && a.Misses == b.Misses &&
           a.Evictions == b.Evictions && a.Blocks == b.Blocks && a.Payloads == b.Payloads;
  }
};

/// 64 bricks of 16 at each of 6 steps, all of them different: 19 kB each, as values.
class CacheContextTest : public ::testing::Test
{
protected:
  void SetUp() override
  {
    std::mt19937 random(8);
    this->Values = Sample<float>(this->Domain, 6,
      [&](int x, int y, int z, int s)
      { return Wavy<float>(x, y, z, s) + 0.1f * static_cast<float>(random() % 64); });
    EncodeOptions options;
    options.BrickCells = 16;
    options.KeyframeInterval = 2;
    Encode(this->Folder / "s.banyan", this->Domain, this->Values, options);
  }

  std::shared_ptr<SeriesFile> Open(const std::shared_ptr<CacheContext>& caches = nullptr) const
  {
    return SeriesFile::Open(this->Folder / "s.banyan", caches);
  }

  /// Reads all steps, brick by brick. @return whether values are right
  bool Play(const SeriesFile& file) const
  {
    const double bound = file.Index().Arrays[0].Components[0].ErrorBoundAbsolute;
    bool right = true;
    for (std::size_t step = 0; step < this->Values.size(); ++step)
    {
      for (std::int64_t brick = 0; brick < file.Layout(0).BrickCount(); ++brick)
      {
        const auto values =
          BrickCache::Of(file).Get(file, { static_cast<int>(step), 0, 0, 0 }, brick);
        const Box box = values->Samples;
        for (int z = box.Lo.z, i = 0; z < box.Hi.z; ++z)
        {
          for (int y = box.Lo.y; y < box.Hi.y; ++y)
          {
            for (int x = box.Lo.x; x < box.Hi.x; ++x, ++i)
            {
              const float expected =
                this->Values[step][static_cast<std::size_t>((z * 65 + y) * 65 + x)];
              right = right && std::abs(double{ values->As<float>()[i] } - expected) <= bound;
            }
          }
        }
      }
    }
    return right;
  }

  static void ExpectWithinBudget(CacheContext& caches)
  {
    const BrickCache::Statistics bricks = BrickCache::Of(caches).GetStatistics();
    EXPECT_LE(bricks.PeakBytes, caches.DecodedBudgetBytes());
    EXPECT_LE(caches.Blocks().Bytes(), caches.BudgetBytes() / 4);
    EXPECT_LE(caches.Payloads().Bytes(), caches.BudgetBytes() / 32);
  }

  const TemporaryFolder Folder;
  const Grid Domain = GridOf(65, 65, 65);
  Steps<float> Values;
};

TEST_F(CacheContextTest, EachSeriesStaysWithinTheBudgetOfItsOwnCaches)
{
  const auto small = std::make_shared<CacheContext>(std::uint64_t{ 1 } << 20);
  const auto large = std::make_shared<CacheContext>(std::uint64_t{ 64 } << 20);
  CacheContext& process = *CacheContext::Process();
  const Figures processBefore(process);
  const auto one = this->Open(small);
  const auto other = this->Open(large);
  EXPECT_EQ(one->Caches(), small);

  EXPECT_TRUE(this->Play(*one));
  ExpectWithinBudget(*small);
  const Figures ofSmall(*small);
  EXPECT_GT(ofSmall.Bricks, small->DecodedBudgetBytes() / 2);
  EXPECT_GT(ofSmall.Blocks, 0u);
  EXPECT_GT(ofSmall.Evictions, 0u);
  EXPECT_EQ(Figures(*large), Figures(*std::make_shared<CacheContext>(0))) << "was not read";

  EXPECT_TRUE(this->Play(*other));
  ExpectWithinBudget(*large);
  const Figures ofLarge(*large);
  EXPECT_EQ(ofLarge.Evictions, 0u);
  EXPECT_EQ(ofLarge.Misses, 6u * 64);
  EXPECT_EQ(Figures(*small), ofSmall) << "the other one was read";
  EXPECT_TRUE(this->Play(*other));
  EXPECT_EQ(Figures(*large).Hits, 6u * 64);
  EXPECT_EQ(other->BricksDecoded(), 6u * 64);
  EXPECT_EQ(Figures(process), processBefore);

  const auto shared = this->Open();
  EXPECT_EQ(shared->Caches(), CacheContext::Process());
  EXPECT_TRUE(this->Play(*shared));
  EXPECT_FALSE(Figures(process) == processBefore);
  EXPECT_EQ(Figures(*small), ofSmall);
}

/// Two series in one context share its budget.
TEST_F(CacheContextTest, SeriesOfOneContextShareIt)
{
  const auto caches = std::make_shared<CacheContext>(std::uint64_t{ 64 } << 20);
  const auto one = this->Open(caches);
  const auto other = this->Open(caches);
  EXPECT_TRUE(this->Play(*one));
  EXPECT_TRUE(this->Play(*other));
  EXPECT_EQ(Figures(*caches).Misses, 6u * 64);
  EXPECT_EQ(Figures(*caches).Hits, 6u * 64);
  ExpectWithinBudget(*caches);
}

TEST_F(CacheContextTest, WithoutABudgetNothingStaysAndValuesAreRight)
{
  const auto none = CacheContext::WithBudget(0);
  EXPECT_TRUE(this->Play(*this->Open(none)));
  EXPECT_EQ(none->Blocks().Bytes(), 0u);
  EXPECT_EQ(none->Payloads().Bytes(), 0u);
  EXPECT_EQ(BrickCache::Of(*none).GetStatistics().PeakBytes, 0u);
}

TEST_F(CacheContextTest, LivesAsLongAsWhoeverHasTheSeries)
{
  std::weak_ptr<CacheContext> caches;
  std::unique_ptr<BrickSource> source;
  {
    const auto file = this->Open(CacheContext::WithBudget(1 << 20));
    caches = file->Caches();
    source = MakeSeriesSource(file, {}, 0, { 0.0, 1.0, 0.0 });
  }
  ASSERT_FALSE(caches.expired());
  EXPECT_EQ(source->Kept().Caches(), caches.lock());
  (void)source->Load(3);
  EXPECT_EQ(BrickCache::Of(*caches.lock()).GetStatistics().Misses, 1u);
  source.reset();
  EXPECT_TRUE(caches.expired());
}

/// Bricks that are decoded ahead go where they are looked for.
TEST_F(CacheContextTest, BricksAreDecodedAheadIntoTheCachesOfTheSeries)
{
  const Figures processBefore(*CacheContext::Process());
  auto file = this->Open(CacheContext::WithBudget(64 << 20));
  const std::shared_ptr<CacheContext> caches = file->Caches();
  BackgroundDecoder decoder(BrickCache::Of(*file), 2);
  decoder.Start(std::move(file), { { {}, { 1, 2, 3 } } }, 1 << 20);
  decoder.Finish();
  EXPECT_EQ(Figures(*caches).Misses, 3u);
  EXPECT_EQ(Figures(*CacheContext::Process()), processBefore);
}

/// A rank without a piece opens the series by itself, and again when the others' caches change.
TEST_F(CacheContextTest, RanksWithoutAPieceHaveCachesAsLargeAsTheOthers)
{
  RunOnSimulatedRanks(3,
    [this](Communicator& communicator)
    {
      SeriesField field;
      std::vector<SeriesField::Piece> pieces(3);
      pieces[1].HasData = true;
      SeriesField::Wish wish;
      wish.Samples = { glm::ivec3(0), glm::ivec3(65) };
      for (const std::int64_t bytes : { -1, 1 << 20, 3 << 20, 0, -1 })
      {
        const auto held =
          communicator.Rank() == 1 ? this->Open(CacheContext::WithBudget(bytes)) : nullptr;
        std::string problem;
        ASSERT_TRUE(field.Take(communicator, held, pieces, wish, problem));
        ASSERT_EQ(problem, "");
        EXPECT_EQ(field.Source()->Kept().Caches()->OwnBudgetBytes(), bytes);
        EXPECT_TRUE(!held || field.Source()->Kept().Caches() == held->Caches());
      }
    });
}

TEST(CacheContext, IsMadeForABudgetOrThatOfTheProcess)
{
  EXPECT_EQ(CacheContext::WithBudget(-1), CacheContext::Process());
  EXPECT_EQ(CacheContext::Process()->OwnBudgetBytes(), -1);
  const auto own = CacheContext::WithBudget(800);
  EXPECT_NE(own, CacheContext::WithBudget(800)) << "each has caches of its own";
  EXPECT_EQ(own->OwnBudgetBytes(), 800);
  EXPECT_EQ(own->BudgetBytes(), 800u);
  EXPECT_EQ(own->DecodedBudgetBytes(), 300u);
  EXPECT_EQ(own->DrawingBudgetBytes(), 250u);
  EXPECT_EQ(own->Blocks().BudgetBytes(), 200u);
  EXPECT_EQ(BrickCache::Of(*own).Budget(), 300u);
  EXPECT_EQ(&BrickCache::Of(*own), &BrickCache::Of(*own));
}

} // namespace
} // namespace banyan::testing
