// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scenes.h"

#include "Series/Decode/CacheContext.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <vector>

namespace
{

using namespace banyan;

class Counting : public ArrayBrickSource
{
public:
  using ArrayBrickSource::ArrayBrickSource;
  BrickView Load(std::int64_t brick) override
  {
    ++this->Loads;
    return ArrayBrickSource::Load(brick);
  }
  std::atomic<int> Loads{ 0 };
};

PackedBrickCache::Pointer Pack(const std::vector<double>& values, double low)
{
  BrickView view{ values.data(), ScalarType::Float64, { 1, 3, 9 }, {} };
  return std::make_shared<const PackedBrick>(
    view, glm::ivec3(0), Box{ glm::ivec3(0), glm::ivec3(2) }, low);
}

PackedBrickCache::Pointer Find(
  const PackedBrickCache& kept, std::int64_t brick, const Box& cells, double low = 0.0)
{
  const PackedBrickCache::Wanted wanted{ brick, cells, low, false };
  PackedBrickCache::Found found;
  kept.Find(&wanted, 1, 0, &found);
  return found.Packed;
}

TEST(PackedBrickCache, StayWithinTheLimitAndAsLongAsTheyAreUsed)
{
  const std::vector<double> values(27, 1.0);
  const Box cells{ glm::ivec3(0), glm::ivec3(2) };
  const std::uint64_t bytes = PackedBrick::BytesFor(cells, false);
  PackedBrickCache kept;
  kept.BeginPicture(2 * bytes);
  for (int brick = 0; brick < 3; ++brick)
  {
    EXPECT_EQ(Find(kept, brick, cells), nullptr);
    kept.Keep(brick, Pack(values, 0.0));
  }
  EXPECT_EQ(kept.Bytes(), 2 * bytes);
  EXPECT_NE(Find(kept, 1, cells), nullptr);
  EXPECT_EQ(Find(kept, 2, cells), nullptr);
  kept.EndPicture();
  for (int picture = 0; picture < 3; ++picture)
  {
    kept.BeginPicture(2 * bytes);
    EXPECT_NE(Find(kept, 0, cells), nullptr);
    kept.EndPicture();
  }
  EXPECT_EQ(Find(kept, 1, cells), nullptr);
  EXPECT_EQ(kept.Bytes(), bytes);
  kept.BeginPicture(bytes - 1);
  EXPECT_EQ(kept.Bytes(), 0u);
}

/// A cache with room for some bricks, whose pictures use some.
class Pictures
{
public:
  explicit Pictures(std::uint64_t bricks)
    : Limit(bricks * PackedBrick::BytesFor(Cells(), false))
  {
  }

  static Box Cells() { return { glm::ivec3(0), glm::ivec3(2) }; }

  /// Draws a picture, or begins one that is stopped.
  void Draw(
    PackedBrickCache::Picture kind, const std::vector<std::int64_t>& bricks, bool stopped = false)
  {
    this->Kept.BeginPicture(this->Limit, kind);
    for (const std::int64_t brick : bricks)
    {
      if (!Find(this->Kept, brick, Cells()))
      {
        this->Kept.Keep(brick, Pack(std::vector<double>(27, 1.0), 0.0));
      }
    }
    if (!stopped)
    {
      this->Kept.EndPicture();
    }
  }

