#ifndef banyan_Base_CacheBudget_h
#define banyan_Base_CacheBudget_h

#include <cstdint>

namespace banyan
{

/// What the caches of a process may take together unless they are told otherwise: the environment
/// variable BANYAN_CACHE_MB, a whole number of MiB (0 keeps nothing), else 512 MiB. Throws Error,
/// with a sentence that says what is wrong, when the variable holds anything else.
std::uint64_t CacheBudgetAskedFor();

/// The same, with the default in place of the error. For caches, which are made where nobody
/// expects one: SeriesFile::Open tells it before.
std::uint64_t CacheBudgetBytes();

} // namespace banyan

#endif
