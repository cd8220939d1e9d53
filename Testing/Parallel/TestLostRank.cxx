// SPDX-License-Identifier: BSD-3-Clause
// Frames of several ranks, of which one is lost in the middle: what the others do is the test (see
// lost_rank.py). Never ends by itself when it waits for ever.
#include "Base/Error.h"
#include "Base/Progress.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/Communicate/MpiCommunicator.h"
#include "Parallel/Composite/Compositing.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>

#include <unistd.h>

namespace
{

using namespace banyan;

constexpr int Frames = 30;
constexpr int FrameOfMishap = 12;

void Sleep(double seconds)
{
  std::this_thread::sleep_for(std::chrono::duration<double>(seconds));
}

void Spin(double seconds)
{
  const Timer timer;
  while (timer.Seconds() < seconds)
  {
  }
}

/// What happens to the rank, among its work.
void Mishap(const std::string& what, Communicator& communicator)
{
  const double limit = MpiTimeout::FromEnvironment();
  if (what == "killed")
  {
    std::raise(SIGKILL);
  }
  else if (what == "stopped")
  {
    std::raise(SIGSTOP);
  }
  else if (what == "loops")
  {
    Spin(1e9);
  }
  else if (what == "throws")
  {
    throw Error("There is a worm in it.");
  }
  else if (what == "waits")
  {
    char byte = 0;
    communicator.Receive((communicator.Rank() + 1) % communicator.Size(), 7, &byte, 1);
    communicator.WaitAll();
  }
  else if (what == "slow")
  {
    // Gets on all the time.
    ThreadPool(1).ParallelFor(20, [&](std::int64_t) { Spin(0.1 * limit); });
  }
  else if (what == "disk")
  {
    Sleep(2.5 * limit);
  }
}

void DrawFrame(Communicator& communicator, ThreadPool& pool, const std::string& mishap)
{
  const PixelRect viewport{ { 0, 0 }, { 150, 100 } };
  FloatImage mine;
  mine.Rect = viewport;
  {
    const PhaseScope casting(Phase::Casting);
    mine.Pixels.resize(static_cast<std::size_t>(viewport.Count()));
    pool.ParallelFor(viewport.Size().y,
      [&](std::int64_t y)
      {
        Spin(20e-6);
        std::fill_n(&mine.At(0, static_cast<int>(y)), viewport.Size().x, glm::vec4(0.1f));
        if (y == 40)
        {
          Mishap(mishap, communicator);
        }
      });
  }
  const PhaseScope compositing(Phase::Compositing);
  std::vector<int> order;
  for (int rank = 0; rank < communicator.Size(); ++rank)
  {
    order.push_back(rank);
  }
  CompositeStatistics statistics;
  Composite(communicator, mine, order, viewport, {}, statistics);
}

/// As the mapper does it: who fails tells, and goes on when the others have failed as well.
void DrawAll(Communicator& communicator, const std::string& mishap)
{
  const bool unlucky = communicator.Rank() == 1;
  ThreadPool pool(2);
  for (int frame = 0; frame < Frames; ++frame)
  {
    const bool now = frame == FrameOfMishap;
    if (now && unlucky)
    {
      std::fprintf(stderr, "process %d\n", static_cast<int>(getpid()));
    }
    try
    {
      if (now && unlucky && mishap == "pipeline")
      {
        Sleep(2.5 * MpiTimeout::FromEnvironment());
      }
      if (now && mishap == "stopped-elsewhere")
      {
        // As ParaView's own compositing does it, without a limit.
        if (unlucky)
        {
          std::raise(SIGSTOP);
        }
        MPI_Barrier(MPI_COMM_WORLD);
      }
      if (now && mishap == "all-throw")
      {
        throw Error("All of them have a worm.");
      }
      const bool here = unlucky || mishap == "waits";
      DrawFrame(communicator, pool, now && here ? mishap : std::string());
    }
    catch (const std::exception& error)
    {
      communicator.LeaveTogether(error.what());
    }
  }
}

} // namespace

/// @param argv[1] what happens to rank 1
int main(int argc, char** argv)
{
  MPI_Init(&argc, &argv);
  const std::string mishap = argc > 1 ? argv[1] : "";
  {
    const MPI_Comm world = MPI_COMM_WORLD;
    MpiTimeout timeout;
    timeout.Tell = [](const std::string&) { std::fprintf(stderr, "told before\n"); };
    const auto communicator = MakeMpiCommunicator(&world, std::size_t{ 1 } << 30, timeout);
    const bool first = communicator->Rank() == 0;
    DrawAll(*communicator, mishap);
    if (first)
    {
      std::printf("all frames are drawn\n");
    }
  }
  MPI_Finalize();
  return EXIT_SUCCESS;
}
