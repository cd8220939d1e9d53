// SPDX-License-Identifier: BSD-3-Clause
// A series that plays, and a camera that moves, find bricks decoded, and look as they do without.

#include "MapperTesting.h"

#include "Base/Timer.h"
#include "Cache/BrickCache.h"
#include "Series/Decode/CacheContext.h"
#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanSeriesReader.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkRenderer.h"

#include <algorithm>
#include <chrono>
#include <thread>

using namespace mapper_testing;

namespace
{

constexpr int Steps = 14;
const glm::ivec3 Samples{ 129, 129, 129 };
/// In which a display shows a picture, and nobody draws.
constexpr auto Shown = std::chrono::milliseconds(60);

struct Outcome
{
  std::vector<std::vector<unsigned char>> Pictures;
  std::vector<double> Milliseconds; ///< of frames
  double Ahead = 0;                 ///< bricks that were decoded before they were asked for
  double Asked = 0;                 ///< all bricks, from the third step on
};

Outcome Play(const std::string& path, bool ahead, bool backwards)
{
  banyan::BrickCache::Of(*banyan::CacheContext::Process()).Clear();
  Outcome outcome;
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName(path.c_str());
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputConnection(reader->GetOutputPort());
  mapper->SetReadAhead(ahead);
  mapper->SetSampleDistanceVoxels(1.0);
  Stage stage(mapper);
  const double bounds[6] = { 0, 128, 0, 128, 0, 128 };
  stage.LookAt(bounds);
  for (int i = 0; i < Steps; ++i)
  {
    reader->UpdateTimeStep(backwards ? Steps - 1 - i : i);
    const banyan::Timer timer;
    outcome.Pictures.push_back(stage.Draw());
    outcome.Milliseconds.push_back(1e3 * timer.Seconds());

    vtkBanyanFrameStatistics* const numbers = mapper->GetStatistics();
    outcome.Ahead += static_cast<double>(numbers->GetCacheHitsAhead());
    outcome.Asked +=
      i < 2 ? 0.0 : static_cast<double>(numbers->GetCacheHits() + numbers->GetCacheMisses());
    std::this_thread::sleep_for(Shown);
  }
  return outcome;
}

/// A camera that is close to the volume turns past it, from one side to the other.
Outcome Turn(const std::string& path, bool ahead)
{
  banyan::BrickCache::Of(*banyan::CacheContext::Process()).Clear();
  Outcome outcome;
  vtkNew<vtkBanyanSeriesReader> reader;
  reader->SetFileName(path.c_str());
  vtkNew<vtkBanyanVolumeMapper> mapper;
  mapper->SetInputConnection(reader->GetOutputPort());
  mapper->SetReadAhead(ahead);
  mapper->SetSampleDistanceVoxels(1.0);
  Stage stage(mapper);
  const double bounds[6] = { 0, 128, 0, 128, 0, 128 };
  stage.LookAt(bounds);
  vtkCamera* const camera = stage.Renderer->GetActiveCamera();
  camera->Zoom(4.0);
  camera->Yaw(-10.0);
  for (int i = 0; i < Steps; ++i)
  {
    const banyan::Timer timer;
    outcome.Pictures.push_back(stage.Draw());
    outcome.Milliseconds.push_back(1e3 * timer.Seconds());
    vtkBanyanFrameStatistics* const numbers = mapper->GetStatistics();
    outcome.Ahead += static_cast<double>(numbers->GetCacheHitsAhead());
    outcome.Asked += i < 2 ? 0.0 : static_cast<double>(numbers->GetCacheMisses());
    std::this_thread::sleep_for(Shown);
    camera->Yaw(1.5);
  }
  return outcome;
}

double Median(std::vector<double> values)
{
  values.erase(values.begin(), values.begin() + 2);
  std::sort(values.begin(), values.end());
  return values[values.size() / 2];
}

} // namespace

int main()
{
  const TemporaryFolder folder;
  const std::string path = folder / "series.banyan";
  WriteSeries(path, Balls, Samples, Steps, 1.0 / 2048.0);
  for (const bool backwards : { false, true })
  {
    const Outcome without = Play(path, false, backwards);
    const Outcome with = Play(path, true, backwards);
    Check(without.Ahead == 0.0, "nothing is decoded ahead where that is not wanted");
    std::cout << (backwards ? "backwards: " : "forwards: ") << with.Ahead << " of " << with.Asked
              << " bricks were decoded ahead; " << Median(with.Milliseconds)
              << " ms per frame, without " << Median(without.Milliseconds) << "\n";
    Check(with.Asked > 100.0, "bricks are asked for");
    // How many depends on what else the machine does: the threads that work ahead have low
    // priority.
    Check(with.Ahead > 0.0, "bricks are decoded when they are asked for");
    for (int i = 0; i < Steps; ++i)
    {
      Check(Difference(without.Pictures[i], with.Pictures[i]) == 0, "the pictures are the same");
      Check(Covered(with.Pictures[i]) > 1000, "something is drawn");
    }
  }
  const Outcome without = Turn(path, false);
  const Outcome with = Turn(path, true);
  std::cout << "turning: " << with.Ahead << " of " << without.Asked
            << " bricks that came onto the screen were decoded ahead; " << Median(with.Milliseconds)
            << " ms per frame, without " << Median(without.Milliseconds) << "\n";
  Check(without.Asked > 20.0, "bricks come onto the screen");
  Check(with.Ahead > 0.0, "bricks that come onto the screen are decoded when they are asked for");
  for (int i = 0; i < Steps; ++i)
  {
    Check(Difference(without.Pictures[i], with.Pictures[i]) == 0, "the pictures are the same");
    Check(Covered(with.Pictures[i]) > 1000, "something is drawn");
  }
  return Failures();
}
