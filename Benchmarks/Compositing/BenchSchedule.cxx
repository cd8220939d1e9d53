// SPDX-License-Identifier: BSD-3-Clause
// How long one rank takes to derive the schedule of all, from the footprints of a recorded frame.
//
//   banyan-bench-schedule FRAME...
//
// Prints a line per frame: the ranks, and the least and the middle time of many runs in
// microseconds, on one thread; then what it takes to see that the schedule of the frame before
// will do. Frames come from banyan-record-frames.
#include "FrameFile.h"

#include "Parallel/Composite/CompositePlanCache.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <vector>

namespace
{

using namespace banyan;
using namespace banyan::bench;

/// @param plans with the schedule in it, or without
double MicrosecondsOfOne(const FrameHead& head, CompositePlanCache& plans)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const std::shared_ptr<const CompositePlan> plan =
    plans.Of(head.Footprints, head.Viewport, PixelRect{}, true);
  const double elapsed = std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
  if (plan->Ranks != static_cast<int>(head.Order.size()))
  {
    std::abort();
  }
  return elapsed;
}

void Measure(const char* path)
{
  const FrameReader frame(path);
  constexpr int runs = 201;
  std::vector<double> derived;
  std::vector<double> kept;
  for (int run = 0; run < runs; ++run)
  {
    CompositePlanCache plans;
    derived.push_back(MicrosecondsOfOne(frame.Head(), plans));
    kept.push_back(MicrosecondsOfOne(frame.Head(), plans));
  }
  std::sort(derived.begin(), derived.end());
  std::sort(kept.begin(), kept.end());
  std::printf("%zu ranks: %.0f us at least, %.0f us in the middle; kept, %.1f and %.1f us\n",
    frame.Head().Order.size(), derived.front(), derived[runs / 2], kept.front(), kept[runs / 2]);
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    for (int i = 1; i < argc; ++i)
    {
      Measure(argv[i]);
    }
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    return EXIT_FAILURE;
  }
}
