// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Communicate_MpiCommunicator_h
#define banyan_Parallel_Communicate_MpiCommunicator_h

#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Watchdog/MpiTimeout.h"

namespace banyan
{

/// A communicator over a duplicate of an MPI communicator (collective; the duplicate is freed with
/// the object unless MPI has ended before).
/// Works under MPI_THREAD_SINGLE: only the calling thread speaks MPI. Tags must lie in [0, 32767].
/// Errors that MPI reports, and messages of another size than expected, are thrown as Error.
/// @param mpiComm address of an MPI_Comm; void, so that no header of Core needs MPI
/// @param largestMessageBytes longer messages are cut, because MPI counts in int; the same on all
///        ranks, at most 2^30 (tests make it small)
/// @param timeout that of the first rank is for all: unless it is 0, a watchdog is attached
std::unique_ptr<Communicator> MakeMpiCommunicator(const void* mpiComm,
  std::size_t largestMessageBytes = std::size_t{ 1 } << 30, const MpiTimeout& timeout = {});

} // namespace banyan

#endif
