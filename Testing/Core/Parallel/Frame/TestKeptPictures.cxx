// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Frame/KeptPictures.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

constexpr int Edge = 64;
constexpr std::uint64_t Bytes = Edge * Edge * 16;

/// Caches whose budget has room for so many pictures.
std::shared_ptr<CacheContext> CachesFor(int pictures)
{
  return CacheContext::WithBudget(static_cast<std::int64_t>(16 * Bytes) * pictures);
}

Hash128 Name(std::uint64_t number)
{
  return { number, 1 };
}

/// The content of two levels.
std::vector<Hash128> Content(std::uint64_t finest, std::uint64_t coarser)
{
  return { Name(finest), Name(coarser) };
}

DrawnPicture Picture(double error = 0.0)
{
  FloatImage pixels{ { { 0, 0 }, { Edge, Edge } }, PixelVector(Edge * Edge, glm::vec4(0.5f)) };
  DrawnPicture picture;
  picture.Pixels = std::make_shared<const FloatImage>(std::move(pixels));
  picture.EstimatedError = error;
  return picture;
}

const std::vector<Hash128> Same = Content(1, 1);

TEST(KeptPictures, TheLeastRecentlyUsedOneGoes)
{
  KeptPictures kept;
  kept.KeepIn(CachesFor(3));
  for (std::uint64_t scene = 0; scene < 3; ++scene)
  {
    kept.Keep(Name(scene), Same, { 0 }, {}, Picture());
  }
  EXPECT_EQ(kept.Bytes(), 3 * Bytes);
  EXPECT_NE(kept.Find(Name(0), Same, {}), nullptr);
  kept.Keep(Name(3), Same, { 0 }, {}, Picture());
  EXPECT_EQ(kept.Bytes(), 3 * Bytes);
  EXPECT_EQ(kept.Find(Name(1), Same, {}), nullptr);
  for (const std::uint64_t scene : { 0, 2, 3 })
  {
    EXPECT_NE(kept.Find(Name(scene), Same, {}), nullptr) << scene;
  }
}

/// Of one scene after the other, like the steps of a loop. @return how many were there
int Play(KeptPictures& kept, const Hash128& scene, std::uint64_t first, std::uint64_t end)
{
  int found = 0;
  for (std::uint64_t step = first; step < end; ++step)
  {
    const std::vector<Hash128> content = Content(step, step);
    if (kept.Find(scene, content, {}))
    {
      ++found;
    }
    else
    {
      kept.Keep(scene, content, { 0 }, {}, Picture());
    }
  }
  return found;
}

TEST(KeptPictures, OfALoopThatIsTooLongAPartStays)
{
  KeptPictures kept;
  kept.KeepIn(CachesFor(8));
  EXPECT_EQ(Play(kept, Name(0), 0, 20), 0);
  for (int round = 0; round < 5; ++round)
  {
    EXPECT_GE(Play(kept, Name(0), 0, 20), 3) << round;
    EXPECT_EQ(Play(kept, Name(0), 17, 20), 3) << "the newest ones";
  }
  EXPECT_EQ(kept.Bytes(), 8 * Bytes);
  Play(kept, Name(1), 0, 8);
  EXPECT_EQ(Play(kept, Name(1), 0, 8), 8) << "those of the other scene go first";
}

TEST(KeptPictures, AFinerOneServesAndTakesThePlace)
{
  KeptPictures kept;
  kept.KeepIn(CachesFor(4));
  kept.Keep(Name(0), Same, { 0 }, { 8.0, false }, Picture(8.0));
  EXPECT_EQ(kept.Find(Name(0), Same, { 1.0, false }), nullptr);
  ASSERT_NE(kept.Find(Name(0), Same, { 64.0, false }), nullptr);
  kept.Keep(Name(0), Same, { 0 }, { 1.0, false }, Picture(1.0));
  EXPECT_EQ(kept.Bytes(), Bytes);
  ASSERT_NE(kept.Find(Name(0), Same, { 8.0, false }), nullptr);
  EXPECT_EQ(kept.Find(Name(0), Same, { 8.0, false })->EstimatedError, 1.0);
}

TEST(KeptPictures, OfAMovingCameraTheLastOneIsKept)
{
  KeptPictures kept;
  kept.KeepIn(CachesFor(4));
  const KeptPictures::Quality moving{ 8.0, true };
  kept.Keep(Name(0), Same, { 0 }, moving, Picture());
  kept.Keep(Name(1), Same, { 0 }, moving, Picture());
  EXPECT_EQ(kept.Find(Name(0), Same, moving), nullptr);
  EXPECT_NE(kept.Find(Name(1), Same, moving), nullptr);
  EXPECT_EQ(kept.Find(Name(1), Same, { 8.0, false }), nullptr) << "not for a camera at rest";
}

TEST(KeptPictures, ContentCountsAtTheLevelsDrawn)
{
  KeptPictures kept;
  kept.KeepIn(CachesFor(4));
  kept.Keep(Name(0), Content(1, 1), { 1 }, {}, Picture());
  EXPECT_NE(kept.Find(Name(0), Content(2, 1), {}), nullptr);
  EXPECT_EQ(kept.Find(Name(0), Content(1, 2), {}), nullptr);
  EXPECT_EQ(kept.Find(Name(1), Content(1, 1), {}), nullptr);
}

TEST(KeptPictures, KeepersShareABudget)
{
  const std::shared_ptr<CacheContext> caches = CachesFor(2);
  KeptPictures one;
  one.KeepIn(caches);
  KeptPictures small;
  small.KeepIn(CachesFor(0));
  small.Keep(Name(0), Same, { 0 }, {}, Picture());
  EXPECT_EQ(small.Bytes(), 0u);
  {
    KeptPictures other;
    other.KeepIn(caches);
    for (std::uint64_t scene = 0; scene < 2; ++scene)
    {
      one.Keep(Name(scene), Same, { 0 }, {}, Picture());
    }
    EXPECT_EQ(one.Bytes(), Bytes) << "half of the budget";
  }
  one.Keep(Name(2), Same, { 0 }, {}, Picture());
  EXPECT_EQ(one.Bytes(), 2 * Bytes);
  one.Clear();
  EXPECT_EQ(one.Bytes(), 0u);
  one.Keep(Name(2), Same, { 0 }, {}, Picture());
  EXPECT_EQ(one.Bytes(), 0u) << "nobody says where";
}

} // namespace
