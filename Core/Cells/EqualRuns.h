// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_EqualRuns_h
#define banyan_Cells_EqualRuns_h

#include "Base/FirstFailure.h"
#include "Base/RadixSort.h"

#include <cstddef>
#include <cstdint>

namespace banyan
{

class ThreadPool;

/// Calls body(begin, end, worker) for each run of keys that agree from a bit on, in parallel.
/// @param numbers sorted by the bits from firstBit on
template <class Body>
void ForEqualRuns(const KeyedNumbers& numbers, int firstBit, ThreadPool& pool, const Body& body)
{
  const std::uint64_t* const keys = numbers.Keys.get();
  const auto joins = [&](std::size_t i)
  { return i > 0 && i < numbers.Count && keys[i] >> firstBit == keys[i - 1] >> firstBit; };
  FirstFailure none;
  ForRuns(static_cast<std::int64_t>(numbers.Count), pool, none,
    [&](std::int64_t first, std::int64_t last, int worker)
    {
      auto begin = static_cast<std::size_t>(first);
      // What began before is not this one's.
      while (joins(begin))
      {
        ++begin;
      }
      while (begin < static_cast<std::size_t>(last))
      {
        std::size_t end = begin + 1;
        while (joins(end))
        {
          ++end;
        }
        body(begin, end, worker);
        begin = end;
      }
    });
}

} // namespace banyan

#endif
