// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/CompositingCases.h"

#include "Base/Error.h"
#include "Parallel/Composite/FragmentMessage.h"

#include <gtest/gtest.h>

#include <mutex>

namespace banyan::testing
{
namespace
{

CompositeOptions OptionsOf(PixelTransport transport)
{
  CompositeOptions options;
  options.Transport = transport;
  return options;
}

// Without this the tests below could pass on pictures that hold nothing.
TEST(CompositingCases, AreNotTrivial)
{
  const PixelRect viewport = Viewports()[0];
  for (int which = 0; which < static_cast<int>(Case::Count); ++which)
  {
    const auto picture =
      PreparedCase(static_cast<Case>(which), 4, viewport, Combination::Over).Reference;
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

class Compositing : public ::testing::TestWithParam<int>
{
};

/// All cases on one number of ranks.
void CheckAll(int size, const std::vector<PixelRect>& viewports, PixelTransport transport,
  Combination combination, bool behind)
{
  for (int which = 0; which < static_cast<int>(Case::Count); ++which)
  {
    for (const PixelRect& viewport : viewports)
    {
      const PreparedCase prepared(static_cast<Case>(which), size, viewport, combination);
      RunOnSimulatedRanks(size,
        [&](Communicator& communicator)
        {
          CompositeOptions options = OptionsOf(transport);
          options.Behind = behind ? viewport : PixelRect{};
          EXPECT_EQ(CheckComposite(communicator, prepared, options), "");
        });
    }
  }
}

TEST_P(Compositing, OfFloatsIsThePictureOfOneRank)
{
  CheckAll(GetParam(), Viewports(), PixelTransport::Floats, Combination::Over, false);
}

TEST_P(Compositing, OfFewBitsIsWithinOneOfThePictureOfOneRank)
{
  CheckAll(GetParam(), { Viewports()[0], Viewports()[4] }, PixelTransport::WithinOne,
    Combination::Over, false);
}

TEST_P(Compositing, OfFewBitsMayBeBlendedOverSomethingElse)
{
  CheckAll(GetParam(), { Viewports()[0] }, PixelTransport::WithinOne, Combination::Over, true);
}

TEST_P(Compositing, KnowsLargestNumbersAndSums)
{
  for (const Combination combination : { Combination::Largest, Combination::Sum })
  {
    CheckAll(GetParam(), { Viewports()[0] }, PixelTransport::WithinOne, combination, false);
  }
}

INSTANTIATE_TEST_SUITE_P(Ranks, Compositing, ::testing::Range(1, 17));

// Pictures of which a rank has more than memory allows are composited in several batches.
TEST(CompositingBatches, AreAsLargeAsMemoryAllows)
{
  const PixelRect viewport{ { 0, 0 }, { 100, 10 } };
  const auto pictureOf = [&viewport](int first, int second)
  {
    static const FloatImage none;
    CompositeOptions options;
    for (const int width : { first, second })
    {
      options.Footprints.push_back(FootprintOf({ { 0, 0 }, { width, 10 } }, viewport));
    }
    return PictureOfRanks{ none, { 0, 1 }, viewport, options };
  };
  // 16 bytes a pixel: the first rank has 1600, 0, 3200 and 160 bytes, the other 320 of each.
  const std::vector<PictureOfRanks> pictures{ pictureOf(10, 2), pictureOf(0, 2), pictureOf(20, 2),
    pictureOf(1, 2) };
  EXPECT_EQ(EndOfBatch(pictures, 0, CompositeOptions().MostBytes), 4);
  EXPECT_EQ(EndOfBatch(pictures, 0, 4960), 4);
  EXPECT_EQ(EndOfBatch(pictures, 0, 4959), 3);
  EXPECT_EQ(EndOfBatch(pictures, 0, 4799), 2);
  EXPECT_EQ(EndOfBatch({ pictureOf(1, 2), pictureOf(1, 2) }, 0, 639), 1); // the other rank's
  EXPECT_EQ(EndOfBatch(pictures, 2, 1), 3);                               // one may take more
  EXPECT_EQ(EndOfBatch(pictures, 3, 1), 4);
  EXPECT_EQ(CompositeOptions().MostBytes, std::uint64_t{ 256 } << 20);
}

/// Every rank draws in every pixel of several tiles and chunks.
std::string CheckDepth(int size, PixelTransport transport, PixelPacking packing)
{
  std::mutex mutex;
  std::string wrong;
  const PreparedCase prepared(Case::AllOverlap, size, { { 0, 0 }, { 45, 40 } }, Combination::Over);
  RunOnSimulatedRanks(size,
    [&](Communicator& communicator)
    {
      CompositeOptions options = OptionsOf(transport);
      options.Packing = packing;
      options.Behind = { { 0, 0 }, { 9, 40 } };
      const std::string here = CheckComposite(communicator, prepared, options);
      const std::lock_guard<std::mutex> lock(mutex);
      wrong += here;
    });
  return wrong;
}

TEST(CompositingDepth, Of64RanksIsRight)
{
  EXPECT_EQ(CheckDepth(64, PixelTransport::Floats, PixelPacking::Always), "");
  EXPECT_EQ(CheckDepth(64, PixelTransport::WithinOne, PixelPacking::Always), "");
  EXPECT_EQ(CheckDepth(64, PixelTransport::WithinOne, PixelPacking::Never), "");
}

TEST(CompositingDepth, OfLargePicturesIsRight)
{
  const PreparedCase prepared(
    Case::BackgroundCorrect, 3, { { 3, 5 }, { 420, 333 } }, Combination::Over);
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      for (const PixelTransport transport : { PixelTransport::Floats, PixelTransport::WithinOne })
      {
        EXPECT_EQ(CheckComposite(communicator, prepared, OptionsOf(transport)), "");
      }
    });
}

struct Traffic
{
  std::uint64_t Bytes = 0;
  std::uint64_t BytesIn = 0;
  std::uint64_t Messages = 0;
};

Traffic TrafficOf(Case which, int size, const PixelRect& viewport, const CompositeOptions& options)
{
  std::mutex mutex;
  Traffic traffic;
  RunOnSimulatedRanks(size,
    [&](Communicator& communicator)
    {
      CompositeStatistics statistics;
      Composite(communicator, ImageOf(which, communicator.Rank(), size, viewport),
        OrderOf(which, size), viewport, options, statistics);
      const std::lock_guard<std::mutex> lock(mutex);
      traffic.Bytes += statistics.BytesSent;
      traffic.BytesIn += statistics.BytesReceived;
      traffic.Messages += statistics.MessagesSent;
    });
  return traffic;
}

TEST(CompositingTraffic, IsOnlyWhatIsDrawn)
{
  const PixelRect viewport{ { 0, 0 }, { 128, 128 } };
  const std::uint64_t pixels = 128 * 128;
  CompositeOptions options = OptionsOf(PixelTransport::WithinOne);
  options.Packing = PixelPacking::Never;
  const Traffic alone = TrafficOf(Case::AllOverlap, 1, viewport, options);
  EXPECT_EQ(alone.Bytes, 0u);
  EXPECT_EQ(alone.Messages, 0u);
  EXPECT_EQ(TrafficOf(Case::RenderEmpty, 4, viewport, options).Bytes, 0u);
  const Traffic all = TrafficOf(Case::AllOverlap, 4, viewport, options);
  EXPECT_EQ(all.Bytes, all.BytesIn);
  EXPECT_GT(all.Bytes, 3 * pixels);
}

TEST(CompositingTraffic, OfOneRankGoesToTheRootAtOnceAndAsBytes)
{
  const PixelRect viewport{ { 0, 0 }, { 128, 128 } };
  CompositeOptions options = OptionsOf(PixelTransport::WithinOne);
  options.Packing = PixelPacking::Never;
  const Traffic traffic = TrafficOf(Case::OneRankHasAll, 5, viewport, options);
  // Plain bytes, without the highest bit, because no pixel is above 0.4.
  EXPECT_NEAR(static_cast<double>(traffic.Bytes), 28.0 / 8.0 * 128 * 128, 4000.0);
  // The root's own pixels stay.
  EXPECT_EQ(TrafficOf(Case::OneRankHasAll, 1, viewport, options).Bytes, 0u);
}

TEST(CompositingTraffic, IsTheSameInEveryRun)
{
  const CompositeOptions options = OptionsOf(PixelTransport::WithinOne);
  const PixelRect viewport = Viewports()[0];
  const Traffic first = TrafficOf(Case::BackgroundCorrect, 7, viewport, options);
  EXPECT_EQ(first.Bytes, TrafficOf(Case::BackgroundCorrect, 7, viewport, options).Bytes);
}

/// Runs a compositing in which rank 1 is called wrongly: all ranks must throw, and none may hang.
void ExpectAllRanksThrow(
  const std::function<void(FloatImage&, std::vector<int>&, CompositeOptions&)>& spoil)
{
  std::mutex mutex;
  int thrown = 0;
  RunOnSimulatedRanks(3,
    [&](Communicator& communicator)
    {
      const PixelRect viewport{ { 0, 0 }, { 8, 8 } };
      FloatImage mine = ImageOf(Case::AllOverlap, communicator.Rank(), 3, viewport);
      std::vector<int> order{ 2, 0, 1 };
      CompositeOptions options = OptionsOf(PixelTransport::WithinOne);
      options.Footprints.assign(3, FootprintOf(viewport, viewport));
      if (communicator.Rank() == 1)
      {
        spoil(mine, order, options);
      }
      CompositeStatistics statistics;
      try
      {
        Composite(communicator, mine, order, viewport, options, statistics);
      }
      catch (const Error& error)
      {
        const std::lock_guard<std::mutex> lock(mutex);
        thrown += std::string(error.what()).find("ank 1") != std::string::npos ? 1 : 0;
      }
    });
  EXPECT_EQ(thrown, 3);
}

TEST(CompositingErrors, AreThrownOnAllRanks)
{
  ExpectAllRanksThrow(
    [](FloatImage& mine, std::vector<int>&, CompositeOptions&) { mine.Pixels.pop_back(); });
  ExpectAllRanksThrow(
    [](FloatImage&, std::vector<int>& order, CompositeOptions&) {
      order = { 0, 0, 1 };
    });
  ExpectAllRanksThrow(
    [](FloatImage&, std::vector<int>& order, CompositeOptions&) {
      order = { 0, 1, 2 };
    });
  ExpectAllRanksThrow([](FloatImage&, std::vector<int>&, CompositeOptions& options)
    { options.Transport = PixelTransport::Floats; });
  ExpectAllRanksThrow([](FloatImage&, std::vector<int>&, CompositeOptions& options)
    { options.Footprints.pop_back(); });
  ExpectAllRanksThrow(
    [](FloatImage&, std::vector<int>&, CompositeOptions& options) { options.Footprints[1] = {}; });
  ExpectAllRanksThrow(
    [](FloatImage& mine, std::vector<int>&, CompositeOptions&)
    {
      mine.Rect.Lo.x -= 1;
      mine.Rect.Hi.x -= 1;
    });
}

} // namespace
} // namespace banyan::testing
