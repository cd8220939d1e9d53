// SPDX-License-Identifier: BSD-3-Clause
// How long is the search for the bricks of a frame, in a volume that no memory could hold? One line
// of CSV for each part of it. See README.md.
#include "MadeUpBricks.h"
#include "OptionValues.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Parallel/Balance/FrameCost.h"
#include "Parallel/Balance/LoadBalancer.h"
#include "Parallel/Fields/DrawnField.h"
#include "Render/Bricks/VisibleBricks.h"
#include "Render/Levels/LevelCaster.h"
#include "Render/Sampling/SamplingPlan.h"

#include <glm/gtc/matrix_transform.hpp>
#include <malloc.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <exception>
#include <functional>
#include <string>
#include <vector>

namespace
{

using namespace banyan;
using namespace banyan::bench;

const char* Help =
  "banyan-bench-descent [OPTIONS]\n"
  "  Prints what finding the bricks of a frame takes: no brick is loaded or drawn.\n"
  "  --size X,Y,Z  samples (default 4096,4096,4096)\n"
  "  --bricks N    cells per axis of a brick (default 32)\n"
  "  --kind K      smooth or scattered bricks (default smooth)\n"
  "  --picture N   pixels per side (default 1024)\n"
  "  --zoom F      the eye is F times nearer (default 1)\n"
  "  --budget MIB  of bricks (default 4096)\n"
  "  --threads N   (default 1)    --repeat N  of which the median counts (default 5)\n"
  "Columns: part, level (-1: of several), median milliseconds of processor time of all\n"
  "threads, bricks that come out of it, MiB that stay allocated after all repeats.\n"
  "  plan      LevelCaster of a level, under a function that it knows\n"
  "  function  the same after the function has changed\n"
  "  finest    FinestLevelWithin the budget\n"
  "  load      BricksToLoad\n"
  "  parts     VisibleParts\n"
  "  frame     all plans of a frame while the camera moves, its probes included\n"
  "  step      the same for the first frame of another step\n";

struct Options
{
  glm::ivec3 Samples{ 4096 };
  int Bricks = 32;
  MadeUpBricks::Kind Kind = MadeUpBricks::Kind::Smooth;
  int Picture = 1024;
  double Zoom = 1.0;
  std::uint64_t Budget = std::uint64_t{ 4096 } << 20;
  int Threads = 1;
  int Repeat = 5;
};

/// Of all threads: other programs on the machine hardly count.
double CpuMilliseconds()
{
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return 1e3 * static_cast<double>(now.tv_sec) + 1e-6 * static_cast<double>(now.tv_nsec);
}

double AllocatedMiB()
{
  const struct mallinfo2 info = mallinfo2();
  return static_cast<double>(info.uordblks + info.hblkhd) / 1048576.0;
}

/// Values above 1/2 are seen.
/// @param variant functions of other numbers differ in what they show, though not for the bricks
TransferFunction FunctionOf(int variant)
{
  TransferFunction function;
  const double threshold = 0.5 + 1e-3 * (variant % 16);
  for (int i = 0; i < 4096; ++i)
  {
    const double value = i / 4095.0;
    function.Entries.emplace_back(1.0, value, 1.0 - value, value > threshold ? 0.01 * value : 0.0);
  }
  return function;
}

/// Shows all of a volume, or a part of its middle.
RayScene SceneOf(const Options& options)
{
  const Box cells{ glm::ivec3(0), options.Samples - 1 };
  const glm::dvec3 centre = 0.5 * glm::dvec3(cells.Hi);
  const double radius = glm::length(centre);
  const double distance = 2.8 * radius / options.Zoom;
  const glm::dvec3 eye = centre + distance * glm::dvec3(0.48, 0.36, 0.80);
  const glm::dmat4 view = glm::lookAt(eye, centre, glm::dvec3(0, 1, 0));
  const glm::dmat4 projection = glm::perspective(
    glm::radians(45.0), 1.0, std::max(distance - radius, 1e-3 * radius), distance + radius);
  const glm::ivec2 picture(options.Picture);
  return { RayCamera(projection * view, picture, centre), { { 0, 0 }, picture }, glm::dmat4(1.0),
    cells, FunctionOf(0), 1.0, 0.999f, {} };
}

/// What a probe might look like: so far from the truth that a frame takes the finest level that it
/// may.
FloatImage MadeUpPicture(const RayScene& scene, const RaySampling& sampling)
{
  FloatImage picture;
  picture.Rect = scene.Viewport;
  const double error = (std::ldexp(8.0, 2 * sampling.Level) + sampling.Distance) / 255.0;
  for (int y = picture.Rect.Lo.y; y < picture.Rect.Hi.y; ++y)
  {
    for (int x = picture.Rect.Lo.x; x < picture.Rect.Hi.x; ++x)
    {
      picture.Pixels.emplace_back(glm::vec4(
        static_cast<float>(0.5 + 0.25 * std::sin(0.01 * x) * std::sin(0.01 * y) + error)));
    }
  }
  return picture;
}

class Bench
{
public:
  explicit Bench(const Options& options)
    : Settings(options)
    , Pool(options.Threads)
    , Scene(SceneOf(options))
    , Source(options.Samples, options.Bricks, options.Kind)
  {
    for (int level = 1; level <= Coarsest; ++level)
    {
      this->Source.AtLevel(level, this->Scene.DomainCells);
    }
  }

