// SPDX-License-Identifier: BSD-3-Clause
// Load balancing on simulated costs: what a frame takes is known for each position, and nothing but
// what ranks would measure is told to the balancer.
#include "Parallel/Balance/LoadBalancer.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <random>

namespace banyan
{
namespace
{

constexpr int Cells = 128;
constexpr int Edge = 8;
/// So many that half of what is drawn is the limit on what may move.
constexpr double BytesPerPosition = 64.0;

/// What is seen from a place: less with the distance, and nothing on one side.
BrickCosts SeenFrom(const glm::dvec3& eye, double width)
{
  BrickCosts view(glm::ivec3(Cells), Edge);
  for (std::size_t i = 0; i < view.Values.size(); ++i)
  {
    const Box box = view.PositionsOf(i);
    const glm::dvec3 away = 0.5 * glm::dvec3(box.Lo + box.Hi) - eye;
    const double square = away.x * away.x + away.y * away.y + away.z * away.z;
    view.Values[i] = away.x + away.y < -0.6 * width ? 0.0 : std::exp(-square / (width * width));
  }
  return view;
}

/// How much there is to draw at each place: veins of another density.
BrickCosts Times(const BrickCosts& view, double vein)
{
  BrickCosts costs = view;
  for (std::size_t i = 0; i < costs.Values.size(); ++i)
  {
    const glm::dvec3 at(costs.PositionsOf(i).Lo);
    costs.Values[i] *= 1.0 + vein * std::sin(0.11 * at.x) * std::cos(0.13 * at.y + 0.07 * at.z);
  }
  return costs;
}

struct Frame
{
  BrickCosts View;
  BrickCosts Truth;           ///< work
  std::vector<double> Speeds; ///< of ranks; empty for 1
};

struct Outcome
{
  std::vector<double> Imbalance;
  std::vector<double> Slowest; ///< seconds
  std::vector<double> Moved;
  double LargestAllowed = 0;
};

/// @param noise of seconds
/// @param balanced whether planes move at all
Outcome Simulate(int ranks, int frames, const std::function<Frame(int)>& frameAt,
  double noise = 0.02, bool balanced = true)
{
  LoadBalancer::Options options;
  options.Positions = glm::ivec3(Cells);
  options.Ranks = ranks;
  options.BrickPositions = 8;
  options.BlockEdge = Edge;
  options.BytesPerPosition = BytesPerPosition;
  LoadBalancer balancer(options);
  const ZoneTree first = balancer.Tree();
  std::mt19937 random(7);
  std::normal_distribution<double> noisy(1.0, noise);
  Outcome outcome;
  outcome.LargestAllowed = 0.5 * BytesPerPosition * Cells * Cells * Cells;
  for (int number = 0; number < frames; ++number)
  {
    const Frame frame = frameAt(number);
    balancer.BeginFrame(frame.View);
    const CostSums truth(frame.Truth);
    std::vector<RankWork> took;
    std::vector<double> seconds;
    for (const Box& zone : ZonesOf(balanced ? balancer.Tree() : first))
    {
      const double speed = frame.Speeds.empty() ? 1.0 : frame.Speeds[took.size()];
      RankWork rank;
      rank.Work = truth.In(zone);
      rank.Seconds = rank.Work / speed * std::max(0.5, noisy(random));
      took.push_back(rank);
      seconds.push_back(rank.Seconds);
    }
    balancer.FrameTook(took, frame.Truth);
    outcome.Imbalance.push_back(ImbalanceOf(seconds));
    outcome.Slowest.push_back(*std::max_element(seconds.begin(), seconds.end()));
    outcome.Moved.push_back(balancer.BytesMoved());
    EXPECT_LE(balancer.BytesMoved(), outcome.LargestAllowed);
  }
  return outcome;
}

Outcome Unbalanced(int ranks, int frames, const std::function<Frame(int)>& frameAt)
{
  return Simulate(ranks, frames, frameAt, 0.02, false);
}

double Mean(const std::vector<double>& values, std::size_t from = 0)
{
  double sum = 0.0;
  for (std::size_t i = from; i < values.size(); ++i)
  {
    sum += values[i];
  }
  return sum / static_cast<double>(values.size() - from);
}

double Largest(const std::vector<double>& values, std::size_t from, std::size_t to)
{
  return *std::max_element(values.begin() + static_cast<std::ptrdiff_t>(from),
    values.begin() + static_cast<std::ptrdiff_t>(to));
}

Frame FrameFrom(const glm::dvec3& eye, double width, double vein = 0.4)
{
  Frame frame;
  frame.View = SeenFrom(eye, width);
  frame.Truth = Times(frame.View, vein);
  return frame;
}

class EveryRankCountBalanced : public ::testing::TestWithParam<int>
{
};

TEST_P(EveryRankCountBalanced, AtRestItSettlesAndStays)
{
  const Frame frame = FrameFrom({ 90, 70, 100 }, 45.0);
  const Outcome ours = Simulate(GetParam(), 200, [&](int) { return frame; });
  EXPECT_LE(Largest(ours.Imbalance, 5, 200), 1.15);
  EXPECT_LE(Mean(ours.Imbalance, 5), 1.10);
  EXPECT_EQ(Largest(ours.Moved, 20, 200), 0.0) << "planes still move at rest";
}

TEST_P(EveryRankCountBalanced, AfterJumpsItIsBalancedWithinFiveFrames)
{
  const glm::dvec3 eyes[] = { { 20, 20, 30 }, { 110, 100, 64 }, { 64, 10, 120 }, { 64, 64, 64 } };
  const auto frameAt = [&](int number)
  { return FrameFrom(eyes[number / 20 % 4], 40.0 + number / 20); };
  const Outcome ours = Simulate(GetParam(), 160, frameAt);
  for (std::size_t jump = 0; jump < 160; jump += 20)
  {
    EXPECT_LE(Largest(ours.Imbalance, jump + 5, jump + 20), 1.15) << jump;
  }
  const Outcome off = Unbalanced(GetParam(), 160, frameAt);
  EXPECT_LT(Mean(ours.Slowest), Mean(off.Slowest));
}

TEST_P(EveryRankCountBalanced, ARankThatIsSuddenlyFiveTimesSlowerGetsLess)
{
  const auto frameAt = [&](int number)
  {
    Frame frame = FrameFrom({ 64, 70, 50 }, 60.0);
    frame.Speeds.assign(static_cast<std::size_t>(GetParam()), 1.0);
    if (number >= 50 && number < 300)
    {
      frame.Speeds[frame.Speeds.size() / 2] = 0.2;
    }
    return frame;
  };
  const Outcome ours = Simulate(GetParam(), 500, frameAt);
  EXPECT_GT(ours.Imbalance[50], 1.5);
  // The slow rank's zone is thin: a position is more of it.
  EXPECT_LE(Mean({ ours.Imbalance.begin() + 57, ours.Imbalance.begin() + 300 }), 1.15);
  EXPECT_LE(Mean(ours.Imbalance, 310), 1.10);
  // Settled: what noise still moves is less than a thousandth.
  EXPECT_LE(
    Mean({ ours.Moved.begin() + 120, ours.Moved.begin() + 300 }), 1e-3 * ours.LargestAllowed);
  EXPECT_LE(Mean(ours.Moved, 380), 1e-3 * ours.LargestAllowed);
}

TEST_P(EveryRankCountBalanced, ARankThatBecomesSlowerIsHelpedSoonWheneverThatIs)
{
  const auto ranks = static_cast<std::size_t>(GetParam());
  for (int since = 2; since < 40; ++since)
  {
    const auto frameAt = [&](int number)
    {
      Frame frame = FrameFrom({ 64, 70, 50 }, 60.0);
      frame.Speeds.assign(ranks, 1.0);
      frame.Speeds[ranks / 2] = number >= since ? 0.2 : 1.0;
      return frame;
    };
    const Outcome ours = Simulate(GetParam(), since + 20, frameAt);
    EXPECT_LE(Mean(ours.Imbalance, static_cast<std::size_t>(since) + 8), 1.25) << since;
  }
}

TEST_P(EveryRankCountBalanced, CostsThatFlipMoveNothingForLong)
{
  const Frame one = FrameFrom({ 30, 40, 50 }, 30.0);
  const Frame other = FrameFrom({ 100, 90, 60 }, 30.0);
  // The view does not tell: another transfer function each frame.
  const auto frameAt = [&](int number)
  {
    Frame frame = number % 2 == 0 ? one : other;
    std::fill(frame.View.Values.begin(), frame.View.Values.end(), 1.0);
    return frame;
  };
  const Outcome ours = Simulate(GetParam(), 500, frameAt);
  EXPECT_LE(Mean(ours.Moved, 100), 0.01 * ours.LargestAllowed);
  const Outcome off = Unbalanced(GetParam(), 500, frameAt);
  EXPECT_LT(Mean(ours.Slowest), 1.02 * Mean(off.Slowest));
}

TEST_P(EveryRankCountBalanced, NearlyNothingVisibleIsNoReasonToMoveMuch)
{
  Frame hidden;
  hidden.View = BrickCosts(glm::ivec3(Cells), Edge);
  hidden.View.Values[hidden.View.NumberAt({ 9, 4, 11 })] = 1.0;
  hidden.Truth = hidden.View;
  const Outcome ours = Simulate(GetParam(), 500, [&](int) { return hidden; });
  // One block among them: all positions of it go round once.
  EXPECT_LE(Mean(ours.Moved) * 500.0, 40.0 * BytesPerPosition * Edge * Edge * Edge);
  EXPECT_EQ(Largest(ours.Moved, 50, 500), 0.0);
  // Nothing at all, and then something again.
  const Frame shown = FrameFrom({ 64, 70, 50 }, 60.0);
  Frame nothing = shown;
  std::fill(nothing.View.Values.begin(), nothing.View.Values.end(), 0.0);
  nothing.Truth = nothing.View;
  const Outcome back =
    Simulate(GetParam(), 60, [&](int number) { return number / 20 % 2 == 0 ? nothing : shown; });
  EXPECT_LE(Largest(back.Imbalance, 25, 40), 1.15);
}

TEST_P(EveryRankCountBalanced, ACameraThatJumpsAtRandomCostsNoMemoryAndIsStillBetterThanNothing)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> place(0.0, Cells);
  std::vector<Frame> frames;
  for (int i = 0; i < 50; ++i)
  {
    const double x = place(random);
    const double y = place(random);
    frames.push_back(FrameFrom({ x, y, place(random) }, 40.0));
  }
  std::vector<std::size_t> held;
  const auto frameAt = [&](int number)
  {
    if (number == 100 || number == 499)
    {
      held.push_back(mallinfo2().uordblks);
    }
    return frames[static_cast<std::size_t>(number * 7 % 50)];
  };
  const Outcome ours = Simulate(GetParam(), 500, frameAt);
  ASSERT_EQ(held.size(), 2u);
  EXPECT_LT(held[1], held[0] + 65536); // the test's own lists grow a little
  const Outcome off = Unbalanced(GetParam(), 500, frameAt);
  EXPECT_LT(Mean(ours.Slowest), Mean(off.Slowest));
}

TEST_P(EveryRankCountBalanced, NoiseMovesNothing)
{
  // Costs that nothing tells: others each frame.
  std::mt19937 random(13);
  const Frame frame = FrameFrom({ 64, 70, 50 }, 60.0);
  const auto frameAt = [&](int)
  {
    Frame noisy = frame;
    for (double& cost : noisy.Truth.Values)
    {
      cost *= random() % 3;
    }
    return noisy;
  };
  const Outcome ours = Simulate(GetParam(), 200, frameAt, 0.05);
  EXPECT_LE(Mean(ours.Moved, 50), 0.02 * ours.LargestAllowed);
}

TEST_P(EveryRankCountBalanced, SecondsThatAreOffByAFifthMoveNothingAtRest)
{
  const Frame frame = FrameFrom({ 64, 70, 50 }, 60.0);
  const Outcome ours = Simulate(
    GetParam(), 300, [&](int) { return frame; }, 0.2);
  const auto moved = std::count_if(
    ours.Moved.begin() + 40, ours.Moved.end(), [](double bytes) { return bytes > 0.0; });
  EXPECT_LE(moved, 13) << "frames of 260";
}

INSTANTIATE_TEST_SUITE_P(Ranks, EveryRankCountBalanced, ::testing::Values(2, 5, 16));

TEST(LoadBalancer, RefusesWhatBelongsToOtherZones)
{
  LoadBalancer::Options options;
  options.Positions = glm::ivec3(16);
  options.Ranks = 2;
  LoadBalancer balancer(options);
  EXPECT_THROW(balancer.BeginFrame(BrickCosts(glm::ivec3(17), 8)), Error);
  EXPECT_THROW(balancer.BeginFrame(BrickCosts(glm::ivec3(16), 4)), Error);
  const BrickCosts view(glm::ivec3(16), 8);
  balancer.BeginFrame(view);
  EXPECT_THROW(balancer.FrameTook({ {} }, view), Error);
  EXPECT_THROW(balancer.FrameTook({ {}, {} }, BrickCosts(glm::ivec3(16), 4)), Error);
  options.Ranks = 0;
  EXPECT_THROW(LoadBalancer{ options }, Error);
}

TEST(LoadBalancer, BlocksAreFew)
{
  EXPECT_EQ(BlockEdgeFor(glm::ivec3(1)), 8);
  EXPECT_EQ(BlockEdgeFor(glm::ivec3(128)), 8);
  EXPECT_EQ(BlockEdgeFor(glm::ivec3(129)), 16);
  EXPECT_EQ(BlockEdgeFor(glm::ivec3(1024)), 64);
  EXPECT_EQ(BlockEdgeFor(glm::ivec3(4096, 128, 8)), 16);
}

} // namespace
} // namespace banyan
