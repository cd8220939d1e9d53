// SPDX-License-Identifier: BSD-3-Clause
#include "BalanceOptions.h"

#include "OptionValues.h"

#include "Base/Error.h"

#include <algorithm>

namespace banyan::bench
{
namespace
{

const BalanceMode AllModes[] = { BalanceMode::Off, BalanceMode::SliceStep,
  BalanceMode::MeasuredCost };

std::vector<BalanceMode> ModesIn(const std::string& text)
{
  std::vector<BalanceMode> modes;
  for (const std::string& name : SplitAtCommas(text))
  {
    const auto* found = std::find_if(std::begin(AllModes), std::end(AllModes),
      [&](BalanceMode mode) { return name == NameOf(mode); });
    if (found == std::end(AllModes))
    {
      throw Error("There is no mode '" + name + "': off, slice-step and measured-cost are there.");
    }
    modes.push_back(*found);
  }
  return modes;
}

} // namespace

const char* const BalanceHelp =
  "banyan-bench-balance [OPTIONS]\n"
  "  Draws a camera path with zones that are balanced in different ways. Ranks are simulated: "
  "their\n"
  "  zones are drawn one after the other on one thread, and the processor time of each counts.\n"
  "  --series FILE.json   real data (see banyan-bench-raycast); default a standard scene\n"
  "  --scene NAME         S1, S2 (default), S1-shaded, S2-shaded\n"
  "  --size N             samples per axis of the standard scene (default 256)\n"
  "  --path NAME          zoom (default), rest, jumps, standard\n"
  "  --picture N          pixels per side (default 512)    --frames N   (default 60)\n"
  "  --ranks LIST         default 2,4,8,16\n"
  "  --modes LIST         default off,slice-step,measured-cost\n"
  "  --plane-step N       cells between places of planes (default 1; encoded series have 8)\n"
  "  --keep-axes          planes move, but do not turn\n"
  "  --counted            what ranks did is counted, 3 ns a sample, in place of their time: the "
  "same\n"
  "                       whatever else the machine does\n"
  "  --turn-percent N     they turn when frames are expected to be so much faster (default 15)\n"
  "  --output FILE.csv    default standard output          --append     to it\n"
  "  --rank-times FILE.csv   each rank's milliseconds too\n"
  "  --brick-times FILE.csv  what the bricks of each frame took, and nothing else\n"
  "  --best-divisions FILE.csv   the least work of the slowest rank that planes can be put to, for "
  "every\n"
  "                       tenth frame: searched by drawing each zone that is tried; nothing else\n"
  "  --pieces             with --mpi: each rank holds a piece, and bricks go from rank to rank\n"
  "  --exchange           with --mpi: all ranks fetch the bricks of the first, and nothing is "
  "drawn\n"
  "  --disk FILE.banyan   with --exchange: how long reading and decoding them takes, too; encodes "
  "the\n"
  "                       volume first if there is no such file\n"
  "  --composite-after    with --mpi: odd frames are composited after the last ray, to compare\n"
  "  --mpi                on the real ranks of mpirun, in wall-clock time; one thread each\n";

const char* NameOf(BalanceMode mode)
{
  return mode == BalanceMode::Off         ? "off"
         : mode == BalanceMode::SliceStep ? "slice-step"
                                          : "measured-cost";
}

BalanceOptions ParseBalanceOptions(const std::vector<std::string>& arguments)
{
  BalanceOptions options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string& option = arguments[i];
    const auto value = [&]() -> const std::string& { return ValueBehind(arguments, i); };
    const auto count = [&](int most) { return CountIn(option, value(), 1, most); };
    if (option == "--help")
      options.Help = true;
    else if (option == "--append")
      options.Append = true;
    else if (option == "--keep-axes")
      options.Turns = false;
    else if (option == "--counted")
      options.Counted = true;
    else if (option == "--composite-after")
      options.CompositeAfter = true;
    else if (option == "--turn-percent")
      options.TurnPercent = count(1000);
    else if (option == "--mpi")
      options.Mpi = true;
    else if (option == "--pieces")
      options.Pieces = true;
    else if (option == "--exchange")
      options.Exchange = true;
    else if (option == "--series")
      options.Series = value();
    else if (option == "--scene")
      options.Scene = value();
    else if (option == "--path")
      options.Path = value();
    else if (option == "--output")
      options.Output = value();
    else if (option == "--rank-times")
      options.RankTimes = value();
    else if (option == "--brick-times")
      options.BrickTimes = value();
    else if (option == "--best-divisions")
      options.BestDivisions = value();
    else if (option == "--disk")
      options.Disk = value();
    else if (option == "--size")
      options.Size = count(2048);
    else if (option == "--picture")
      options.Picture = count(8192);
    else if (option == "--plane-step")
      options.PlaneStep = count(64);
    else if (option == "--frames")
      options.Frames = count(100000);
    else if (option == "--modes")
      options.Modes = ModesIn(value());
    else if (option == "--ranks")
    {
      options.Ranks.clear();
      for (const std::string& part : SplitAtCommas(value()))
      {
        options.Ranks.push_back(CountIn(option, part, 1, 4096));
      }
    }
    else
      throw Error("There is no option '" + option + "'; --help lists them.");
  }
  return options;
}

} // namespace banyan::bench
