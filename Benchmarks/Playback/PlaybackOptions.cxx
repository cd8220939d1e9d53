// SPDX-License-Identifier: BSD-3-Clause
#include "PlaybackOptions.h"

#include "OptionValues.h"

#include "Base/Error.h"

namespace banyan::bench
{

const char* const PlaybackHelp =
  "banyan-bench-playback --encode SERIES.json --series FILE.banyan [--bound PART]\n"
  "  Encodes a raw series; the bound is a part of the range (default 1/512).\n"
  "banyan-bench-playback --paper SERIES.json --series FILE.banyan [--brick N] [OPTIONS]\n"
  "  Prints what the study's way saves on a raw series with 8-bit codes, and on what was\n"
  "  encoded of it; bricks of N cells (default 16), --name, --picture and --frames as below.\n"
  "banyan-bench-playback --series FILE.banyan --output TABLE.csv [OPTIONS]\n"
  "  Plays a series, and appends a line for each frame. On several ranks with mpiexec.\n"
  "  --name NAME       of the series in the table\n"
  "  --mode MODE       play, loop (the second round), rest (one step), turn (the camera),\n"
  "                    function (opacities change a little); default play\n"
  "  --function NAME   ramp (opacity grows with the value), top (the highest tenth),\n"
  "                    ends (opaque away from the middle); default ramp\n"
  "  --picture N       pixels per side (default 512)\n"
  "  --tolerance T     in 1/255 (default 8); 0 takes a sample per voxel\n"
  "  --frames N        at most (default 50)\n"
  "  --rounds N        how often a series plays in a pass (default 1)\n"
  "  --passes N        each begins with empty caches (default 3)\n"
  "  --reuse LIST      off, on (default both)\n"
  "  --shaded          with light\n"
  "  --count           counts what of each picture is as in the step before, at a sample\n"
  "                    per voxel, in place of times\n"
  "  --truth           measures errors, against samples 1/8 of a voxel apart\n"
  "  --cold            drops the files from the system's cache before each pass\n"
  "  --shown MS        milliseconds between frames (default 0)\n"
  "  --budget MIB      of the caches (default: the process's own)\n"
  "  --pictures DIR    writes the picture of each frame, in floats\n";

namespace
{

PlayMode ModeOf(const std::string& name)
{
  const std::vector<std::string> names{ "play", "loop", "rest", "turn", "function" };
  for (std::size_t i = 0; i < names.size(); ++i)
  {
    if (names[i] == name)
    {
      return static_cast<PlayMode>(i);
    }
  }
  throw Error("There is no mode '" + name + "'; --help lists them.");
}

std::vector<bool> ReuseOf(const std::string& list)
{
  std::vector<bool> reuse;
  for (const std::string& word : SplitAtCommas(list))
  {
    if (word != "on" && word != "off")
    {
      throw Error("--reuse takes on, off, or both.");
    }
    reuse.push_back(word == "on");
  }
  return reuse;
}

} // namespace

PlaybackOptions ParsePlaybackOptions(const std::vector<std::string>& arguments)
{
  PlaybackOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string option = arguments[i];
    const auto text = [&] { return ValueBehind(arguments, i); };
    const auto count = [&](int low, int high) { return CountIn(option, text(), low, high); };
    const auto number = [&](double low, double high)
    { return NumberIn(option, text(), low, high); };
    if (option == "--help")
      options.Help = true;
    else if (option == "--encode")
      options.Encode = text();
    else if (option == "--paper")
      options.Paper = text();
    else if (option == "--brick")
      options.BrickCells = count(1, 1024);
    else if (option == "--series")
      options.Series = text();
    else if (option == "--name")
      options.Name = text();
    else if (option == "--output")
      options.Output = text();
    else if (option == "--function")
      options.Function = text();
    else if (option == "--pictures")
      options.Pictures = text();
    else if (option == "--mode")
      options.Mode = ModeOf(text());
    else if (option == "--reuse")
      options.Reuse = ReuseOf(text());
    else if (option == "--picture")
      options.Picture = count(16, 8192);
    else if (option == "--frames")
      options.Frames = count(1, 100000);
    else if (option == "--rounds")
      options.Rounds = count(1, 100000);
    else if (option == "--passes")
      options.Passes = count(1, 100);
    else if (option == "--budget")
      options.BudgetMiB = count(0, 1 << 20);
    else if (option == "--tolerance")
      options.Tolerance = number(0.0, 255.0);
    else if (option == "--bound")
      options.Bound = number(0.0, 1.0);
    else if (option == "--shown")
      options.ShownMilliseconds = number(0.0, 1e6);
    else if (option == "--shaded")
      options.Shaded = true;
    else if (option == "--count")
      options.Count = true;
    else if (option == "--truth")
      options.Truth = true;
    else if (option == "--cold")
      options.Cold = true;
    else
      throw Error("There is no option '" + option + "'; --help lists them.");
  }
  if (!options.Help && options.Series.empty())
  {
    throw Error("--series is missing; --help lists the options.");
  }
  return options;
}

} // namespace banyan::bench
