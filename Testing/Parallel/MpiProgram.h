// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Parallel_MpiProgram_h
#define banyan_Testing_Parallel_MpiProgram_h

#include "Parallel/Communicate/MpiCommunicator.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <functional>
#include <string>

namespace banyan::testing
{

/// The whole of a program on MPI ranks.
/// @param seconds after which a rank that hangs ends itself; below the TIMEOUT of the test
/// @param run collective; says what is wrong on this rank, nothing if all is well
/// @return the exit status, that of the worst rank
inline int RunOnMpiRanks(
  int argc, char** argv, unsigned seconds, const std::function<std::string(Communicator&)>& run)
{
  alarm(seconds);
  MPI_Init(&argc, &argv);
  int status = EXIT_FAILURE;
  try
  {
    const MPI_Comm world = MPI_COMM_WORLD;
    const auto communicator = MakeMpiCommunicator(&world);
    const std::string wrong = run(*communicator);
    if (!wrong.empty())
    {
      std::fprintf(stderr, "rank %d: %s\n", communicator->Rank(), wrong.c_str());
    }
    status = AllMax(*communicator, wrong.empty() ? 0.0 : 1.0) > 0.0 ? EXIT_FAILURE : EXIT_SUCCESS;
  }
  catch (const std::exception& error)
  {
    std::fprintf(stderr, "%s\n", error.what());
    MPI_Abort(MPI_COMM_WORLD, EXIT_FAILURE);
  }
  MPI_Finalize();
  return status;
}

/// @return what is wrong when there are not as many ranks as the first argument says: a launcher
/// may have started that many separate processes instead
inline std::string CheckRankCount(const Communicator& communicator, int argc, char** argv)
{
  const bool right = argc > 1 && communicator.Size() == std::atoi(argv[1]);
  return right
           ? ""
           : std::to_string(communicator.Size()) + " ranks are running, not as many as asked for";
}

} // namespace banyan::testing

#endif
