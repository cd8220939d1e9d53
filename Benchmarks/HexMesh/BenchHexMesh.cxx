// SPDX-License-Identifier: BSD-3-Clause
// What it takes to find the octree of a mesh of hexahedra, to take up values, and to draw a frame;
// one line of CSV per run. See README.md.
#include "BenchMesh.h"
#include "OptionValues.h"
#include "PeakMemory.h"
#include "StandardScenes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Mesh/Octree/HexBrickSource.h"
#include "Render/Sampling/ImageError.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>

namespace
{

constexpr int BrickCells = 32; // as the mapper has them

using namespace banyan;

struct Options
{
  int Cells = 100;
  std::string Mesh = "uniform";
  bool Shuffled = false;
  int Picture = 1024;
  int Threads = 2;
  int Repeat = 3;
};

const char* Help =
  "banyan-bench-hexmesh [OPTIONS]\n"
  "  The standard field on a mesh of hexahedra, drawn with the standard function S1.\n"
  "  --cells N    cells across (default 100): N^3 in all, or fewer of several sizes with\n"
  "  --graded     an octree that is fine where the field is steep; N is a power of two then\n"
  "  --earthquake the mesh of an earthquake, of about N cells in all\n"
  "  --shuffle    cells in any order\n"
  "  --picture N  pixels per side (default 1024)    --threads N  (default 2)\n"
  "  --repeat N   frames, of which the median counts (default 3)\n"
  "  --header     prints the names of the columns and ends\n";

const char* Header =
  "mesh,cells,points,bricks,samples_in_bricks,find_s,find_cpu_s,bricks_s,values_s,memory_mb,"
  "bytes_per_cell,first_frame_ms,frame_ms,against_image_data_255\n";

Options ReadOptions(const std::vector<std::string>& arguments)
{
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string name = arguments[i];
    const auto count = [&](int low, int high)
    { return bench::CountIn(name, bench::ValueBehind(arguments, i), low, high); };
    if (name == "--graded" || name == "--earthquake")
    {
      options.Mesh = name.substr(2);
    }
    else if (name == "--shuffle")
    {
      options.Shuffled = true;
    }
    else if (name == "--cells")
    {
      options.Cells = count(1, 100000000);
    }
    else if (name == "--picture")
    {
      options.Picture = count(1, 8192);
    }
    else if (name == "--threads")
    {
      options.Threads = count(1, 1024);
    }
    else if (name == "--repeat")
    {
      options.Repeat = count(1, 1000);
    }
    else
    {
      throw Error("There is no option '" + name + "'.\n" + Help);
    }
  }
  if (options.Mesh != "earthquake" && options.Cells > 1000)
  {
    throw Error("A mesh has at most 1000 cells across.");
  }
  if (options.Mesh == "graded" && (options.Cells & (options.Cells - 1)) != 0)
  {
    throw Error("A graded mesh has a power of two cells across.");
  }
  if (options.Mesh == "earthquake" && options.Cells < 1000)
  {
    throw Error("The mesh of an earthquake has at least 1000 cells.");
  }
  return options;
}

RayScene SceneOf(const Options& options, const ElementOctree& tree)
{
  // The standard scene of as many cells: of its volume, the size alone counts.
  auto volume = std::make_shared<bench::Volume>();
  volume->Samples = tree.Domain().Size() + 1;
  const bench::BenchScene standard =
    bench::StandardScene(volume, bench::StandardFunction::S1, false, options.Picture);
  RayScene scene = bench::ToRayScene(standard, 1.0, 0.99f);
  scene.IndexToWorld = tree.LatticeToWorld();
  scene.DomainCells = tree.Domain();
  return scene;
}

