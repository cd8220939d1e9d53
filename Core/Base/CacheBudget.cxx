#include "Base/CacheBudget.h"

#include "Base/Error.h"

#include <cerrno>
#include <cstdlib>
#include <string>

namespace banyan
{
namespace
{

constexpr std::uint64_t DefaultMegabytes = 512;
constexpr std::uint64_t MostMegabytes = std::uint64_t{ 1 } << 40; // in bytes still a number

} // namespace

std::uint64_t CacheBudgetAskedFor()
{
  const char* const text = std::getenv("BANYAN_CACHE_MB");
  if (text == nullptr)
  {
    return DefaultMegabytes << 20;
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
    return DefaultMegabytes << 20;
  }
}

} // namespace banyan
