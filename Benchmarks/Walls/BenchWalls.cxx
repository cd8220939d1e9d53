// SPDX-License-Identifier: BSD-3-Clause
// Draws walls as many ranks divide them, one rank's part after the other's, and tells what that
// takes. See README.md and walls.sh.
#include "BrickRates.h"
#include "OptionValues.h"
#include "RealWall.h"
#include "WallRanks.h"
#include "WallScenes.h"

#include "Base/Error.h"
#include "Parallel/Fields/DrawnField.h"
#include "Render/Sampling/SamplingPlan.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <numeric>

namespace
{

using namespace banyan;
using namespace banyan::bench;
namespace fs = std::filesystem;

const char* const Help =
  "banyan-bench-walls --work DIR [OPTIONS]\n"
  "  Draws a made-up volume on walls, and prints a line of CSV per division and column.\n"
  "  --volume NAME    deep (default) or flat            --part P    of its samples per axis\n"
  "  --views LIST     of whole, turned-30, turned-80, zoomed (default all)\n"
  "  --columns LIST   megapixels:tiles:ranks (default 4:1:1)\n"
  "  --frames N       by which ranks are balanced before (default 3)\n"
  "  --no-pan         only what is at rest\n"
  "  --work DIR       for frames\n"
  "  --then COMMAND   for each view and column of several ranks: is given the folder of its frames,\n"
  "                   megapixels, tiles and view; the folder is removed afterwards\n"
  "  --real DIR       on the ranks of mpirun: draws the first view and column with the zones and\n"
  "                   regions of frames that --then has kept there\n";

struct Options
{
  std::string Volume = "deep";
  double Part = 1.0;
  std::vector<std::string> Views{ "whole", "turned-30", "turned-80", "zoomed" };
  std::vector<WallColumn> Columns{ { 4.0, 1, 1 } };
  int Frames = 3;
  bool Pans = true;
  std::string Work;
  std::string Then;
  std::string Real;
  bool Help = false;
};

WallColumn ColumnIn(const std::string& text)
{
  WallColumn column;
  if (std::sscanf(text.c_str(), "%lf:%d:%d", &column.Megapixels, &column.Tiles, &column.Ranks) !=
        3 ||
      !(column.Megapixels > 0.0) || column.Tiles < 1 || column.Ranks < column.Tiles)
  {
    throw Error("'" + text + "' is no column: it needs megapixels:tiles:ranks, 24:6:16 say.");
  }
  return column;
}

Options Parse(const std::vector<std::string>& arguments)
{
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string& option = arguments[i];
    const auto value = [&]() -> const std::string& { return ValueBehind(arguments, i); };
    if (option == "--help")
      options.Help = true;
    else if (option == "--no-pan")
      options.Pans = false;
    else if (option == "--volume")
      options.Volume = value();
    else if (option == "--part")
      options.Part = NumberIn(option, value(), 0.01, 1.0);
    else if (option == "--views")
      options.Views = SplitAtCommas(value());
    else if (option == "--frames")
      options.Frames = CountIn(option, value(), 1, 1000);
    else if (option == "--work")
      options.Work = value();
    else if (option == "--then")
      options.Then = value();
    else if (option == "--real")
      options.Real = value();
    else if (option == "--columns")
    {
      options.Columns.clear();
      for (const std::string& part : SplitAtCommas(value()))
      {
        options.Columns.push_back(ColumnIn(part));
      }
    }
    else
      throw Error("There is no option '" + option + "'; --help lists them.");
  }
  if (options.Work.empty() && options.Real.empty() && !options.Help)
  {
    throw Error("--work needs a folder for frames.");
  }
  return options;
}

class Walls
{
public:
  explicit Walls(const Options& options)
    : Given(options)
    , Bench(WallScene(options.Volume, options.Part, this->Pool))
    , Source(this->Bench.Data->Array(), BrickCells, MaskRange{ 0.0, 255.0 }, this->Pool)
  {
    const std::string folder = this->EmptyFolder("rates");
    this->Rates = MeasuredBrickRates(*this->Bench.Data, folder);
    fs::remove_all(folder);
    std::fprintf(stderr, "%s: a brick has %.0f bytes and takes %.1f us\n", options.Volume.c_str(),
      this->Rates.Bytes, 1e6 * this->Rates.Seconds);
  }