/// The largest difference to the picture of as many samples of image data, in 1/255.
double AgainstImageData(const Options& options, const FloatImage& picture, ThreadPool& pool)
{
  const auto volume = bench::StandardVolume(options.Cells + 1, pool);
  const RayScene scene = bench::ToRayScene(
    bench::StandardScene(volume, bench::StandardFunction::S1, false, options.Picture), 1.0, 0.99f);
  ArrayBrickSource source(volume->Array(), 16, { 0.0, 1.0 }, pool);
  RayStatistics statistics;
  const FloatImage expected =
    CastRays(scene, source, scene.DomainCells, std::uint64_t{ 4 } << 30, pool, statistics);
  return 255.0 * MaxDifference(picture, expected);
}

bench::BenchMesh MeshOf(const Options& options, ThreadPool& pool)
{
  if (options.Mesh == "earthquake")
  {
    return bench::GroundMesh(options.Cells, pool);
  }
  return options.Mesh == "graded" ? bench::GradedMesh(options.Cells, pool)
                                  : bench::UniformMesh(options.Cells, pool);
}

void Run(const Options& options)
{
  ThreadPool pool(options.Threads);
  bench::BenchMesh mesh = MeshOf(options, pool);
  if (options.Shuffled)
  {
    bench::Shuffle(mesh);
  }
  const std::vector<float>& values = mesh.Values;
  const HexMesh input = mesh.Input();
  bench::ForgetPeak();
  const double before = bench::PeakMegabytes();
  const Timer find;
  const std::clock_t findFrom = std::clock();
  const auto tree = ElementOctree::Find(input, pool);
  const double findSeconds = find.Seconds();
  const double findCpu = static_cast<double>(std::clock() - findFrom) / CLOCKS_PER_SEC;
  const Timer cut;
  const auto bricks = std::make_shared<const HexBricks>(tree, BrickCells);
  const double cutSeconds = cut.Seconds();
  NodeArray array;
  array.Values = values.data();
  const Timer take;
  HexBrickSource source(bricks, array, pool);
  const double takeSeconds = take.Seconds();
  const double megabytes = bench::PeakMegabytes() - before;

  const RayScene scene = SceneOf(options, *tree);
  FloatImage picture;
  std::vector<double> frames;
  for (int i = 0; i <= options.Repeat; ++i)
  {
    RayStatistics statistics;
    const Timer frame;
    picture =
      CastRays(scene, source, scene.DomainCells, std::uint64_t{ 4 } << 30, pool, statistics);
    frames.push_back(1000.0 * frame.Seconds());
  }
  std::int64_t samples = 0;
  for (const HexBrick& brick : bricks->List())
  {
    samples += Box{ brick.Cells.Lo, brick.Cells.Hi + 1 }.Count();
  }
  std::sort(frames.begin() + 1, frames.end());
  // Of an earthquake there is no image data of the same size.
  const std::string difference = options.Mesh == "earthquake"
                                   ? std::string()
                                   : std::to_string(AgainstImageData(options, picture, pool));
  std::printf("%s,%zu,%zu,%zu,%lld,%.3f,%.3f,%.3f,%.3f,%.0f,%.1f,%.1f,%.1f,%s\n",
    options.Mesh.c_str(), mesh.Cells(), mesh.PointCount(), bricks->List().size(),
    static_cast<long long>(samples), findSeconds, findCpu, cutSeconds, takeSeconds, megabytes,
    megabytes * 1048576.0 / static_cast<double>(mesh.Cells()), frames.front(),
    frames[1 + static_cast<std::size_t>(options.Repeat) / 2], difference.c_str());
}

} // namespace

int main(int count, char** arguments)
{
  const std::vector<std::string> given(arguments + 1, arguments + count);
  if (given == std::vector<std::string>{ "--header" })
  {
    std::fputs(Header, stdout);
    return 0;
  }
  if (given == std::vector<std::string>{ "--help" })
  {
    std::fputs(Help, stdout);
    return 0;
  }
  try
  {
    Run(ReadOptions(given));
    return 0;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-hexmesh: %s\n", error.what());
    return 1;
  }
}
