// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_MpiCommunicator_h
#define banyan_Parallel_MpiCommunicator_h

#include "Parallel/Communicator.h"

namespace banyan
{

/// How long ranks are waited for.
struct MpiPatience
{
  static constexpr double DefaultSeconds = 20.0;

  /// What the variable BANYAN_RANK_LIMIT_SECONDS says, or DefaultSeconds. Throws Error.
  static double FromEnvironment();

  /// When a rank gives no sign of life for so long, or does not get on, and others wait for it, the
  /// job ends (MPI_Abort) with a sentence on standard error. Ranks that draw may take as long as
  /// they like. 0 waits for ever.
  double Seconds = FromEnvironment();
  /// Is told the sentence before.
  std::function<void(const std::string&)> Tell;
};

/// A communicator over a duplicate of an MPI communicator (collective; the duplicate is freed with
/// the object unless MPI has ended before).
/// Works under MPI_THREAD_SINGLE: only the calling thread speaks MPI. Tags must lie in [0, 32767].
/// Errors that MPI reports, and messages of another size than expected, are thrown as Error.
/// @param mpiComm address of an MPI_Comm; void, so that no header of Core needs MPI
/// @param largestMessageBytes longer messages are cut, because MPI counts in int; the same on all
///        ranks, at most 2^30 (tests make it small)
/// @param patience that of the first rank is for all
std::unique_ptr<Communicator> MakeMpiCommunicator(const void* mpiComm,
  std::size_t largestMessageBytes = std::size_t{ 1 } << 30, const MpiPatience& patience = {});

/// Ranks of the communicator that run on this machine (collective).
int RanksOnThisNode(const void* mpiComm);

} // namespace banyan

#endif
