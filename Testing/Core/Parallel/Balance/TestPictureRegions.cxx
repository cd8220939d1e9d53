// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/PictureRegions.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

/// Two by two tiles, of ranks that no order of a tree has.
std::vector<PicturePlace> FourTiles()
{
  return { { { { 0, 0 }, { 128, 128 } }, 3, {} }, { { { 128, 0 }, { 256, 128 } }, 1, {} },
    { { { 0, 128 }, { 128, 256 } }, 0, {} }, { { { 128, 128 }, { 256, 256 } }, 4, {} } };
}

/// The volume is under all of the picture alike.
RayScene Whole()
{
  return scenes::Scene(glm::ivec3(9), { 256, 256 }, glm::dmat4(1.0), 0.3, true);
}

/// Frames of ranks that take the same time for each pixel.
std::vector<PixelRect> RegionsAfter(int frames, int ranks, const std::vector<PicturePlace>& places)
{
  std::vector<PixelRect> regions;
  RunOnSimulatedRanks(ranks,
    [&](Communicator& communicator)
    {
      PictureRegions mine;
      for (int frame = 0; frame < frames; ++frame)
      {
        RayScene scene = Whole();
        const std::vector<PixelRect> now = mine.BeginFrame(scene, ranks, places);
        const auto pixels = now[static_cast<std::size_t>(communicator.Rank())].Count();
        scene.Work->DrawSeconds = 1e-6 * static_cast<double>(pixels);
        scene.Work->Parts.push_back({ scene.DomainCells, { pixels, pixels, 1.0 * pixels, 0.0 } });
        mine.EndFrame(communicator);
        if (communicator.Rank() == 0)
        {
          regions = now;
        }
      }
    });
  return regions;
}

TEST(PictureRegions, EachRankGetsTheRegionOfItsOwnPlace)
{
  // Rank 2 has no place: the others' are cut so that it has a fifth.
  for (const int frames : { 1, 4 })
  {
    const std::vector<PixelRect> regions = RegionsAfter(frames, 5, FourTiles());
    long long own = 0;
    long long all = 0;
    for (const PicturePlace& place : FourTiles())
    {
      own += Intersection(regions[static_cast<std::size_t>(place.Root)], place.Rect).Count();
    }
    for (const PixelRect& region : regions)
    {
      all += region.Count();
    }
    EXPECT_EQ(all, 256 * 256);
    EXPECT_GT(own, all / 2) << frames;
  }
}

TEST(PictureRegions, RanksThatTakeAsLongDrawTheirOwnTiles)
{
  std::vector<PicturePlace> places = FourTiles();
  places.back().Root = 2;
  const std::vector<PixelRect> regions = RegionsAfter(3, 4, places);
  for (const PicturePlace& place : places)
  {
    EXPECT_EQ(regions[static_cast<std::size_t>(place.Root)], place.Rect) << place.Root;
  }
}

} // namespace