  void Run()
  {
    const double before = AllocatedMiB();
    for (int level = 0; level <= Coarsest; ++level)
    {
      RayScene scene = this->AtLevel(level);
      this->Print("plan", level, before, [&] { return this->PlanLevel(scene, level); });
    }
    for (int level = 0; level <= Coarsest; ++level)
    {
      RayScene scene = this->AtLevel(level);
      this->Print("function", level, before,
        [&]
        {
          scene.Transfer = FunctionOf(++this->Functions);
          return this->PlanLevel(scene, level);
        });
    }
    this->Print("finest", -1, before, [&] { return this->FinestLevel(this->Source); });
    this->Print("load", 0, before,
      [&] { return BricksToLoad(this->Scene, this->Source, this->Scene.DomainCells).size(); });
    const glm::ivec3 cells = this->Scene.DomainCells.Size();
    this->Print("parts", 0, before,
      [&] { return VisibleParts(this->Scene, this->Source, cells, BlockEdgeFor(cells)).size(); });
    this->Print("frame", -1, before, [&] { return this->Frame(this->Source); });
  }

  /// The first frame of a step, without what the bricks themselves take.
  void RunStep()
  {
    std::vector<double> taken;
    std::size_t bricks = 0;
    for (int i = 0; i < this->Settings.Repeat; ++i)
    {
      MadeUpBricks source(this->Settings.Samples, this->Settings.Bricks, this->Settings.Kind);
      for (int level = 1; level <= Coarsest; ++level)
      {
        source.AtLevel(level, this->Scene.DomainCells);
      }
      const double began = CpuMilliseconds();
      this->PicturesTook = 0.0;
      bricks = this->Frame(source);
      taken.push_back(CpuMilliseconds() - began - this->PicturesTook);
    }
    this->PrintLine("step", -1, taken, bricks, 0.0);
  }

private:
  RayScene AtLevel(int level) const
  {
    RayScene scene = this->Scene;
    scene.Samplings = std::make_shared<const TileSamplings>(
      scene.Camera.ImageSize(), std::vector{ RaySampling{ level, std::ldexp(1.0, level) } });
    return scene;
  }

  std::size_t PlanLevel(const RayScene& scene, int level)
  {
    return this->PlanLevel(scene, *this->Source.AtLevel(level, scene.DomainCells));
  }

  /// @return bricks that are drawn
  std::size_t PlanLevel(const RayScene& scene, BrickSource& source)
  {
    RayStatistics statistics;
    const LevelCaster caster(scene, source, CellsAtLevel(scene.DomainCells, source.CellEdges()),
      this->Settings.Budget, this->Pool, statistics);
    const glm::ivec3 counts = source.Bricks();
    return static_cast<std::size_t>(
      std::int64_t{ counts.x } * counts.y * counts.z - statistics.BricksSkipped);
  }

  int FinestLevel(BrickSource& source)
  {
    return FinestLevelWithin(this->Scene, source, this->Scene.DomainCells, Coarsest,
      PackedBrickCache::PartOf(this->Settings.Budget));
  }

