// SPDX-License-Identifier: BSD-3-Clause
#include "CompositingCases.h"

#include "Base/Error.h"
#include "Parallel/FragmentMessage.h"

#include <gtest/gtest.h>

#include <mutex>

namespace banyan::testing
{
namespace
{

class DirectSend : public ::testing::TestWithParam<int>
{
};

TEST_P(DirectSend, GivesThePictureOfOneRank)
{
  const int size = GetParam();
  RunOnSimulatedRanks(size,
    [](Communicator& communicator)
    {
      for (int which = 0; which < static_cast<int>(Case::Count); ++which)
      {
        for (const PixelRect& viewport : Viewports())
        {
          const std::string wrong =
            CheckComposite(communicator, static_cast<Case>(which), viewport);
          EXPECT_EQ(wrong, "");
        }
      }
    });
}

TEST_P(DirectSend, FindsTheNearestPixels)
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

INSTANTIATE_TEST_SUITE_P(Ranks, DirectSend, ::testing::Range(1, 18));

// Without this the tests above could pass on pictures that hold nothing.
TEST(CompositingCases, AreNotTrivial)
{
  const PixelRect viewport = Viewports()[0];
  for (int which = 0; which < static_cast<int>(Case::Count); ++which)
  {
    const auto picture = BlendedSerially<glm::dvec4>(static_cast<Case>(which), 4, viewport);
    const auto drawn = std::count_if(
      picture.begin(), picture.end(), [](const glm::dvec4& pixel) { return pixel.a > 0; });
    if (static_cast<Case>(which) == Case::RenderEmpty)
    {
      EXPECT_EQ(drawn, 0);
    }
    else
    {
      EXPECT_GT(drawn, 20) << NameOf(static_cast<Case>(which));
    }
  }
}

TEST(CompositingCases, OrderMatters)
{
  const PixelRect viewport = Viewports()[0];
  glm::vec4 forward(0.0f), backward(0.0f);
  for (int rank = 0; rank < 4; ++rank)
  {
    const glm::vec4 pixel = ImageOf(Case::AllOverlap, rank, 4, viewport).Pixels[5];
    forward = Combined(forward, pixel, Combination::Over);
    backward = Combined(pixel, backward, Combination::Over);
  }
  EXPECT_GT(glm::abs(forward.r - backward.r), 1e-3f);
}

std::uint64_t BytesOf(Case which, int size, const PixelRect& viewport)
{
  std::mutex mutex;
  std::uint64_t bytes = 0;
  RunOnSimulatedRanks(size,
    [&](Communicator& communicator)
    {
      CompositeStatistics statistics;
      CompositeDirectSend(communicator, ImageOf(which, communicator.Rank(), size, viewport),
        OrderOf(which, size), viewport, statistics);
      const std::lock_guard<std::mutex> lock(mutex);
      bytes += statistics.BytesSent;
    });
  return bytes;
}

TEST(DirectSendBytes, OnlyWhatIsDrawnTravels)
{
  const PixelRect viewport{ { 0, 0 }, { 64, 64 } };
  const std::uint64_t pixels = 64 * 64 * sizeof(glm::vec4);
  EXPECT_EQ(BytesOf(Case::RenderEmpty, 4, viewport), 0u);
  EXPECT_EQ(BytesOf(Case::AllOverlap, 1, viewport), 0u);
  // Three quarters of each of 4 images go to the owners of the strips, 3 strips go to the root.
  EXPECT_NEAR(static_cast<double>(BytesOf(Case::AllOverlap, 4, viewport)),
    static_cast<double>(pixels) * (3.0 + 0.75), static_cast<double>(pixels) * 0.05);
  // One image is sent to the owners and from there to the root; the background stays where it is.
  EXPECT_LT(BytesOf(Case::OneRankHasAll, 4, viewport), 2 * pixels);
}

TEST(DirectSendBytes, AreTheSameInEveryRun)
{
  const PixelRect viewport = Viewports()[0];
  EXPECT_EQ(
    BytesOf(Case::BackgroundCorrect, 7, viewport), BytesOf(Case::BackgroundCorrect, 7, viewport));
}

/// Runs a compositing in which rank 1 is called wrongly: all ranks must throw, and none may hang.
void ExpectAllRanksThrow(
  const std::function<void(FloatImage&, std::vector<int>&, PixelRect&)>& spoil)
{
  std::mutex mutex;
  int thrown = 0;
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      PixelRect viewport{ { 0, 0 }, { 8, 8 } };
      FloatImage mine = ImageOf(Case::AllOverlap, communicator.Rank(), 3, viewport);
      std::vector<int> order{ 2, 0, 1 };
      if (communicator.Rank() == 1)
      {
        spoil(mine, order, viewport);
      }
      CompositeStatistics statistics;
      try
      {
        CompositeDirectSend(communicator, mine, order, viewport, statistics);
      }
      catch (const Error& error)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        thrown += std::string(error.what()).find("ank 1") != std::string::npos ? 1 : 0;
      }
    });
  EXPECT_EQ(thrown, 3);
}

TEST(DirectSendErrors, AreThrownOnAllRanks)
{
  ExpectAllRanksThrow(
    [](FloatImage& mine, std::vector<int>&, PixelRect&)
    {
      mine.Rect.Lo.x -= 1;
      mine.Rect.Hi.x -= 1;
    });
  ExpectAllRanksThrow(
    [](FloatImage& mine, std::vector<int>&, PixelRect&) { mine.Pixels.pop_back(); });
  ExpectAllRanksThrow(
    [](FloatImage&, std::vector<int>& order, PixelRect&) {
      order = { 0, 0, 1 };
    });
  ExpectAllRanksThrow([](FloatImage&, std::vector<int>& order, PixelRect&) { order.pop_back(); });
  ExpectAllRanksThrow(
    [](FloatImage&, std::vector<int>& order, PixelRect&) {
      order = { 0, 1, 2 };
    });
  ExpectAllRanksThrow(
    [](FloatImage&, std::vector<int>&, PixelRect& viewport) { viewport.Hi.x += 1; });
}

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
        std::vector<OpaquePixel> pixels(
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
