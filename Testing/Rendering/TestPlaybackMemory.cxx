// SPDX-License-Identifier: BSD-3-Clause
// Playing a long series keeps memory flat: at most the cache's budget and one decoded step more
// than after the first frame.

#include "MapperTesting.h"

#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanVolumeMapper.h"

#include <atomic>
#include <fstream>
#include <thread>

#include <malloc.h>

using namespace mapper_testing;

namespace
{

constexpr int Steps = 50;
const glm::ivec3 Samples{ 128, 128, 128 };
constexpr std::uint64_t StepBytes = 128ull * 128 * 128 * sizeof(float);
constexpr std::uint64_t Budget = 4u << 20;
/// Tables of a few steps, and what the allocator keeps.
constexpr std::uint64_t Slack = 4u << 20;

/// Anonymous memory that is resident now: mapped files do not count.
std::uint64_t ResidentBytes()
{
  std::ifstream status("/proc/self/status");
  std::string word;
  while (status >> word)
  {
    if (word == "RssAnon:")
    {
      std::uint64_t kibibytes = 0;
      status >> kibibytes;
      return kibibytes << 10;
    }
  }
  return 0;
}

/// Watches resident memory from a thread of its own.
class PeakWatch
{
public:
  PeakWatch()
    : Thread(
        [this]
        {
          while (!this->Stop)
          {
            this->Peak = std::max<std::uint64_t>(this->Peak, ResidentBytes());
            std::this_thread::sleep_for(std::chrono::microseconds(500));
          }
        })
  {
  }
  std::uint64_t Finish()
  {
    this->Stop = true;
    this->Thread.join();
    return this->Peak;
  }

private:
  std::atomic<bool> Stop{ false };
  std::atomic<std::uint64_t> Peak{ 0 };
  std::thread Thread;
};

/// Plays all steps; with `touch` a filter's access decodes every step as a whole.
void Play(const std::string& path, bool touch)
{
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName(path.c_str());
  reader->SetCacheBudget(Budget >> 20);
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputConnection(reader->GetOutputPort());
  Stage stage(mapper);
  const double bounds[6] = { 0, 127, 0, 127, 0, 127 };
  stage.LookAt(bounds);
  reader->UpdateTimeStep(0);
  stage.Draw();
  malloc_trim(0);
  const std::uint64_t before = ResidentBytes();
  PeakWatch watch;
  double sum = 0.0;
  for (int step = 1; step < Steps; ++step)
  {
    reader->UpdateTimeStep(step);
    if (touch)
    {
      sum += reader->GetOutput()->GetPointData()->GetScalars()->GetTuple1(1000);
    }
    stage.Draw();
    Check(static_cast<std::uint64_t>(mapper->GetStatistics()->GetCacheBytes()) <= Budget,
      "the cache keeps its budget");
  }
  const std::uint64_t peak = watch.Finish();
  const std::uint64_t allowed = before + Budget + (touch ? StepBytes : 0) + Slack;
  std::cout << (touch ? "touched: " : "drawn: ") << (before >> 20) << " MiB after one frame, peak "
            << (peak >> 20) << " MiB, allowed " << (allowed >> 20) << " MiB (" << sum << ")\n";
  Check(peak <= allowed, "playing stays within the budget and one decoded step");
  Check(mapper->GetStatistics()->GetBricksDrawn() > 0, "something is drawn");
}

} // namespace

int main()
{
  // What the allocator keeps for itself would blur the picture: one arena, large blocks returned.
  mallopt(M_ARENA_MAX, 1);
  mallopt(M_MMAP_THRESHOLD, 1 << 18);
  const TemporaryFolder folder;
  const std::string path = folder / "series.banyan";
  WriteSeries(path, Balls, Samples, Steps, 1.0 / 512.0);
  Play(path, false);
  Play(path, true);
  return Failures();
}
