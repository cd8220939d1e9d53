// What it takes to find the octree of a mesh of hexahedra, to take up values, and to draw a frame;
// one line of CSV per run. See README.md.
#include "OptionValues.h"
#include "StandardScenes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "HexOctree/HexBrickSource.h"
#include "OctreeMesh.h"
#include "Render/ImageError.h"
#include "StandardField.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <exception>
#include <fstream>

namespace
{

using namespace banyan;

struct Options
{
  int Cells = 100;
  bool Graded = false;
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
  "  --shuffle    cells in any order\n"
  "  --picture N  pixels per side (default 1024)    --threads N  (default 2)\n"
  "  --repeat N   frames, of which the median counts (default 3)\n"
  "  --header     prints the names of the columns and ends\n";

const char* Header =
  "mesh,cells,points,bricks,samples_in_bricks,find_s,find_cpu_s,bricks_s,values_s,memory_mb,"
  "bytes_per_cell,first_frame_ms,frame_ms,against_image_data_255\n";

/// A mesh in memory, in cells of the finest size.
struct Mesh
{
  std::vector<float> Points;
  std::vector<std::int64_t> Ids;

  std::size_t Cells() const { return this->Ids.size() / 8; }
  std::size_t PointCount() const { return this->Points.size() / 3; }
};

Mesh UniformMesh(int n, ThreadPool& pool)
{
  const std::int64_t samples = n + 1;
  Mesh mesh;
  mesh.Points.resize(static_cast<std::size_t>(3 * samples * samples * samples));
  mesh.Ids.resize(static_cast<std::size_t>(std::int64_t{ 8 } * n * n * n));
  pool.ParallelFor(samples,
    [&](std::int64_t z)
    {
      float* point = &mesh.Points[static_cast<std::size_t>(3 * z * samples * samples)];
      for (std::int64_t y = 0; y < samples; ++y)
      {
        for (std::int64_t x = 0; x < samples; ++x)
        {
          *point++ = static_cast<float>(x);
          *point++ = static_cast<float>(y);
          *point++ = static_cast<float>(z);
        }
      }
      for (std::int64_t i = 0; z < n && i < std::int64_t{ n } * n; ++i)
      {
        std::int64_t* ids = &mesh.Ids[static_cast<std::size_t>(8 * (z * n * n + i))];
        for (int corner = 0; corner < 8; ++corner)
        {
          // The order of VTK_HEXAHEDRON.
          const int round = corner & 3;
          const std::int64_t p = i % n + (round == 1 || round == 2 ? 1 : 0);
          const std::int64_t q = i / n + (round >= 2 ? 1 : 0);
          ids[corner] = p + samples * (q + samples * (z + (corner >> 2)));
        }
      }
    });
  return mesh;
}

Mesh GradedMesh(int n, ThreadPool& pool)
{
  OctreeMeshShape shape;
  shape.RootEdge = n;
  shape.MaxLevel = std::ilogb(n);
  const double finest = 1.0 / n;
  const auto tooLarge = [&](const MeshOctant& octant)
  {
    // Where values differ by more than a little across a cube.
    const double edge = std::ldexp(1.0, -octant.Level);
    double low = 1.0;
    double high = 0.0;
    for (int i = 0; i < 27; ++i)
    {
      const double x = octant.Corner[0] * finest + 0.5 * edge * (i % 3);
      const double y = octant.Corner[1] * finest + 0.5 * edge * (i / 3 % 3);
      const double z = octant.Corner[2] * finest + 0.5 * edge * (i / 9);
      const double value = StandardField({ x, y, z });
      low = std::min(low, value);
      high = std::max(high, value);
    }
    return octant.Level < 3 || high - low > 8.0 * finest;
  };
  const OctreeMesh tree(shape, tooLarge, pool);
  Mesh mesh;
  for (std::size_t node = 0; node < tree.NodeCount(); ++node)
  {
    for (const double x : tree.Point(node))
    {
      mesh.Points.push_back(static_cast<float>(x));
    }
  }
  for (std::size_t cell = 0; cell < tree.CellCount(); ++cell)
  {
    const auto& corners = tree.Corners(cell);
    mesh.Ids.insert(mesh.Ids.end(), corners.begin(), corners.end());
  }
  return mesh;
}

/// A permutation without a table: steps of a number that shares no divisor with the count.
void Shuffle(Mesh& mesh)
{
  const std::size_t cells = mesh.Cells();
  std::size_t step = 2654435761u % cells | 1u;
  const auto divisor = [](std::size_t a, std::size_t b)
  {
    while (b != 0)
    {
      const std::size_t rest = a % b;
      a = b;
      b = rest;
    }
    return a;
  };
  while (divisor(step, cells) != 1)
  {
    step += 2;
  }
  std::vector<std::int64_t> ids(mesh.Ids.size());
  for (std::size_t cell = 0; cell < cells; ++cell)
  {
    std::copy_n(&mesh.Ids[8 * (cell * step % cells)], 8, &ids[8 * cell]);
  }
  mesh.Ids = std::move(ids);
}

/// Megabytes that the process has taken at most since the last call of ForgetPeak.
double PeakMegabytes()
{
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
  {
    if (line.rfind("VmHWM:", 0) == 0)
    {
      return std::stod(line.substr(6)) / 1024.0;
    }
  }
  return 0.0;
}

void ForgetPeak()
{
  std::ofstream("/proc/self/clear_refs") << "5";
}

Options ReadOptions(const std::vector<std::string>& arguments)
{
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string name = arguments[i];
    const auto count = [&](int low, int high)
    { return bench::CountIn(name, bench::ValueBehind(arguments, i), low, high); };
    if (name == "--graded" || name == "--shuffle")
    {
      (name == "--graded" ? options.Graded : options.Shuffled) = true;
    }
    else if (name == "--cells")
    {
      options.Cells = count(1, 1000);
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
  if (options.Graded && (options.Cells & (options.Cells - 1)) != 0)
  {
    throw Error("A graded mesh has a power of two cells across.");
  }
  return options;
}

RayScene SceneOf(const Options& options, const ElementOctree& tree)
{
  // The standard scene of as many cells: of its volume, the size alone counts.
  auto volume = std::make_shared<bench::Volume>();
  volume->Samples = glm::ivec3(options.Cells + 1);
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

void Run(const Options& options)
{
  ThreadPool pool(options.Threads);
  Mesh mesh = options.Graded ? GradedMesh(options.Cells, pool) : UniformMesh(options.Cells, pool);
  if (options.Shuffled)
  {
    Shuffle(mesh);
  }
  std::vector<float> values(mesh.PointCount());
  const double edge = 1.0 / options.Cells;
  pool.ParallelFor(static_cast<std::int64_t>(values.size()),
    [&](std::int64_t i)
    {
      const float* p = &mesh.Points[static_cast<std::size_t>(3 * i)];
      values[static_cast<std::size_t>(i)] =
        static_cast<float>(StandardField({ p[0] * edge, p[1] * edge, p[2] * edge }));
    });

  HexMesh input;
  input.Points = mesh.Points.data();
  input.PointCount = static_cast<std::int64_t>(mesh.PointCount());
  input.Connectivity = mesh.Ids.data();
  input.CellCount = static_cast<std::int64_t>(mesh.Cells());
  ForgetPeak();
  const double before = PeakMegabytes();
  const Timer find;
  const std::clock_t findFrom = std::clock();
  const auto tree = ElementOctree::Find(input, pool);
  const double findSeconds = find.Seconds();
  const double findCpu = static_cast<double>(std::clock() - findFrom) / CLOCKS_PER_SEC;
  const Timer cut;
  const auto bricks = std::make_shared<const HexBricks>(tree, 16);
  const double cutSeconds = cut.Seconds();
  NodeArray array;
  array.Values = values.data();
  const Timer take;
  HexBrickSource source(bricks, array, pool);
  const double takeSeconds = take.Seconds();
  const double megabytes = PeakMegabytes() - before;

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
  std::printf("%s,%zu,%zu,%zu,%lld,%.3f,%.3f,%.3f,%.3f,%.0f,%.1f,%.1f,%.1f,%.3f\n",
    options.Graded ? "graded" : "uniform", mesh.Cells(), mesh.PointCount(), bricks->List().size(),
    static_cast<long long>(samples), findSeconds, findCpu, cutSeconds, takeSeconds, megabytes,
    megabytes * 1048576.0 / static_cast<double>(mesh.Cells()), frames.front(),
    frames[1 + static_cast<std::size_t>(options.Repeat) / 2],
    AgainstImageData(options, picture, pool));
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
