// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_RadixSort_h
#define banyan_Base_RadixSort_h

#include "Base/LargePages.h"

#include <cstddef>
#include <cstdint>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Keys are sorted by so many of their bits at a time.
constexpr int RadixDigitBits = 11;

/// Sorts keys, and the values that go with them, by key; equal keys stay in the order that they
/// had. Takes time in proportion to the number of keys and of bits, none if they are in order
/// already, and as much memory again as keys and values.
/// @param values as many as keys
/// @param bits that keys have at most, 1 to 64
void RadixSort(
  std::vector<std::uint64_t>& keys, std::vector<std::uint32_t>& values, int bits, ThreadPool& pool);

/// Many keys and the values that go with them, in large pages. They hold anything at first.
struct KeyedNumbers
{
  explicit KeyedNumbers(std::size_t count)
    : Count(count)
    , Keys(NewInLargePages<std::uint64_t>(count))
    , Values(NewInLargePages<std::uint32_t>(count))
  {
  }

  std::size_t Count;
  ArrayInLargePages<std::uint64_t> Keys;
  ArrayInLargePages<std::uint32_t> Values;
};

/// Does the same by the bits [first, end) of keys alone: keys that agree in these stay in the order
/// that they had, unless all keys are in order already.
void RadixSort(KeyedNumbers& numbers, int first, int end, ThreadPool& pool);

} // namespace banyan

#endif
