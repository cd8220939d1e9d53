// SPDX-License-Identifier: BSD-3-Clause
// Time and error of the ray caster and of its peers, as CSV. See README.md.
#include "ConvergedImage.h"
#include "RayCastMeasure.h"
#include "RayCastOptions.h"
#include "RealScenes.h"
#include "StandardScenes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>

namespace
{

using namespace banyan::bench;

bool IsWanted(const std::vector<std::string>& wanted, const std::string& name)
{
  return wanted.empty() || std::find(wanted.begin(), wanted.end(), name) != wanted.end();
}

RendererList ChosenRenderers(const RayCastOptions& options)
{
  std::vector<std::string> missing;
  RendererList renderers = MakeVtkRenderers(options.Measuring.Threads, missing);
  for (const bool plain : { true, false })
  {
    renderers.insert(renderers.begin(), MakeBanyanRenderer(options.Measuring.Threads, plain));
  }
  for (const std::string& peer : missing)
  {
    std::fprintf(stderr,
      "%s is not measured: VTK was not found when this program was configured.\n", peer.c_str());
  }
  for (const std::string& name : options.Renderers)
  {
    if (std::none_of(renderers.begin(), renderers.end(),
          [&](const auto& renderer) { return renderer->Name() == name; }))
    {
      throw banyan::Error("There is no renderer '" + name + "', or it is not installed.");
    }
  }
  renderers.erase(
    std::remove_if(renderers.begin(), renderers.end(),
      [&](const auto& renderer) { return !IsWanted(options.Renderers, renderer->Name()); }),
    renderers.end());
  return renderers;
}

std::vector<BenchScene> ChosenScenes(const RayCastOptions& options, banyan::ThreadPool& pool)
{
  std::vector<BenchScene> scenes;
  const auto volume = StandardVolume(options.Size, pool);
  for (const StandardFunction function : { StandardFunction::S1, StandardFunction::S2 })
  {
    for (const bool shaded : { false, true })
    {
      scenes.push_back(StandardScene(volume, function, shaded, options.Picture));
    }
  }
  for (const std::string& description : options.Descriptions)
  {
    scenes.push_back(RealScene(description, options.Picture));
  }
  for (const std::string& name : options.Scenes)
  {
    if (std::none_of(scenes.begin(), scenes.end(),
          [&](const BenchScene& scene) { return scene.Name == name; }))
    {
      throw banyan::Error("There is no scene '" + name + "'.");
    }
  }
  scenes.erase(std::remove_if(scenes.begin(), scenes.end(),
                 [&](const BenchScene& scene) { return !IsWanted(options.Scenes, scene.Name); }),
    scenes.end());
  return scenes;
}

std::ofstream OpenReport(const RayCastOptions& options)
{
  const bool fresh = !options.Append || !std::filesystem::exists(options.Output);
  std::ofstream csv(options.Output, fresh ? std::ios::trunc : std::ios::app);
  if (fresh)
  {
    csv << RayCastCsvHeader() << std::endl;
  }
  if (!csv)
  {
    throw banyan::Error("The report cannot be written.", { options.Output });
  }
  return csv;
}

void Run(const RayCastOptions& options)
{
  const RendererList renderers = ChosenRenderers(options);
  banyan::ThreadPool pool(banyan::ThreadPool::DefaultWidth());
  std::ofstream csv = OpenReport(options);
  for (const BenchScene& scene : ChosenScenes(options, pool))
  {
    const banyan::Timer timer;
    const banyan::FloatImage reference =
      CachedConvergedImage(scene, options.ReferenceStep, options.References, pool);
    std::fprintf(
      stderr, "%s: the converged picture took %.1f s\n", scene.Name.c_str(), timer.Seconds());
    if (!options.Measuring.PictureFolder.empty())
    {
      WritePicture(Rounded(reference, scene.Picture),
        options.Measuring.PictureFolder + "/" + scene.Name + "-reference.ppm");
    }
    for (const RayCastMeasurement& measurement :
      MeasureScene(scene, reference, renderers, options.Measuring))
    {
      csv << RayCastCsvLine(measurement) << std::endl;
      std::fprintf(stderr, "%s\n", RayCastMessage(measurement).c_str());
    }
  }
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const RayCastOptions options = ParseRayCastOptions({ argv + 1, argv + argc });
    if (options.Help)
    {
      std::fputs(RayCastHelp().c_str(), stdout);
      return EXIT_SUCCESS;
    }
    Run(options);
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-raycast: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