  void Draw(const WallColumn& column, const std::string& view)
  {
    const std::string folder = this->EmptyFolder("frames");
    // All bricks are packed before: they are in a picture that follows others.
    const Wall whole(column.Megapixels, 1);
    WallRanks(this->Source, 1, true).Draw(this->Planned(view, whole, 0.0), whole, {}, 4);
    for (const bool byPicture : { false, true })
    {
      this->DrawDivided(column, view, byPicture, folder);
    }
    const std::string command = this->Given.Then + " '" + folder + "' " +
                                std::to_string(column.Megapixels) + " " +
                                std::to_string(column.Tiles) + " " + view;
    if (!this->Given.Then.empty() && column.Ranks > 1 && std::system(command.c_str()) != 0)
    {
      throw Error("'" + command + "' failed.");
    }
    fs::remove_all(folder);
  }

private:
  std::string EmptyFolder(const std::string& name) const
  {
    std::string folder = this->Given.Work + "/" + name;
    fs::remove_all(folder);
    fs::create_directories(folder);
    return folder;
  }

  /// Planned as a still picture.
  RayScene Planned(const std::string& view, const Wall& wall, double pan)
  {
    return PlannedOnWall(this->Bench, this->Source, view, wall, pan, this->Pool);
  }

  /// One line at rest, and one for a pan.
  void DrawDivided(
    const WallColumn& column, const std::string& view, bool byPicture, const std::string& folder)
  {
    const Wall wall(column.Megapixels, column.Tiles);
    const RayScene scene = this->Planned(view, wall, 0.0);
    WallRanks ranks(this->Source, column.Ranks, byPicture);
    // Where it is cut a picture matters to the last tile; zones are the same with half of the
    // pixels per axis.
    const Wall small(column.Megapixels / 4.0, column.Tiles);
    const RayScene cheap = byPicture ? scene : this->Planned(view, small, 0.0);
    for (int frame = 0; frame < this->Given.Frames && column.Ranks > 1; ++frame)
    {
      ranks.Draw(cheap, byPicture ? wall : small, {}, byPicture ? 4 : 1);
    }
    const std::string mine = folder + (byPicture ? "/by-picture" : "/by-data");
    fs::create_directories(mine);
    const WallFrame rest = ranks.Draw(scene, wall, column.Ranks > 1 ? mine : "");
    this->Print(column, view, byPicture, rest, nullptr);
    if (this->Given.Pans)
    {
      const WallFrame moved = ranks.Draw(this->Planned(view, wall, 0.05), wall, {});
      this->Print(column, view + "-pan", byPicture, moved, &rest);
    }
  }

  /// @param before null where nothing has to come
  void Print(const WallColumn& column, const std::string& view, bool byPicture,
    const WallFrame& frame, const WallFrame* before) const
  {
    double most = 0.0;
    double all = 0.0;
    for (std::size_t rank = 0; before && rank < frame.Bricks.size(); ++rank)
    {
      std::vector<BrickName> fresh;
      std::set_difference(frame.Bricks[rank].begin(), frame.Bricks[rank].end(),
        before->Bricks[rank].begin(), before->Bricks[rank].end(), std::back_inserter(fresh));
      most = std::max(most, static_cast<double>(fresh.size()));
      all += static_cast<double>(fresh.size());
    }
    const std::vector<double>& took = frame.RankSeconds;
    std::printf("%s,%g,%d,%d,%s,%s,%.3f,%.3f,%.3f,%.0f\n", this->Given.Volume.c_str(),
      column.Megapixels, column.Tiles, column.Ranks, view.c_str(),
      byPicture ? "by-picture" : "by-data", 1e3 * *std::max_element(took.begin(), took.end()),
      1e3 * std::accumulate(took.begin(), took.end(), 0.0) / static_cast<double>(took.size()),
      1e3 * most * this->Rates.Seconds, all * this->Rates.Bytes);
    std::fflush(stdout);
  }

  const Options Given;
  ThreadPool Pool{ 1 };
  const BenchScene Bench;
  ArrayBrickSource Source;
  BrickRates Rates;
};

void Run(const Options& options)
{
  if (!options.Real.empty())
  {
    ThreadPool pool(1);
    const BenchScene scene = WallScene(options.Volume, options.Part, pool);
    DrawRealWall(scene, options.Columns.front(), options.Views.front(), options.Real);
    return;
  }
  Walls walls(options);
  for (const std::string& view : options.Views)
  {
    for (const WallColumn& column : options.Columns)
    {
      walls.Draw(column, view);
    }
  }
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const Options options = Parse({ argv + 1, argv + argc });
    if (options.Help)
    {
      std::fputs(Help, stdout);
    }
    else
    {
      Run(options);
    }
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-walls: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
