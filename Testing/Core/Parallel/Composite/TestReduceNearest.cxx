// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/CompositingCases.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

namespace banyan::testing
{
namespace
{

class NearestPixels : public ::testing::TestWithParam<int>
{
};

TEST_P(NearestPixels, AreFound)
{
  RunOnSimulatedRanks(GetParam(),
    [](Communicator& communicator)
    {
      for (const std::size_t count : { 0, 1, 2, 16, 17, 1021 })
      {
        EXPECT_EQ(CheckNearest(communicator, count), "");
      }
    });
}

INSTANTIATE_TEST_SUITE_P(Ranks, NearestPixels, ::testing::Range(1, 18));

TEST(ReduceNearest, CostsNothingWithoutGeometryAndOnlyItsRectangleWithSome)
{
  const PixelRect rect{ { 5, 3 }, { 85, 63 } };
  const PixelRect part{ { 20, 10 }, { 30, 25 } };
  for (const bool geometry : { false, true })
  {
    RunOnSimulatedRanks(4,
      [&](Communicator& communicator)
      {
        const auto rank = static_cast<std::uint8_t>(communicator.Rank());
        OpaquePixels pixels(
          static_cast<std::size_t>(rect.Count()), OpaquePixel{ 1.0f, { rank, 0, 0, 0 } });
        const auto indexOf = [&](int x, int y)
        { return static_cast<std::size_t>((y - rect.Lo.y) * rect.Size().x + x - rect.Lo.x); };
        for (int y = part.Lo.y; y < part.Hi.y && geometry && rank > 0; ++y)
        {
          // Together the ranks have the whole rectangle; the last one is nearest.
          for (int x = part.Lo.x + (rank == 1 ? 0 : 5); x < part.Hi.x; ++x)
          {
            pixels[indexOf(x, y)] = { 0.9f - 0.1f * rank, { rank, 9, 9, 255 } };
          }
        }
        CompositeStatistics statistics;
        const PixelRect found = ReduceNearestGeometry(communicator, rect, pixels, statistics);
        EXPECT_EQ(found, geometry ? part : PixelRect{});
        EXPECT_EQ(statistics.MessagesSent > 0, geometry);
        // Each of the four has a quarter sent to it by three, and sends it back to three.
        const auto pixelBytes = static_cast<double>(part.Count()) * sizeof(OpaquePixel);
        EXPECT_NEAR(static_cast<double>(statistics.BytesSent), geometry ? 1.5 * pixelBytes : 0.0,
          geometry ? 64.0 : 0.0);
        for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
        {
          for (int x = rect.Lo.x; x < rect.Hi.x; ++x)
          {
            const bool inside =
              geometry && x >= part.Lo.x && x < part.Hi.x && y >= part.Lo.y && y < part.Hi.y;
            const int expected = inside ? (x < part.Lo.x + 5 ? 1 : 3) : rank;
            EXPECT_EQ(pixels[indexOf(x, y)].Color[0], expected);
          }
        }
      });
  }
}

TEST(ReduceNearest, RefusesPicturesOfDifferentSizes)
{
  EXPECT_THROW(RunOnSimulatedRanks(3,
                 [](Communicator& communicator)
                 {
                   auto pixels = OpaqueOf(0, communicator.Rank() == 2 ? 5 : 4);
                   ReduceNearest(communicator, pixels);
                 }),
    Error);
}

} // namespace
} // namespace banyan::testing
