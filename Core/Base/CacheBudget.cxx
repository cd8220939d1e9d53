// SPDX-License-Identifier: BSD-3-Clause
#include "Base/CacheBudget.h"

#include "Base/AvailableMemory.h"
#include "Base/Error.h"

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <string>

namespace banyan
{
namespace
{

constexpr std::uint64_t LeastUsual = std::uint64_t{ 512 } << 20;
constexpr std::uint64_t MostUsual = std::uint64_t{ 16 } << 30;
constexpr std::uint64_t MostMegabytes = std::uint64_t{ 1 } << 40; // in bytes still a number

std::uint64_t UsualHere()
{
  static const std::size_t machineBytes = MachineMemory();
  return UsualCacheBudget(machineBytes, RanksStartedHere());
}

} // namespace

std::uint64_t UsualCacheBudget(std::uint64_t machineBytes, int ranks)
{
  const std::uint64_t part = machineBytes / 8 / static_cast<std::uint64_t>(std::max(1, ranks));
  return std::clamp(part, LeastUsual, MostUsual);
}

int RanksStartedHere()
{
  // Slurm writes "4(x2),3" for two machines of four tasks and one of three: the first has most.
  for (const char* const name :
    { "OMPI_COMM_WORLD_LOCAL_SIZE", "MPI_LOCALNRANKS", "SLURM_TASKS_PER_NODE" })
  {
    const char* const text = std::getenv(name);
    const long ranks = text ? std::strtol(text, nullptr, 10) : 0;
    if (ranks > 0)
    {
      return static_cast<int>(std::min(ranks, 1L << 20));
    }
  }
  return 1;
}

std::uint64_t CacheBudgetAskedFor()
{
  const char* const text = std::getenv("BANYAN_CACHE_MB");
  if (text == nullptr)
  {
    return UsualHere();
  }
  const std::string digits = text;
  errno = 0;
  const unsigned long long megabytes = std::strtoull(text, nullptr, 10);
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos || errno != 0 ||
      megabytes > MostMegabytes)
  {
    throw Error(
      "The environment variable BANYAN_CACHE_MB is \"" + digits +
      "\". It must be a whole number of megabytes without a unit, for example 512, or not be set");
  }
  return std::uint64_t{ megabytes } << 20;
}

std::uint64_t CacheBudgetBytes()
{
  try
  {
    return CacheBudgetAskedFor();
  }
  catch (const Error&)
  {
    return UsualHere();
  }
}

} // namespace banyan
