// SPDX-License-Identifier: BSD-3-Clause
// The peers of the compositor make the picture that it makes.
#include "CompositingCases.h"
#include "Peers/PeerFrame.h"

#include "Parallel/Composite/FragmentMessage.h"

#include <gtest/gtest.h>

#include <mutex>

namespace banyan::bench
{
namespace
{

using namespace banyan::testing;

using Method = FloatImage (*)(Communicator&, const PeerFrame&, CompositeStatistics&);
constexpr Method Methods[] = { CompositeSlicAsPublished, CompositeDirectSend, CompositeBinarySwap };

FragmentFormat FormatOf(std::uint8_t kind)
{
  FragmentFormat format;
  format.Kind = kind;
  return format;
}

PeerFrame FrameOf(const PreparedCase& prepared, int rank, std::uint8_t kind)
{
  PeerFrame frame{ prepared.Images[static_cast<std::size_t>(rank)], prepared.Order,
    prepared.Viewport, {}, FormatOf(kind) };
  for (const FloatImage& image : prepared.Images)
  {
    frame.Footprints.push_back(
      FootprintOf(ActiveRect(image, prepared.Viewport), prepared.Viewport));
  }
  return frame;
}

/// @return what is wrong with the pictures of all methods, or an empty string
std::string CheckAll(const PreparedCase& prepared, std::uint8_t kind)
{
  std::mutex mutex;
  std::string wrong;
  RunOnSimulatedRanks(static_cast<int>(prepared.Images.size()),
    [&](Communicator& communicator)
    {
      for (const Method method : Methods)
      {
        CompositeStatistics statistics;
        const FloatImage picture =
          method(communicator, FrameOf(prepared, communicator.Rank(), kind), statistics);
        const std::string here =
          CheckPicture(communicator, prepared, picture, kind == FragmentFormat::Floats);
        const std::lock_guard<std::mutex> lock(mutex);
        wrong += here;
      }
    });
  return wrong;
}

class CompositingPeers : public ::testing::TestWithParam<int>
{
};

TEST_P(CompositingPeers, MakeThePictureOfOneRank)
{
  for (int which = 0; which < static_cast<int>(Case::Count); ++which)
  {
    for (const PixelRect& viewport : Viewports())
    {
      const PreparedCase prepared(
        static_cast<Case>(which), GetParam(), viewport, Combination::Over);
      EXPECT_EQ(CheckAll(prepared, FragmentFormat::Floats), "");
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Ranks, CompositingPeers, ::testing::Range(1, 17));

TEST(CompositingPeers, InBytesAreRightForFewRanksOnly)
{
  const PixelRect viewport{ { 0, 0 }, { 45, 40 } };
  EXPECT_EQ(
    CheckAll({ Case::AllOverlap, 2, viewport, Combination::Over }, FragmentFormat::Bytes), "");
  // The compositor has finer steps for that.
  EXPECT_NE(
    CheckAll({ Case::AllOverlap, 64, viewport, Combination::Over }, FragmentFormat::Bytes), "");
}

/// Pixel by pixel, front to back, in floats: as one rank blends.
PixelVector BlendedAsOneRank(const PreparedCase& prepared)
{
  PixelVector picture(static_cast<std::size_t>(prepared.Viewport.Count()), glm::vec4(0.0f));
  for (const int rank : prepared.Order)
  {
    const FloatImage& image = prepared.Images[static_cast<std::size_t>(rank)];
    for (std::size_t i = 0; i < image.Pixels.size(); ++i)
    {
      picture[i] = Combined(picture[i], image.Pixels[i], Combination::Over);
    }
  }
  return picture;
}

TEST(DirectSend, HasTheBitsOfOneRankAndSendsOnlyWhatIsDrawn)
{
  const PixelRect viewport{ { 0, 0 }, { 64, 64 } };
  const auto pixels = static_cast<double>(viewport.Count() * sizeof(glm::vec4));
  const PreparedCase prepared(Case::AllOverlap, 4, viewport, Combination::Over);
  std::mutex mutex;
  double bytes = 0.0;
  RunOnSimulatedRanks(4,
    [&](Communicator& communicator)
    {
      CompositeStatistics statistics;
      const FloatImage picture = CompositeDirectSend(
        communicator, FrameOf(prepared, communicator.Rank(), FragmentFormat::Floats), statistics);
      EXPECT_TRUE(communicator.Rank() != 0 || picture.Pixels == BlendedAsOneRank(prepared));
      const std::lock_guard<std::mutex> lock(mutex);
      bytes += static_cast<double>(statistics.BytesSent);
    });
  // Three quarters of each of 4 images go to the owners of the strips, 3 strips go to the root.
  EXPECT_NEAR(bytes, pixels * (3.0 + 0.75), pixels * 0.05);
}

} // namespace
} // namespace banyan::bench
