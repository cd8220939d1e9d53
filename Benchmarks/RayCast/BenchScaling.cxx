// SPDX-License-Identifier: BSD-3-Clause
// Time of the first and of later frames against the size of the volume (scene S2), one line of CSV
// per run. Without VTK, so that memory and start-up are the ray caster's own. See README.md.
#include "OptionValues.h"
#include "SeriesFiles.h"
#include "StandardScenes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Cache/BrickCache.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Render/Raycast/InterpolateSkippedPixels.h"
#include "Render/Sampling/SamplingPlan.h"
#include "Series/Decode/CacheContext.h"
#include "Series/Encode/SeriesEncoder.h"

#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace
{

using namespace banyan;
namespace fs = std::filesystem;

constexpr double MiB = 1048576.0;

struct Options
{
  std::string Raw;    ///< to encode
  std::string Series; ///< to draw from, or to write; none draws from memory
  int Size = 256;
  int Picture = 1024;
  int Threads = 1;
  int Repeat = 3;
  int BudgetMiB = 0;    ///< 0 for the process's own
  double Tolerance = 0; ///< in 1/255; 0 takes one sample per voxel
};

constexpr int CoarsestLevel = 3;

const char* Help =
  "banyan-bench-scaling --size N [--series FILE.banyan] [OPTIONS]\n"
  "  Draws the standard scene S2 of N^3 samples, from memory or from the encoded\n"
  "  series, whose files are dropped from the system's cache before.\n"
  "banyan-bench-scaling --encode FILE.raw --size N --series FILE.banyan\n"
  "  Encodes one step of float32, with the default error bound.\n"
  "  --threads N  (default 1)    --repeat N   later frames (default 3)\n"
  "  --budget MIB what bricks may take in all (default: the process's own, see limits.md)\n"
  "  --picture N  pixels per side (default 1024)\n"
  "  --tolerance T  samples as the picture needs for an error of T/255, instead of\n"
  "                 one per voxel; finding out is part of each frame\n"
  "  --header     prints the names of the columns and ends\n";

/// A file's bytes, mapped for reading.
class MappedFile
{
public:
  MappedFile(const std::string& path, std::size_t bytes)
    : Bytes(bytes)
  {
    const int file = open(path.c_str(), O_RDONLY);
    if (file >= 0)
    {
      this->Data = mmap(nullptr, bytes, PROT_READ, MAP_PRIVATE, file, 0);
      close(file);
    }
    std::error_code problem;
    if (file < 0 || this->Data == MAP_FAILED || fs::file_size(path, problem) != bytes)
    {
      throw Error("The file of raw values cannot be read, or has not the right size.", { path });
    }
  }
  ~MappedFile() { munmap(this->Data, this->Bytes); }
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  const void* Get() const { return this->Data; }

private:
  std::size_t Bytes;
  void* Data = MAP_FAILED;
};

void Encode(const Options& options)
{
  const std::size_t n = options.Size;
  const MappedFile raw(options.Raw, n * n * n * sizeof(float));
  Grid grid;
  grid.Extent.Hi = glm::ivec3(options.Size);
  ArrayDescription array;
  array.Name = "value";
  array.ComponentNames = { "" };
  array.SeriesRanges = { { 0.0, 1.0 } };
  ThreadPool pool(options.Threads);
  SeriesEncoder encoder(options.Series, grid, { array }, {}, pool);
  encoder.AddStep(0.0, { { raw.Get() } });
  encoder.Finish();
  bench::BringToDisk(options.Series);
}

/// Most memory that this process has had, the pages of mapped files included.
double PeakMiB()
{
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
  {
    if (line.rfind("VmHWM:", 0) == 0)
    {
      return std::atof(line.c_str() + 6) / 1024.0;
    }
  }
  return 0.0;
}

/// The scene as it is to be sampled.
RayScene Sampled(RayScene scene, double tolerance, int finestProbeLevel, const DrawProbe& draw)
{
  if (tolerance > 0.0)
  {
    const SamplingPlan plan = PlanSamplings(
      scene, { tolerance, scene.SampleDistance, CoarsestLevel, finestProbeLevel }, draw);
    scene.Samplings = plan.Samplings;
    scene.OpacityLimit = plan.OpacityLimit;
  }
  return scene;
}

struct Frames
{
  double FirstMilliseconds = 0;
  std::vector<double> Milliseconds;
  RayStatistics Statistics; ///< of the last frame
};

Frames DrawFrames(const Options& options, const Timer& sinceStart, BrickSource& source,
  std::uint64_t budget, ThreadPool& pool)
{
  auto shape = std::make_shared<bench::Volume>();
  shape->Samples = glm::ivec3(options.Size);
  const RayScene scene = ToRayScene(
    StandardScene(shape, bench::StandardFunction::S2, false, options.Picture), 1.0, 0.99f);
  Frames frames;
  for (int i = 0; i <= options.Repeat; ++i)
  {
    const Timer timer;
    frames.Statistics = {};
    const auto draw = [&](const RayScene& wanted)
    { return CastRays(wanted, source, wanted.DomainCells, budget, pool, frames.Statistics); };
    const int finestProbe = FinestLevelWithin(
      scene, source, scene.DomainCells, CoarsestLevel, PackedBrickCache::PartOf(budget));
    const RayScene sampled = Sampled(scene, options.Tolerance, finestProbe, draw);
    FloatImage picture = draw(sampled);
    InterpolateSkippedPixels(sampled, picture, pool);
    if (i == 0)
      frames.FirstMilliseconds = 1e3 * sinceStart.Seconds();
    else
      frames.Milliseconds.push_back(1e3 * timer.Seconds());
  }
  std::sort(frames.Milliseconds.begin(), frames.Milliseconds.end());
  return frames;
}

void Report(const Options& options, const CacheContext& caches, const Frames& frames)
{
  const double fileBytes = options.Series.empty() ? 0.0 : bench::BytesOf(options.Series);
  const RayStatistics& statistics = frames.Statistics;
  char tolerance[32] = "";
  if (options.Tolerance > 0.0)
  {
    std::snprintf(tolerance, sizeof(tolerance), "%g", options.Tolerance);
  }
  std::printf("S2-%d,%s,%d,%s,%.6g,%.6g,%lld,%lld,%lld,%d,%.6g,%.6g\n", options.Size,
    options.Series.empty() ? "memory" : "series", options.Threads, tolerance,
    frames.FirstMilliseconds, frames.Milliseconds[frames.Milliseconds.size() / 2],
    static_cast<long long>(statistics.SamplesTaken), static_cast<long long>(statistics.BricksDrawn),
    static_cast<long long>(statistics.BricksSkipped), static_cast<int>(caches.BudgetBytes() >> 20),
    PeakMiB(), fileBytes / MiB);
}

void Draw(const Options& options)
{
  ThreadPool::SetProcessWidth(options.Threads);
  ThreadPool& pool = ThreadPool::Process();
  const auto caches = CacheContext::WithBudget(
    options.BudgetMiB > 0 ? std::int64_t{ options.BudgetMiB } << 20 : std::int64_t{ -1 });
  const std::uint64_t budget = caches->DrawingBudgetBytes();
  if (options.Series.empty())
  {
    const auto volume = bench::StandardVolume(options.Size, pool);
    const Timer sinceStart;
    ArrayBrickSource source(volume->Array(), bench::BrickCells, { 0.0, 1.0 }, pool);
    Report(options, *caches, DrawFrames(options, sinceStart, source, budget, pool));
    return;
  }
  bench::DropFromCache(options.Series);
  const Timer sinceStart;
  SeriesBrickSource source(
    SeriesFile::Open(options.Series, caches), {}, 0, BrickCache::Of(*caches));
  Report(options, *caches, DrawFrames(options, sinceStart, source, budget, pool));
}

Options Parse(const std::vector<std::string>& arguments)
{
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string& option = arguments[i];
    const auto value = [&]() -> const std::string& { return bench::ValueBehind(arguments, i); };
    const auto count = [&] { return bench::CountIn(option, value(), 1, 1000000); };
    if (option == "--encode")
      options.Raw = value();
    else if (option == "--series")
      options.Series = value();
    else if (option == "--tolerance")
      options.Tolerance = bench::NumberIn(option, value(), 0.01, 255.0);
    else if (option == "--size")
      options.Size = count();
    else if (option == "--picture")
      options.Picture = count();
    else if (option == "--threads")
      options.Threads = count();
    else if (option == "--repeat")
      options.Repeat = count();
    else if (option == "--budget")
      options.BudgetMiB = count();
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
    }
    else if (argc == 2 && std::strcmp(argv[1], "--header") == 0)
    {
      std::puts("scene,source,threads,tolerance,first_frame_ms,ms_per_frame,samples,bricks_drawn,"
                "bricks_skipped,budget_mib,peak_mib,file_mib");
    }
    else
    {
      const Options options = Parse({ argv + 1, argv + argc });
      options.Raw.empty() ? Draw(options) : Encode(options);
    }
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-scaling: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
