// SPDX-License-Identifier: BSD-3-Clause
// One way to draw a mesh of hexahedra: what it takes to set up and to draw, and how exact the
// picture is; one line of CSV. See README.md.
#include "BenchMesh.h"
#include "ConvergedImage.h"
#include "HexMeshRenderer.h"
#include "MeshOfKind.h"
#include "OptionValues.h"
#include "PeakMemory.h"
#include "StandardScenes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Mesh/Octree/NodalField.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <memory>

namespace
{

using namespace banyan;
using namespace banyan::bench;

const char* Help =
  "banyan-bench-hexmesh-renderer --renderer NAME [OPTIONS]\n"
  "  Draws a mesh of hexahedra in one of several ways, and prints a line of CSV.\n"
  "  --renderer NAME    banyan, banyan-full (one sample per finest edge, no coarser levels),\n"
  "                     banyan-one-level (the one that --max-elements gives), or one of those "
  "that\n"
  "                     --list prints; reference: makes the mesh and the converged picture, "
  "where\n"
  "                     they are not kept yet, and prints the number of cells; locator: the "
  "integral\n"
  "                     through the elements that VTK's cell locator finds, slowly\n"
  "  --mesh KIND        uniform (default), graded: the standard field, function S1;\n"
  "                     earthquake: the ground's speed; FILE.exo: the same of one that "
  "banyan-generate made\n"
  "  --cells N          cells across (default 100); of an earthquake, about so many in all\n"
  "  --seconds T        of the earthquake (default 12)\n"
  "  --tolerance E      of banyan, in 1/255 (default 1)\n"
  "  --max-elements N   of banyan: MaxElementsPerPixel (default 0: any)\n"
  "  --picture N        pixels per side (default 1024)    --threads N  (default 2)\n"
  "  --repeat N         frames after the first one, of which the median counts (default 3); no\n"
  "                     more begin when they have taken a minute\n"
  "  --references DIR   keeps meshes and converged pictures (default: the current folder)\n"
  "  --save FILE.ppm    writes the picture\n"
  "  --header, --list   prints the names of the columns, or of VTK's renderers, and ends\n";

const char* Header = "cells,renderer,setup_s,memory_mb,ms_per_frame,psnr_db,max_error_255,note\n";

/// Of repeated frames.
constexpr double EnoughSeconds = 60.0;

struct Options
{
  std::string Renderer;
  std::string Mesh = "uniform";
  int Cells = 100;
  double Seconds = 12.0;
  HexMeshAccuracy Accuracy;
  int Picture = 1024;
  int Threads = 2;
  int Repeat = 3;
  std::string References = ".";
  std::string Save;
};

void SetOption(Options& options, const std::string& name, const std::string& value)
{
  const auto count = [&](int low, int high) { return CountIn(name, value, low, high); };
  if (name == "--renderer")
  {
    options.Renderer = value;
  }
  else if (name == "--mesh")
  {
    options.Mesh = value;
  }
  else if (name == "--cells")
  {
    options.Cells = count(1, 100000000);
  }
  else if (name == "--seconds")
  {
    options.Seconds = NumberIn(name, value, 0.0, 1000.0);
  }
  else if (name == "--tolerance")
  {
    options.Accuracy.Tolerance = NumberIn(name, value, 0.05, 255.0);
  }
  else if (name == "--max-elements")
  {
    options.Accuracy.MaxElementsPerPixel = NumberIn(name, value, 0.0, 1e6);
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
  else if (name == "--references")
  {
    options.References = value;
  }
  else if (name == "--save")
  {
    options.Save = value;
  }
  else
  {
    throw Error("There is no option '" + name + "'.\n" + Help);
  }
}

/// All points of the lattice that the mesh's elements have corners on, at the same places: a
/// trilinear element of any size is trilinear between them, so nothing is lost.
std::shared_ptr<const Volume> OnLattice(const BenchMesh& mesh, ThreadPool& pool)
{
  const auto tree = ElementOctree::Find(mesh.Input(), pool);
  if (tree->HoleCells() > 0 || tree->Domain().Lo != glm::ivec3(0))
  {
    throw Error("The mesh does not fill a box that begins at the origin");
  }
  NodeArray values;
  values.Values = mesh.Values.data();
  const NodalField field(tree, values, pool);
  auto volume = std::make_shared<Volume>();
  volume->Samples = tree->Domain().Size() + 1;
  const glm::ivec3 n = volume->Samples;
  volume->Floats.resize(static_cast<std::size_t>(Box{ glm::ivec3(0), n }.Count()));
  pool.ParallelFor(n.z,
    [&](std::int64_t z)
    {
      float* out = &volume->Floats[static_cast<std::size_t>(z * n.x * n.y)];
      for (int y = 0; y < n.y; ++y)
      {
        for (int x = 0; x < n.x; ++x)
        {
          *out++ = static_cast<float>(field.AtPoint({ x, y, static_cast<int>(z) }));
        }
      }
    });
  return volume;
}

/// Waves out of the dark, from above the ground.
void LookAtEarthquake(const BenchMesh& mesh, BenchScene& look)
{
  std::vector<float> sorted = mesh.Values;
  const auto rank = sorted.begin() + static_cast<std::ptrdiff_t>(0.998 * (sorted.size() - 1));
  std::nth_element(sorted.begin(), rank, sorted.end());
  look.Low = 0.0;
  look.High = *rank;
  look.Nodes = { { 0.0, 0.0, 0.2, 0.0 }, { 0.1, 0.2, 0.8, 0.002 }, { 0.2, 0.8, 0.9, 0.02 },
    { 1.0, 0.9, 0.3, 0.08 }, { 1.0, 0.3, 0.1, 0.3 } };
  const glm::dvec3 size = look.Data->Size();
  look.UnitDistance = size.x / 512.0;
  look.Center = 0.5 * size;
  look.Up = { 0.0, 0.0, 1.0 };
  look.Eye = look.Center + 1.25 * size.x * glm::dvec3(0.35, -0.75, 0.56);
}

/// @param whole whether the volume has its values, for the reference; otherwise its size alone
BenchScene LookOf(const Options& options, const BenchMesh& mesh, bool whole, ThreadPool& pool)
{
  std::shared_ptr<const Volume> volume;
  if (whole)
  {
    volume = OnLattice(mesh, pool);
  }
  else
  {
    auto empty = std::make_shared<Volume>();
    for (std::size_t i = 0; i < mesh.Points.size(); ++i)
    {
      int& samples = empty->Samples[static_cast<int>(i % 3)];
      samples = std::max(samples, static_cast<int>(mesh.Points[i]) + 1);
    }
    volume = empty;
  }
  BenchScene look = StandardScene(volume, StandardFunction::S1, false, options.Picture);
  if (options.Mesh != "uniform" && options.Mesh != "graded")
  {
    LookAtEarthquake(mesh, look);
  }
  return look;
}

std::unique_ptr<HexMeshRenderer> RendererOf(const Options& options, const HexMeshScene& scene)
{
  HexMeshAccuracy accuracy = options.Accuracy;
  if (options.Renderer == "banyan-full")
  {
    accuracy.Tolerance = 0.0;
  }
  accuracy.OneLevel = options.Renderer == "banyan-one-level";
  if (options.Renderer == "banyan" || options.Renderer == "banyan-full" || accuracy.OneLevel)
  {
    return MakeBanyanHexMeshRenderer(scene, accuracy, options.Threads);
  }
  auto renderer = options.Renderer == "locator"
                    ? MakeLocatorHexMeshRenderer(scene, options.Threads)
                    : MakeVtkHexMeshRenderer(options.Renderer, scene, options.Threads);
  if (!renderer)
  {
    throw Error("There is no renderer '" + options.Renderer + "'");
  }
  return renderer;
}

FloatImage ReferenceOf(const Options& options, const BenchMesh& mesh, ThreadPool& pool)
{
  constexpr double step = 0.25; // of the finest edge
  return CachedConvergedImage(LookOf(options, mesh, true, pool), step, options.References, pool);
}

void Run(const Options& options)
{
  HexMeshScene scene;
  {
    ThreadPool pool(options.Threads);
    scene.Mesh =
      MeshOfKind({ options.Mesh, options.Cells, options.Seconds }, options.References, pool);
    scene.Look = LookOf(options, scene.Mesh, false, pool);
  }
  if (options.Renderer == "reference")
  {
    ThreadPool pool(options.Threads);
    ReferenceOf(options, scene.Mesh, pool);
    std::printf("%zu\n", scene.Mesh.Cells());
    return;
  }
  auto renderer = RendererOf(options, scene);
  renderer->Open();
  ForgetPeak();
  const double before = PeakMegabytes();
  HexMeshFrame frame = renderer->Draw();
  const double first = frame.Seconds;
  std::vector<double> seconds;
  const Timer repeated;
  do
  {
    frame = renderer->Draw();
    seconds.push_back(frame.Seconds);
  } while (static_cast<int>(seconds.size()) < options.Repeat && repeated.Seconds() < EnoughSeconds);
  const double megabytes = PeakMegabytes() - before;
  std::sort(seconds.begin(), seconds.end());
  const double median = seconds[seconds.size() / 2];
  renderer.reset();

  ThreadPool pool(options.Threads);
  const PictureError error = ErrorOf(frame.Shown, ReferenceOf(options, scene.Mesh, pool));
  std::printf("%zu,%s,%.2f,%.0f,%.1f,%.2f,%.2f,\n", scene.Mesh.Cells(), options.Renderer.c_str(),
    std::max(0.0, first - median), megabytes, 1000.0 * median, error.PsnrDecibels, error.Largest);
  if (!options.Save.empty())
  {
    WritePicture(frame.Shown, options.Save);
  }
}

} // namespace

int main(int count, char** arguments)
{
  const std::vector<std::string> given(arguments + 1, arguments + count);
  const std::string only = given.size() == 1 ? given.front() : std::string();
  if (only == "--header" || only == "--help")
  {
    std::fputs(only == "--header" ? Header : Help, stdout);
    return 0;
  }
  if (only == "--list")
  {
    for (const std::string& name : VtkHexMeshRenderers())
    {
      std::printf("%s\n", name.c_str());
    }
    return 0;
  }
  try
  {
    Options options;
    for (std::size_t i = 0; i < given.size(); ++i)
    {
      const std::string& name = given[i];
      SetOption(options, name, ValueBehind(given, i));
    }
    Run(options);
    return 0;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-hexmesh-renderer: %s\n", error.what());
    return 1;
  }
}
