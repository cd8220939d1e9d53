// SPDX-License-Identifier: BSD-3-Clause
// Many frames on the ranks of this job whose costs are uneven in ways that nobody can foresee: what
// becomes of balance, of what moves, and of memory. See "Stability" in
// Documentation/measurements/balancing.md.
#include "MpiProgram.h"

#include "Base/Timer.h"
#include "Parallel/Balance/Rebalance.h"
#include "Parallel/Fields/PieceField.h"
#include "Parallel/Fields/Pieces.h"
#include "Parallel/Frame/DistributedFrame.h"

#include <malloc.h>
#include <time.h>

#include <algorithm>
#include <random>

namespace
{

using namespace banyan;
using namespace banyan::testing;

constexpr int BrickCells = 8;
constexpr std::uint64_t Budget = 1u << 20;
const glm::ivec3 Samples{ 65, 61, 57 };
const glm::ivec2 Size{ 192, 160 }; // ranks take a millisecond: less says little of who is slow
constexpr int SlowRank = 1;
constexpr double TimesSlower = 5.0;

enum class Story
{
  SlowRank,     ///< from a fifth on a rank takes five times as long, until three fifths
  Flips,        ///< in each frame other parts of the volume can be seen
  NearlyHidden, ///< from a fifth on hardly anything can be seen, until three fifths
  Jumps,        ///< the camera is somewhere else in each frame
  Count
};

const char* NameOf(Story story)
{
  static const char* const names[] = { "slow rank", "flips", "nearly hidden", "jumps" };
  return names[static_cast<int>(story)];
}

/// Whether the middle of a story is told in the frame.
bool IsMiddle(int frame, int frames)
{
  return frame >= frames / 5 && frame < 3 * frames / 5;
}

double SecondsOfThread()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Of a rank that is slower: asked when rays begin to be cast and when they have been, it works on
/// until that took five times as long.
double SlowSeconds()
{
  static bool begun = false;
  static double since = 0.0;
  const double now = SecondsOfThread();
  begun = !begun;
  if (begun)
  {
    since = now;
    return now;
  }
  while (SecondsOfThread() < since + TimesSlower * (now - since))
  {
  }
  return SecondsOfThread();
}

RayScene SceneOf(Story story, int frame, int frames)
{
  glm::dmat4 turned(1.0);
  double distance = 0.9;
  if (story == Story::Jumps)
  {
    std::mt19937 random(static_cast<unsigned>(frame));
    const auto unit = [&] { return static_cast<double>(random() % 1000) / 1000.0; };
    const glm::dvec3 middle = 0.5 * glm::dvec3(Samples - 1);
    turned = glm::translate(glm::dmat4(1.0), middle);
    turned = glm::rotate(turned, 6.28 * unit(), glm::dvec3(0.0, 1.0, 0.0));
    turned = glm::rotate(turned, 3.14 * unit(), glm::dvec3(1.0, 0.0, 0.0));
    turned = glm::translate(turned, -middle);
    distance = 0.1 + 1.2 * unit();
  }
  RayScene scene = scenes::Scene(Samples, Size, turned, distance);
  scene.Transfer = scenes::Tabulate(scenes::Sparse);
  const bool even = frame % 2 == 0;
  for (std::size_t i = 0; i < scene.Transfer.Entries.size(); ++i)
  {
    const double value =
      static_cast<double>(i) / static_cast<double>(scene.Transfer.Entries.size());
    const bool hidden = story == Story::Flips
                          ? (value < 0.45) == even
                          : story == Story::NearlyHidden && IsMiddle(frame, frames) && value < 0.9;
    scene.Transfer.Entries[i].a = hidden ? 0.0f : scene.Transfer.Entries[i].a;
  }
  return scene;
}

/// Of the heap, in use.
double HeapBytes()
{
  const struct mallinfo2 heap = mallinfo2();
  return static_cast<double>(heap.uordblks) + static_cast<double>(heap.hblkhd);
}

/// What became of a story.
struct Outcome
{
  std::vector<double> Imbalance;
  std::vector<double> Moved; ///< bytes
  std::vector<double> Heap;  ///< of all ranks
  double Seconds = 0.0;
  std::string Wrong;
};

double Mean(const std::vector<double>& values, int from, int to)
{
  double sum = 0.0;
  for (int i = from; i < to; ++i)
  {
    sum += values[static_cast<std::size_t>(i)];
  }
  return sum / (to - from);
}

/// Collective. Some pictures are compared with those of one rank.
Outcome Tell(Communicator& communicator, const std::vector<float>& values, Story story, int frames)
{
  const std::vector<Box> dealt = pieces::Dealt(pieces::Deal::Blocks, Samples, communicator.Size());
  const pieces::Piece<float> mine(
    values, Samples, dealt[static_cast<std::size_t>(communicator.Rank())]);
  ThreadPool pool(1);
  PieceField field;
  field.Take(
    communicator, dealt, mine.Array, Samples - 1, BrickCells, LoadBalancing::MeasuredCost, pool);
  const std::unique_ptr<Communicator> alone = MakeSelfCommunicator();
  ArrayBrickSource whole(scenes::ArrayOf(values, Samples), BrickCells, MaskRange{ 0.0, 1.0 }, pool);
  Outcome outcome;
  const Timer timer;
  for (int frame = 0; frame < frames; ++frame)
  {
    RayScene scene = SceneOf(story, frame, frames);
    field.BeginFrame(communicator, scene, Budget);
    BrickWork* const work = scene.Work;
    if (work)
    {
      const bool slow = story == Story::SlowRank && communicator.Rank() == SlowRank;
      work->Clock = slow && IsMiddle(frame, frames) ? SlowSeconds : SecondsOfThread;
    }
    FrameStatistics statistics;
    const FloatImage picture = DrawDistributed(
      communicator, scene, { field.Source(), field.Zones(), Budget, pool }, statistics);
    outcome.Imbalance.push_back(
      ImbalanceOf(AllGatherValues(communicator, work ? work->DrawSeconds : 1.0)));
    field.EndFrame(communicator);
    outcome.Moved.push_back(static_cast<double>(field.FrameStatistics().BytesMoved));
    if (field.FetchedBytes() > Budget)
    {
      outcome.Wrong = "more was fetched than the budget holds";
    }
    if (communicator.Rank() == 0 && frame % std::max(1, frames / 10) == 0)
    {
      scene.Work = nullptr;
      FrameStatistics ignored;
      const FloatImage right =
        DrawDistributed(*alone, scene, { &whole, { scene.DomainCells }, Budget, pool }, ignored);
      if (MaxDifference(right, picture) > 1e-5)
      {
        outcome.Wrong = "frame " + std::to_string(frame) + " is not that of one rank";
      }
    }
    outcome.Heap.push_back(AllSum(communicator, HeapBytes()));
  }
  outcome.Seconds = timer.Seconds();
  return outcome;
}

/// What is wrong with a story, on any rank: all know the same numbers.
std::string Judge(const Outcome& outcome, Story story, int frames)
{
  std::string wrong = outcome.Wrong;
  const double volume = 4.0 * Samples.x * Samples.y * Samples.z;
  if (Mean(outcome.Moved, frames / 2, frames) > 0.25 * volume)
  {
    wrong += " planes run to and fro";
  }
  // From here on all stories go on as they have begun.
  if (Mean(outcome.Heap, 9 * frames / 10, frames) >
      1.02 * Mean(outcome.Heap, 13 * frames / 20, 3 * frames / 4))
  {
    wrong += " memory grows";
  }
  if (story == Story::SlowRank && Mean(outcome.Imbalance, 2 * frames / 5, 3 * frames / 5) > 1.5)
  {
    wrong += " the slow rank was not helped";
  }
  return wrong.empty() ? "" : std::string(NameOf(story)) + ": " + wrong;
}

std::string TellAll(Communicator& communicator, int frames)
{
  const std::vector<float> values = scenes::Sampled<float>(scenes::Standard, Samples);
  std::string wrong;
  for (int number = 0; number < static_cast<int>(Story::Count); ++number)
  {
    const auto story = static_cast<Story>(number);
    const Outcome outcome = Tell(communicator, values, story, frames);
    wrong += Judge(outcome, story, frames);
    if (communicator.Rank() == 0)
    {
      const auto half = outcome.Moved.begin() + frames / 2;
      std::printf("%-13s %3d frames on %2d ranks, %5.1f ms each: imbalance %.2f, in the middle "
                  "%.2f, at the end %.2f; moved %6.1f kB per frame, in the second half %6.1f in %d "
                  "frames, at most %.0f; heap %.1f MB after two thirds, %.1f at the end\n",
        NameOf(story), frames, communicator.Size(), 1e3 * outcome.Seconds / frames,
        Mean(outcome.Imbalance, 0, frames), Mean(outcome.Imbalance, 2 * frames / 5, 3 * frames / 5),
        Mean(outcome.Imbalance, 4 * frames / 5, frames), 1e-3 * Mean(outcome.Moved, 0, frames),
        1e-3 * Mean(outcome.Moved, frames / 2, frames),
        static_cast<int>(
          std::count_if(half, outcome.Moved.end(), [](double b) { return b > 0.0; })),
        1e-3 * *std::max_element(outcome.Moved.begin(), outcome.Moved.end()),
        1e-6 * outcome.Heap[static_cast<std::size_t>(2 * frames / 3)], 1e-6 * outcome.Heap.back());
    }
  }
  return wrong;
}

} // namespace

/// @param argv[1] the number of ranks there must be
/// @param argv[2] frames of each story
int main(int argc, char** argv)
{
  const int frames = argc > 2 ? std::max(20, std::atoi(argv[2])) : 60;
  return RunOnMpiRanks(argc, argv, 75 + static_cast<unsigned>(frames),
    [&](Communicator& communicator)
    {
      const std::string wrong = CheckRankCount(communicator, argc, argv);
      return wrong.empty() ? TellAll(communicator, frames) : wrong;
    });
}
