// SPDX-License-Identifier: BSD-3-Clause
// Frames and per-rank times of a camera path with zones that are balanced in different ways:
// figures 11 and 12 of "Dynamic load balancing for parallel volume rendering". See README.md.
#include "BalanceFrames.h"
#include "BestDivision.h"
#include "CameraPath.h"
#include "RealScenes.h"
#include "StandardScenes.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <cstdlib>
#include <exception>

namespace
{

using namespace banyan;
using namespace banyan::bench;

/// A CSV file, or standard output.
class Table
{
public:
  Table(const std::string& path, bool append, const char* header)
    : File(path.empty() ? stdout : std::fopen(path.c_str(), append ? "a" : "w"))
  {
    if (!this->File)
    {
      throw Error("The table cannot be written.", { path });
    }
    if (!append)
    {
      std::fprintf(this->File, "%s\n", header);
    }
  }
  ~Table()
  {
    if (this->File != stdout)
    {
      std::fclose(this->File);
    }
  }
  Table(const Table&) = delete;
  Table& operator=(const Table&) = delete;
  std::FILE* Get() const { return this->File; }

private:
  std::FILE* File;
};

BenchScene MakeScene(const BalanceOptions& options)
{
  if (!options.Series.empty())
  {
    return RealScene(options.Series, options.Picture);
  }
  const bool shaded = options.Scene == "S1-shaded" || options.Scene == "S2-shaded";
  const std::string function = options.Scene.substr(0, 2);
  if ((function != "S1" && function != "S2") || (options.Scene.size() > 2 && !shaded))
  {
    throw Error("There is no standard scene '" + options.Scene + "'; --help lists them.");
  }
  ThreadPool pool(1);
  return StandardScene(StandardVolume(options.Size, pool),
    function == "S1" ? StandardFunction::S1 : StandardFunction::S2, shaded, options.Picture);
}

/// Writes frames to both tables.
class Tables
{
public:
  explicit Tables(const BalanceOptions& options)
    : Frames(options.Output, options.Append, "frame,mode,ranks,imbalance,ms,bytes_moved")
  {
    if (!options.RankTimes.empty())
    {
      this->Ranks =
        std::make_unique<Table>(options.RankTimes, options.Append, "frame,mode,ranks,rank,ms");
    }
  }

  void Take(const BalanceFrame& frame)
  {
    const auto ranks = static_cast<int>(frame.RankMilliseconds.size());
    std::fprintf(this->Frames.Get(), "%d,%s,%d,%.4f,%.3f,%.0f\n", frame.Number, NameOf(frame.Mode),
      ranks, frame.Imbalance, frame.Milliseconds, frame.BytesMoved);
    for (int rank = 0; this->Ranks && rank < ranks; ++rank)
    {
      std::fprintf(this->Ranks->Get(), "%d,%s,%d,%d,%.3f\n", frame.Number, NameOf(frame.Mode),
        ranks, rank, frame.RankMilliseconds[static_cast<std::size_t>(rank)]);
    }
  }

private:
  Table Frames;
  std::unique_ptr<Table> Ranks;
};

void Run(const BalanceOptions& options)
{
  if (options.Mpi)
  {
    std::unique_ptr<Tables> tables;
    DrawOnMpiRanks([&] { return MakeScene(options); }, options,
      [&](const BalanceFrame& frame)
      {
        tables = tables ? std::move(tables) : std::make_unique<Tables>(options);
        tables->Take(frame);
      });
    return;
  }
  const BenchScene scene = MakeScene(options);
  if (!options.BrickTimes.empty())
  {
    const Table table(options.BrickTimes, true, "");
    WriteBrickTimes(scene, options, table.Get());
    return;
  }
  if (!options.BestDivisions.empty())
  {
    const Table table(options.BestDivisions, false, "frame,ranks,imbalance,ms,zones_drawn");
    WriteBestDivisions(scene, options, table.Get());
    return;
  }
  Tables tables(options);
  for (const int ranks : options.Ranks)
  {
    for (const BalanceMode mode : options.Modes)
    {
      DrawSimulated(
        scene, options, mode, ranks, [&](const BalanceFrame& frame) { tables.Take(frame); });
    }
  }
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const BalanceOptions options = ParseBalanceOptions({ argv + 1, argv + argc });
    if (options.Help)
    {
      std::fputs(BalanceHelp, stdout);
    }
    else
    {
      Run(options);
    }
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-balance: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