  /// How many of some bricks are kept. They are used from now on: a picture has to begin next.
  int CountKept(const std::vector<std::int64_t>& bricks) const
  {
    return static_cast<int>(std::count_if(bricks.begin(), bricks.end(),
      [&](std::int64_t brick) { return Find(this->Kept, brick, Cells()) != nullptr; }));
  }

private:
  std::uint64_t Limit;
  PackedBrickCache Kept;
};

using Kind = PackedBrickCache::Picture;

TEST(PackedBrickCache, CoarsePicturesLetBricksOfExactOnesStay)
{
  Pictures pictures(8);
  pictures.Draw(Kind::Whole, { 0, 1, 2, 3 });
  for (int move = 0; move < 20; ++move)
  {
    pictures.Draw(Kind::Passing, { 10 });
  }
  pictures.Draw(Kind::Whole, { 0, 1 });
  pictures.Draw(Kind::Whole, { 0, 1 });
  EXPECT_EQ(pictures.CountKept({ 2, 3, 10 }), 3);
  for (int picture = 0; picture < 4; ++picture)
  {
    pictures.Draw(Kind::Whole, { 0, 1 });
  }
  EXPECT_EQ(pictures.CountKept({ 2, 3, 10 }), 0);
  EXPECT_EQ(pictures.CountKept({ 0, 1 }), 2);
}

TEST(PackedBrickCache, CoarsePicturesTakeAsMuchRoomAsTheyNeed)
{
  const std::vector<std::int64_t> exact = { 0, 1, 2, 3, 4, 5, 6, 7 };
  Pictures pictures(8);
  pictures.Draw(Kind::Whole, exact);
  for (int move = 0; move < 4; ++move)
  {
    pictures.Draw(Kind::Passing, { 10, 11 });
  }
  EXPECT_EQ(pictures.CountKept({ 10, 11 }), 2);
  EXPECT_EQ(pictures.CountKept(exact), 6);
}

TEST(PackedBrickCache, AStoppedPictureMakesNoBrickOlder)
{
  Pictures pictures(8);
  pictures.Draw(Kind::Whole, { 0, 1, 2 });
  for (int pause = 0; pause < 5; ++pause)
  {
    pictures.Draw(Kind::Whole, { 0 }, /*stopped=*/true);
  }
  EXPECT_EQ(pictures.CountKept({ 0, 1, 2 }), 3);
}

TEST(PackedBrickCache, OtherCellsOrAnotherLowEndAreOtherBricks)
{
  const std::vector<double> values(27, 1.0);
  const Box cells{ glm::ivec3(0), glm::ivec3(2) };
  PackedBrickCache kept;
  kept.BeginPicture(1 << 20);
  kept.Keep(7, Pack(values, 0.5));
  EXPECT_NE(Find(kept, 7, cells, 0.5), nullptr);
  EXPECT_EQ(Find(kept, 7, cells, 0.25), nullptr);
  EXPECT_EQ(Find(kept, 7, Box{ glm::ivec3(0), glm::ivec3(1, 2, 2) }, 0.5), nullptr);
  const std::uint64_t bytes = kept.Bytes();
  kept.Keep(7, Pack(values, 0.25));
  EXPECT_EQ(kept.Bytes(), bytes);
  EXPECT_NE(Find(kept, 7, cells, 0.25), nullptr);
}

TEST(PackedBrickCache, SeveralAreFoundInOneGoWithWhatCanBeSeenOfThem)
{
  const std::vector<double> values(27, 1.0);
  const Box cells{ glm::ivec3(0), glm::ivec3(2) };
  PackedBrickCache kept;
  kept.BeginPicture(1 << 20);
  const PackedBrickCache::Pointer packed = Pack(values, 0.0);
  kept.Keep(3, packed);
  kept.Keep(4, Pack(values, 0.0));
  BrickVisibility seen;
  seen.MacroEdge = 2;
  kept.KeepVisibility(3, 11, seen);
  const PackedBrickCache::Wanted wanted[] = { { 4, cells, 0.0, false }, { -1, cells, 0.0, false },
    { 3, cells, 0.0, false }, { 5, cells, 0.0, false }, { 3, cells, 0.0, true } };
  PackedBrickCache::Found found[5];
  kept.Find(wanted, 5, 11, found);
  EXPECT_NE(found[0].Packed, nullptr);
  EXPECT_FALSE(found[0].Visibility);
  EXPECT_EQ(found[1].Packed, nullptr);
  EXPECT_EQ(found[2].Packed, packed);
  ASSERT_TRUE(found[2].Visibility);
  EXPECT_EQ(found[2].Visibility->MacroEdge, 2);
  EXPECT_EQ(found[3].Packed, nullptr);
  EXPECT_EQ(found[4].Packed, nullptr);

  PackedBrickCache::Found under;
  kept.Find(&wanted[2], 1, 12, &under); // another function
  EXPECT_EQ(under.Packed, packed);
  EXPECT_FALSE(under.Visibility);
}

TEST(PackedBrickCache, BricksThatGoLeaveTheirMemoryToTheNext)
{
  LargeMemory::Trim();
  const std::vector<float> values(std::size_t{ 33 } * 33 * 33, 1.0f);
  const BrickView view{ values.data(), ScalarType::Float32, { 1, 33, 33 * 33 }, {} };
  const Box cells{ glm::ivec3(0), glm::ivec3(32) };
  const auto pack = [&]
  { return std::make_unique<const PackedBrick>(view, glm::ivec3(0), cells, 0.0); };
  std::unique_ptr<const PackedBrick> packed = pack();
  const std::size_t beside = LargeMemory::KeptBytes(); // what packing took for itself
  const float* const first = packed->Values();
  packed.reset();
  EXPECT_GE(
    LargeMemory::KeptBytes() - beside, PackedBrick::BytesFor(cells, false) - sizeof(PackedBrick));
  packed = pack();
  EXPECT_EQ(packed->Values(), first);
  EXPECT_EQ(LargeMemory::KeptBytes(), beside);
  packed.reset();
  LargeMemory::Trim();
}

TEST(PackedBrickCache, SourcesThatKeepBricksShareTheBudget)
{
  const auto caches = std::make_shared<CacheContext>(1600); // 500 are for drawing
  PackedBrickCache others;                                  // of other caches
  const PackedBrickCache::Pointer packed = Pack(std::vector<double>(27, 1.0), 0.0);
  PackedBrickCache first(caches);
  others.BeginPicture(1 << 20);
  others.Keep(7, packed);
  first.BeginPicture(1 << 20);
  EXPECT_EQ(first.ShareBytes(), 500u);
  first.Keep(7, packed);
  EXPECT_EQ(first.ShareBytes(), 500u);
  {
    PackedBrickCache second(caches);
    EXPECT_EQ(second.ShareBytes(), 250u) << "before it has any itself";
    second.BeginPicture(1 << 20);
    EXPECT_EQ(first.ShareBytes(), 500u) << "one that keeps none needs none";
    second.Keep(7, packed);
    second.Keep(8, packed);
    EXPECT_EQ(first.ShareBytes(), 250u);
    EXPECT_EQ(second.ShareBytes(), 250u);
    second.BeginPicture(0);
    EXPECT_EQ(first.ShareBytes(), 500u) << "it lets go of all";
    second.BeginPicture(1 << 20);
    second.Keep(7, packed);
    EXPECT_EQ(first.ShareBytes(), 250u);
  }
  EXPECT_EQ(first.ShareBytes(), 500u) << "it is gone";
}

TEST(PackedBrickCache, PicturesAreTheSameAndLoadOnce)
{
  const glm::ivec3 n(33);
  const std::vector<double> values = scenes::Sampled<double>(scenes::Standard, n);
  RayScene scene = scenes::Scene(n, { 50, 50 });
  ThreadPool pool(2);
  Counting source(scenes::ArrayOf(values, n), 8, { 0, 1 }, pool);
  for (const std::uint64_t budget : { std::uint64_t{ 1 } << 30, std::uint64_t{ 300000 } })
  {
    for (const double low : { 0.0, -0.25 })
    {
      scene.Transfer.Low = low;
      RayStatistics statistics;
      const auto draw = [&]
      { return CastRays(scene, source, scene.DomainCells, budget, pool, statistics); };
      const FloatImage first = draw();
      source.Loads = 0;
      const FloatImage second = draw();
      EXPECT_EQ(MaxDifference(first, second), 0.0);
      EXPECT_EQ(MaxDifference(first, scenes::Draw(scene, scenes::ArrayOf(values, n)).Image), 0.0);
      EXPECT_EQ(source.Loads, budget > 300000 ? 0 : source.Loads.load());
      EXPECT_LT(source.Loads, 64);
      EXPECT_LE(source.Kept().Bytes(), PackedBrickCache::PartOf(budget));
      EXPECT_EQ(statistics.BricksDrawn, 128);
    }
  }
}

TEST(PackedBrickCache, WhatCanBeSeenChangesWithTheTransferFunction)
{
  const glm::ivec3 n(33);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  RayScene scene = scenes::Scene(n, { 50, 50 });
  ThreadPool pool(2);
  Counting source(scenes::ArrayOf(values, n), 16, { 0, 1 }, pool);
  std::int64_t before = 0;
  for (const scenes::Function& function : { scenes::Function(scenes::Sparse),
         scenes::Function(scenes::Smooth), scenes::Function(scenes::Sparse) })
  {
    scene.Transfer = scenes::Tabulate(function);
    RayStatistics statistics;
    const FloatImage picture =
      CastRays(scene, source, scene.DomainCells, std::uint64_t{ 1 } << 30, pool, statistics);
    EXPECT_EQ(MaxDifference(picture, scenes::Draw(scene, scenes::ArrayOf(values, n)).Image), 0.0);
    EXPECT_NE(statistics.SamplesTaken, before);
    before = statistics.SamplesTaken;
  }
}

} // namespace
