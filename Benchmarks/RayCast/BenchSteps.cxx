// SPDX-License-Identifier: BSD-3-Clause
// How good is a coarse picture, and what does it take? One line of CSV for each level, distance
// between samples and gap between rays, of the standard scenes, and of flat ones with four times
// as many samples along two axes and a quarter along the third. See README.md.
//
//   banyan-bench-steps [SAMPLES [PIXELS]]
#include "Picture.h"
#include "StandardScenes.h"

#include "Base/ThreadPool.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"
#include "Render/Sampling/InteractiveLevels.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <memory>
#include <vector>

namespace
{

using namespace banyan;
using namespace banyan::bench;

constexpr int CoarsestLevel = 3;
constexpr int Repeats = 3;

/// Of all threads: other programs on the machine hardly count.
double CpuMilliseconds()
{
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

struct Drawn
{
  RaySampling Sampling;
  FloatImage Picture;
  double Milliseconds = 0.0;
  double Decibels = 0.0;
};

class Drawer
{
public:
  Drawer(const BenchScene& scene, ArrayBrickSource& source)
    : Scene(scene)
    , Source(source)
  {
  }

  /// The quickest of several times.
  Drawn Draw(const RaySampling& sampling)
  {
    RayScene scene = ToRayScene(this->Scene, 1.0, 1.0f - 1.0f / 255.0f);
    scene.Samplings = std::make_shared<const TileSamplings>(
      scene.Camera.ImageSize(), std::vector<RaySampling>{ sampling });
    Drawn drawn{ sampling, {} };
    for (int i = 0; i < Repeats; ++i)
    {
      RayStatistics statistics;
      const double began = CpuMilliseconds();
      drawn.Picture = CastRays(
        scene, this->Source, scene.DomainCells, ~std::uint64_t{ 0 }, this->One, statistics);
      InterpolateSkippedPixels(scene, drawn.Picture, this->One);
      const double taken = CpuMilliseconds() - began;
      drawn.Milliseconds = i == 0 ? taken : std::min(drawn.Milliseconds, taken);
    }
    return drawn;
  }

private:
  const BenchScene& Scene;
  ArrayBrickSource& Source;
  ThreadPool One{ 1 };
};

/// The number of the step that has this sampling, or -1.
int StepOf(const RaySampling& sampling)
{
  for (int step = 0; step <= InteractiveLevels::Last(CoarsestLevel); ++step)
  {
    if (InteractiveLevels::SamplingOf(step, 1.0, CoarsestLevel) == sampling)
    {
      return step;
    }
  }
  return -1;
}

void Measure(const BenchScene& scene, ThreadPool& all)
{
  const SampleArray array = scene.Data->Array();
  const ValueRange range = FiniteRange(array, all);
  const auto source =
    std::make_unique<ArrayBrickSource>(array, BrickCells, MaskRange{ range.Low, range.High }, all);
  Drawer drawer(scene, *source);
  const FloatImage reference = drawer.Draw({ 0, 0.25, 1 }).Picture;
  std::vector<Drawn> pictures;
  for (int level = 0; level <= CoarsestLevel; ++level)
  {
    for (const double distance : { 1.0, 2.0 })
    {
      for (int stride = 1; stride <= RaySampling::LargestStride; stride *= 2)
      {
        Drawn drawn = drawer.Draw({ level, distance * (1 << level), stride });
        drawn.Decibels = ErrorOf(drawn.Picture, reference).PsnrDecibels;
        drawn.Picture = {};
        pictures.push_back(std::move(drawn));
      }
    }
  }
  for (const Drawn& one : pictures)
  {
    const bool best = std::none_of(pictures.begin(), pictures.end(),
      [&](const Drawn& other)
      { return other.Milliseconds < one.Milliseconds && other.Decibels >= one.Decibels; });
    std::printf("%s,%d,%g,%d,%d,%.1f,%.1f,%d\n", scene.Name.c_str(), one.Sampling.Level,
      one.Sampling.Distance, one.Sampling.PixelStride, StepOf(one.Sampling), one.Milliseconds,
      one.Decibels, best ? 1 : 0);
  }
  std::fflush(stdout);
}

} // namespace

int main(int count, char** arguments)
{
  const int samples = count > 1 ? std::atoi(arguments[1]) : 256;
  const int pixels = count > 2 ? std::atoi(arguments[2]) : 1024;
  if (samples < 16 || pixels < 16)
  {
    std::fprintf(stderr, "banyan-bench-steps [SAMPLES [PIXELS]]: at least 16 of both per axis\n");
    return EXIT_FAILURE;
  }
  ThreadPool all(ThreadPool::DefaultWidth());
  std::printf("scene,level,distance_voxels,stride,step,cpu_ms,psnr_db,best\n");
  for (const int thinner : { 1, 16 })
  {
    const auto volume = StandardVolume(samples * (thinner > 1 ? 4 : 1), all, thinner);
    for (const StandardFunction function : { StandardFunction::S1, StandardFunction::S2 })
    {
      for (const bool shaded : { false, true })
      {
        Measure(StandardScene(volume, function, shaded, pixels), all);
      }
    }
  }
  return EXIT_SUCCESS;
}
