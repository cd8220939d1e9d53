// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_CacheBudget_h
#define banyan_Base_CacheBudget_h

#include <cstdint>

namespace banyan
{

/// Returns the bytes that the caches of a process may take together unless something else is asked
/// for: its part of an eighth of the machine's memory, but at least 512 MiB and at most 16 GiB.
/// @param machineBytes MachineMemory; 0 where it is not known
/// @param ranks that share the machine; less than 1 counts as 1
std::uint64_t UsualCacheBudget(std::uint64_t machineBytes, int ranks);

/// How many ranks of a parallel job run on this machine, as those who start them say in the
/// environment (Open MPI, MPICH, Slurm): before MPI is initialized, and without it. 1 where nobody
/// says.
int RanksStartedHere();

/// Returns the bytes that the caches of a process may take together: the environment variable
/// BANYAN_CACHE_MB, a whole number of MiB (0 keeps nothing), else UsualCacheBudget. Throws Error,
/// with a sentence that says what is wrong, when the variable holds anything else.
std::uint64_t CacheBudgetAskedFor();

/// The same, with the default in place of the error. For caches, which are made where nobody
/// expects one: SeriesFile::Open tells it before.
std::uint64_t CacheBudgetBytes();

} // namespace banyan

#endif
