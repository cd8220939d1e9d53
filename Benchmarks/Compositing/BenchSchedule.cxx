// How long one rank takes to derive the schedule of all, from the footprints of a recorded frame.
//
//   banyan-bench-schedule FRAME...
//
// Prints a line per frame: the ranks, and the least and the middle time of many runs in
// microseconds, on one thread. Frames come from banyan-record-frames.
#include "FrameFile.h"

#include "Parallel/CompositePlan.h"

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

double MicrosecondsOfOne(const FrameHead& head)
{
  using Clock = std::chrono::steady_clock;
  const Clock::time_point begin = Clock::now();
  const CompositePlan plan = PlanCompositing(head.Footprints, head.Viewport, PixelRect{}, true);
  const double elapsed = std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
  if (plan.Ranks != static_cast<int>(head.Order.size()))
  {
    std::abort();
  }
  return elapsed;
}

void Measure(const char* path)
{
  const FrameReader frame(path);
  constexpr int runs = 201;
  std::vector<double> times(runs);
  for (double& time : times)
  {
    time = MicrosecondsOfOne(frame.Head());
  }
  std::sort(times.begin(), times.end());
  std::printf("%zu ranks: %.0f us at least, %.0f us in the middle\n", frame.Head().Order.size(),
    times.front(), times[runs / 2]);
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
