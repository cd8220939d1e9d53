// SPDX-License-Identifier: BSD-3-Clause
#include "RayCastOptions.h"

#include "OptionValues.h"

#include "Base/Error.h"

#include <filesystem>

namespace banyan::bench
{

RayCastOptions ParseRayCastOptions(const std::vector<std::string>& arguments)
{
  RayCastOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string& option = arguments[i];
    const auto value = [&]() -> const std::string& { return ValueBehind(arguments, i); };
    if (option == "--help")
      options.Help = true;
    else if (option == "--append")
      options.Append = true;
    else if (option == "--output")
      options.Output = value();
    else if (option == "--references")
      options.References = value();
    else if (option == "--pictures")
      options.Measuring.PictureFolder = value();
    else if (option == "--scenes")
      options.Scenes = SplitAtCommas(value());
    else if (option == "--renderers")
      options.Renderers = SplitAtCommas(value());
    else if (option == "--settings")
    {
      for (const std::string& number : SplitAtCommas(value()))
        options.Measuring.Settings.push_back(NumberIn(option, number, 1e-3, 255.0));
    }
    else if (option == "--threads")
      options.Measuring.Threads = CountIn(option, value(), 1, 1024);
    else if (option == "--repeat")
      options.Measuring.Repeat = CountIn(option, value(), 1, 1000);
    else if (option == "--patience")
      options.Measuring.PatienceSeconds = NumberIn(option, value(), 0.0, 1e6);
    else if (option == "--goals-only")
      options.Measuring.GoalsOnly = true;
    else if (option == "--size")
      options.Size = CountIn(option, value(), 8, 1024);
    else if (option == "--picture")
      options.Picture = CountIn(option, value(), 16, 4096);
    else if (option == "--reference-step")
      options.ReferenceStep = NumberIn(option, value(), 1e-3, 1.0);
    else if (option.rfind("--", 0) == 0)
      throw Error("There is no option '" + option + "'; --help lists them.");
    else
      options.Descriptions.push_back(option);
  }
  if (!options.Help && options.Output.empty())
  {
    throw Error("--output is needed.");
  }
  if (options.References.empty())
  {
    options.References = std::filesystem::path(options.Output).parent_path().string();
  }
  return options;
}

std::string RayCastHelp()
{
  return "banyan-bench-raycast --output FILE.csv [OPTIONS] [SERIES.json...]\n"
         "  Measures time per frame and error of the ray caster and of its peers, one line per\n"
         "  scene, renderer and setting. Needs an X display for VTK's renderers.\n"
         "  SERIES.json         adds a scene with real data: a raw series, described as for\n"
         "                      banyan-bench-codec, whose name is known in RealScenes.cxx\n"
         "  --append            adds to FILE.csv instead of writing it anew\n"
         "  --size N            samples per axis of the standard scenes (default 256)\n"
         "  --picture N         pixels per side (default 1024)\n"
         "  --scenes LIST       only these (default all), e.g. S1-256,S2-256-shaded,bonsai\n"
         "  --renderers LIST    only these (default all)\n"
         "  --settings LIST     only these sample distances and tolerances (default all)\n"
         "  --threads N         that each renderer may use (default 1)\n"
         "  --repeat N          timed frames, of which the median counts (default 3)\n"
         "  --patience S        settings whose frames would take longer than S seconds together\n"
         "                      are timed less often, at least once, and twice with one sample\n"
         "                      per voxel (default 6)\n"
         "  --goals-only        one sample per voxel only, where no goal compares renderers: on\n"
         "                      real data, and of vtk-fixed-point\n"
         "  --reference-step D  sample distance of the converged picture in voxels (default 1/16)\n"
         "  --references DIR    keeps the converged pictures (default: the folder of FILE.csv)\n"
         "  --pictures DIR      writes pictures at step 1 there, as .ppm\n";
}

} // namespace banyan::bench
