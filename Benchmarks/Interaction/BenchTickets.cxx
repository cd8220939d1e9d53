// SPDX-License-Identifier: BSD-3-Clause
// Pictures that a client asks for by tickets, and does not wait for: how many come in a second on
// how many ranks, and what all but the rays takes. A line of CSV for each scene. See README.md.
#include "OptionValues.h"
#include "StandardScenes.h"
#include "TicketMeasure.h"
#include "TicketScene.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Parallel/Communicate/MpiCommunicator.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

namespace
{

using namespace banyan;
using namespace banyan::bench;

const char* const Help =
  "banyan-bench-tickets --output TABLE.csv [OPTIONS]\n"
  "  Draws an orbit and a drag as a client asks for them, and appends a line for each scene.\n"
  "  On several ranks with mpiexec.\n"
  "  --scenes LIST    S1, S2, opaque (a ray ends at its first sample), nothing (no rays, no probes);\n"
  "                   default S1,opaque,nothing\n"
  "  --samples N      per axis (default 256)\n"
  "  --picture N      pixels per side (default 1024)\n"
  "  --views N        of the orbit (default 30)\n"
  "  --simulate LIST  so many ranks as threads of this process: no wall-clock times, no drag\n";

const char* const Columns =
  "scene,ranks,simulated,samples,picture,views,sync_ms,ms,coarse_ms,pictures_per_s,"
  "pictures_per_s_per_rank,overhead,sync_cpu_ms,cpu_ms,sync_collectives,collectives,asks,"
  "sync_messages,messages,sync_bytes,bytes,drag_tickets,drag_pictures,drag_coarse_ms_p50,drag_coarse_ms_p95,"
  "drag_stop_ms_p50,drag_stop_ms_p95,drag_exact_ms\n";

struct Options
{
  bool Asked = false; ///< for help
  std::string Output;
  std::vector<std::string> Scenes{ "S1", "opaque", "nothing" };
  std::vector<int> Simulated; ///< numbers of ranks; none for those of MPI
  int Samples = 256;
  int Picture = 1024;
  TicketOptions Tickets;
};

Options Parse(const std::vector<std::string>& arguments)
{
  Options options;
  for (std::size_t i = 0; i < arguments.size(); ++i)
  {
    const std::string option = arguments[i];
    const auto text = [&] { return ValueBehind(arguments, i); };
    const auto count = [&](int low, int high) { return CountIn(option, text(), low, high); };
    if (option == "--help")
      options.Asked = true;
    else if (option == "--output")
      options.Output = text();
    else if (option == "--scenes")
      options.Scenes = SplitAtCommas(text());
    else if (option == "--samples")
      options.Samples = count(16, 2048);
    else if (option == "--picture")
      options.Picture = count(16, 8192);
    else if (option == "--views")
      options.Tickets.Views = count(1, 51); // an orbit of 7 degrees a view
    else if (option == "--simulate")
      for (const std::string& ranks : SplitAtCommas(text()))
        options.Simulated.push_back(CountIn(option, ranks, 1, 1024));
    else
      throw Error("There is no option '" + option + "'; --help lists them.");
  }
  if (!options.Asked && options.Output.empty())
  {
    throw Error("--output is missing; --help lists the options.");
  }
  return options;
}

double MedianOf(const std::vector<PictureTook>& pictures, double PictureTook::*number)
{
  std::vector<double> values(pictures.size());
  std::transform(pictures.begin(), pictures.end(), values.begin(),
    [number](const PictureTook& picture) { return picture.*number; });
  return QuantileOf(std::move(values), 0.5);
}

/// Times of ranks that share cores as threads of one process say nothing: they are left out.
void Write(const Options& options, const std::string& scene, int ranks, const TicketsTook& took)
{
  const bool fresh = !std::filesystem::exists(options.Output);
  std::FILE* const table = std::fopen(options.Output.c_str(), "a");
  if (!table)
  {
    throw Error("The table cannot be written.", { options.Output });
  }
  const auto direct = [&](double PictureTook::*number)
  { return MedianOf(took.Synchronous, number); };
  const auto late = [&](double PictureTook::*number) { return MedianOf(took.Late, number); };
  const bool simulated = !options.Simulated.empty();
  std::fprintf(table, "%s%s,%d,%d,%d,%d,%d,", fresh ? Columns : "", scene.c_str(), ranks,
    simulated ? 1 : 0, options.Samples, options.Picture, options.Tickets.Views);
  if (simulated)
  {
    std::fputs(",,,,,,", table);
  }
  else
  {
    double seconds = 0.0;
    for (const PictureTook& picture : took.Late)
    {
      seconds += 1e-3 * picture.Milliseconds;
    }
    const double rate = static_cast<double>(took.Late.size()) / seconds;
    const double ms = late(&PictureTook::Milliseconds);
    const double synchronous = direct(&PictureTook::Milliseconds);
    std::fprintf(table, "%.3f,%.3f,%.3f,%.4f,%.4f,%.4f,", synchronous, ms,
      late(&PictureTook::CoarseMilliseconds), rate, rate / ranks, ms / synchronous);
  }
  std::fprintf(table, "%.3f,%.3f,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f,%.0f,",
    direct(&PictureTook::ProcessorMilliseconds), late(&PictureTook::ProcessorMilliseconds),
    direct(&PictureTook::Collectives), late(&PictureTook::Collectives), late(&PictureTook::Asks),
    direct(&PictureTook::Messages), late(&PictureTook::Messages), direct(&PictureTook::Bytes),
    late(&PictureTook::Bytes));
  const DragTook& drag = took.Drag;
  if (drag.Tickets == 0)
  {
    std::fputs(",,,,,,\n", table);
  }
  else
  {
    std::fprintf(table, "%d,%zu,%.2f,%.2f,%.2f,%.2f,%.2f\n", drag.Tickets,
      drag.CoarseMilliseconds.size(), QuantileOf(drag.CoarseMilliseconds, 0.5),
      QuantileOf(drag.CoarseMilliseconds, 0.95), QuantileOf(drag.StopMilliseconds, 0.5),
      QuantileOf(drag.StopMilliseconds, 0.95), drag.ExactMilliseconds);
  }
  std::fclose(table);
}

/// On all ranks.
void MeasureScenes(
  const Options& options, Communicator& ranks, const std::shared_ptr<const Volume>& volume)
{
  for (const std::string& name : options.Scenes)
  {
    TicketOptions tickets = options.Tickets;
    tickets.Plans = name != "nothing";
    if (!options.Simulated.empty())
    {
      tickets.OneProcess = true;
      tickets.DragTickets = 0;
      tickets.Balancing = LoadBalancing::Off; // which goes by times
    }
    const TicketsTook took =
      MeasureTickets(ranks, TicketScene(volume, name, options.Picture), tickets);
    if (ranks.Rank() == 0)
    {
      Write(options, name, ranks.Size(), took);
    }
  }
}

void Simulate(const Options& options)
{
  const auto volume = StandardVolume(options.Samples, ThreadPool::Process());
  for (const int ranks : options.Simulated)
  {
    RunOnSimulatedRanks(
      ranks, [&](Communicator& communicator) { MeasureScenes(options, communicator, volume); });
  }
}

void MeasureOnMpi(const Options& options)
{
  MPI_Init(nullptr, nullptr);
  try
  {
    const MPI_Comm world = MPI_COMM_WORLD;
    const auto communicator = MakeMpiCommunicator(&world);
    MeasureScenes(options, *communicator, StandardVolume(options.Samples, ThreadPool::Process()));
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-tickets: %s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
  }
  MPI_Finalize();
}

} // namespace

int main(int argc, char** argv)
{
  try
  {
    const Options options = Parse({ argv + 1, argv + argc });
    ThreadPool::SetProcessWidth(1); // an engine of the study is a process of one thread
    if (options.Asked)
    {
      std::fputs(Help, stdout);
    }
    else if (!options.Simulated.empty())
    {
      Simulate(options);
    }
    else
    {
      MeasureOnMpi(options);
    }
    return EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "banyan-bench-tickets: %s\n", error.what());
  }
  return EXIT_FAILURE;
}