  /// As PlanDistributed and CastRays do it on one rank.
  std::size_t Frame(BrickSource& source)
  {
    SamplingWish wish{ 4.0, 1.0, Coarsest };
    wish.FinestProbeLevel = this->FinestLevel(source);
    wish.FinestLevel = wish.FinestProbeLevel;
    std::size_t bricks = 0;
    const auto plan = [&](const RayScene& scene)
    {
      for (const int level : scene.Samplings->UsedLevels())
      {
        bricks += this->PlanLevel(scene, *source.AtLevel(level, scene.DomainCells));
      }
    };
    RayScene scene = this->Scene;
    double elsewhere = CpuMilliseconds();
    scene.Samplings = PlanSamplings(scene, wish,
      [&](const RayScene& probe)
      {
        this->PicturesTook += CpuMilliseconds() - elsewhere;
        plan(probe);
        elsewhere = CpuMilliseconds();
        return MadeUpPicture(probe, probe.Samplings->At({ 0, 0 }));
      }).Samplings;
    this->PicturesTook += CpuMilliseconds() - elsewhere;
    plan(scene);
    return bricks;
  }

  template <class Function>
  void Print(const char* part, int level, double before, Function&& function)
  {
    std::vector<double> taken;
    std::size_t bricks = 0;
    for (int i = 0; i <= this->Settings.Repeat; ++i)
    {
      this->PicturesTook = 0.0;
      const double began = CpuMilliseconds();
      bricks = static_cast<std::size_t>(function());
      if (i > 0) // the first one makes what the others know
      {
        taken.push_back(CpuMilliseconds() - began - this->PicturesTook);
      }
    }
    this->PrintLine(part, level, taken, bricks, AllocatedMiB() - before);
  }

  void PrintLine(
    const char* part, int level, std::vector<double>& taken, std::size_t bricks, double mib)
  {
    std::sort(taken.begin(), taken.end());
    std::printf(
      "%s,%d,%.4g,%zu,%.3g\n", part, level, taken[taken.size() / 2], bricks, std::max(mib, 0.0));
    std::fflush(stdout);
  }

  Options Settings;
  const int Coarsest = DrawnField::CoarsestLevelOf(this->Settings.Samples - 1);
  ThreadPool Pool;
  RayScene Scene;
  MadeUpBricks Source;
  int Functions = 0;
  double PicturesTook = 0.0; ///< milliseconds that made-up probes took, and judging them
};

Options Parse(const std::vector<std::string>& arguments)
{
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string& option = arguments[i];
    const auto value = [&]() -> const std::string& { return ValueBehind(arguments, i); };
    if (option == "--size")
    {
      const std::vector<std::string> sizes = SplitAtCommas(value());
      if (sizes.size() != 3)
      {
        throw Error("--size takes three numbers: samples along x, y and z.");
      }
      for (int axis = 0; axis < 3; ++axis)
      {
        options.Samples[axis] = CountIn(option, sizes[static_cast<std::size_t>(axis)], 2, 65536);
      }
    }
    else if (option == "--bricks")
      options.Bricks = CountIn(option, value(), 4, 128);
    else if (option == "--kind")
      options.Kind =
        value() == "scattered" ? MadeUpBricks::Kind::Scattered : MadeUpBricks::Kind::Smooth;
    else if (option == "--picture")
      options.Picture = CountIn(option, value(), 1, 16384);
    else if (option == "--zoom")
      options.Zoom = NumberIn(option, value(), 0.1, 1000.0);
    else if (option == "--budget")
      options.Budget = static_cast<std::uint64_t>(CountIn(option, value(), 1, 1 << 24)) << 20;
    else if (option == "--threads")
      options.Threads = CountIn(option, value(), 1, 1024);
    else if (option == "--repeat")
      options.Repeat = CountIn(option, value(), 1, 1000);
    else
      throw Error("There is no option '" + option + "'; --help lists them.");
  }
  return options;
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    if (argc == 2 && std::strcmp(argv[1], "--help") == 0)
    {
      std::fputs(Help, stdout);
      return EXIT_SUCCESS;
    }
    const Options options = Parse({ argv + 1, argv + argc });
    std::puts("part,level,ms,bricks,mib");
    Bench(options).Run();
    Bench(options).RunStep();
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-descent: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
