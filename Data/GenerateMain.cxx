// SPDX-License-Identifier: BSD-3-Clause
#include "GenerateOptions.h"
#include "ImageSeriesWriter.h"
#include "MeshSeriesWriter.h"
#include "OctreeMesh.h"
#include "RawSeriesWriter.h"
#include "SeriesCatalog.h"

#include "Base/ThreadPool.h"
#include "Base/Timer.h"

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <new>
#include <optional>

namespace
{

void GenerateMesh(
  const banyan::GenerateOptions& options, const banyan::SeriesKind& kind, banyan::ThreadPool& pool)
{
  const banyan::Timer timer;
  std::unique_ptr<banyan::MeshSeriesWriter> writer;
  std::optional<banyan::RawSeriesWriter> raw;
  if (!options.Raw.empty())
  {
    raw.emplace(options.Raw);
  }
  int done = 0;
  kind.GenerateMesh(options, pool,
    [&](const banyan::MeshStep& step)
    {
      const banyan::OctreeMesh& mesh = step.Mesh;
      if (done == 0)
      {
        std::fprintf(stderr, "%zu cells, %zu nodes, of which %zu hang, %.1f s\n%s\n",
          mesh.CellCount(), mesh.NodeCount(), mesh.Hanging().size(), timer.Seconds(),
          step.About.c_str());
        if (!options.Output.empty())
        {
          writer = options.Format == "vtu"
                     ? banyan::MakeVtuWriter(options.Output, kind.FileName, mesh, options.Voxels)
                     : banyan::MakeExodusWriter(options.Output, kind.FileName, mesh);
        }
      }
      if (writer)
      {
        writer->AddStep(step.Time, step.Arrays);
      }
      if (raw)
      {
        raw->AddStep(*step.Arrays.at(0).Values);
      }
      std::fprintf(stderr, "step %d of %d, time %.3f, %.1f s\n", ++done, options.Steps, step.Time,
        timer.Seconds());
      if (done == options.Steps && writer)
      {
        writer->Finish();
      }
    });
  if (raw)
  {
    raw->Finish();
  }
}

void Generate(const banyan::GenerateOptions& options)
{
  const banyan::SeriesKind& kind = banyan::FindSeriesKind(options.Series);
  banyan::ThreadPool pool(
    options.Threads > 0 ? options.Threads : banyan::ThreadPool::DefaultWidth());
  if (kind.GenerateMesh)
  {
    GenerateMesh(options, kind, pool);
    return;
  }
  if (options.Output.empty() && kind.GenerateSlabs)
  {
    banyan::RawSeriesWriter raw(options.Raw);
    kind.GenerateSlabs(
      options, pool, [&raw](const std::vector<float>& values) { raw.AddStep(values); });
    raw.Finish();
    return;
  }
  std::optional<banyan::ImageSeriesWriter> images;
  if (!options.Output.empty())
  {
    const double edge = kind.Edge > 0.0 ? kind.Edge : options.Size;
    images.emplace(options.Output, kind.FileName, options.Size, edge);
  }
  std::optional<banyan::RawSeriesWriter> raw;
  if (!options.Raw.empty())
  {
    raw.emplace(options.Raw);
  }

  const banyan::Timer timer;
  int done = 0;
  kind.Generate(options, pool,
    [&](double time, const std::vector<banyan::ImageArray>& arrays)
    {
      if (images)
      {
        images->AddStep(time, arrays);
      }
      if (raw)
      {
        raw->AddStep(arrays.at(0).Values);
      }
      std::fprintf(
        stderr, "step %d of %d, time %.3f, %.1f s\n", ++done, options.Steps, time, timer.Seconds());
    });
  if (images)
  {
    images->Finish();
  }
  if (raw)
  {
    raw->Finish();
  }
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const banyan::GenerateOptions options = banyan::ParseGenerateOptions({ argv + 1, argv + argc });
    if (options.Help)
    {
      std::fputs(banyan::GenerateHelp().c_str(), stdout);
      return EXIT_SUCCESS;
    }
    Generate(options);
    return EXIT_SUCCESS;
  }
  catch (const std::bad_alloc&)
  {
    std::fprintf(
      stderr, "banyan-generate: There is not enough memory for this --size or --cells.\n");
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-generate: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
