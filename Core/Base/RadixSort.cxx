// SPDX-License-Identifier: BSD-3-Clause
#include "Base/RadixSort.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <array>
#include <utility>

namespace banyan
{
namespace
{

constexpr std::size_t Buckets = std::size_t{ 1 } << RadixDigitBits;

using Counts = std::array<std::size_t, Buckets>;

/// One digit of all keys, in as many parts as there are threads.
class Pass
{
public:
  Pass(std::size_t count, int shift, int bits, ThreadPool& pool)
    : Count(count)
    , Shift(shift)
    , Mask((std::size_t{ 1 } << bits) - 1)
    , Parts(static_cast<std::size_t>(pool.Width()))
    , Pool(pool)
    , Starts(Parts)
  {
  }

  /// @return false when all keys have the same digit
  bool Plan(const std::uint64_t* keys)
  {
    this->ForParts(
      [&](std::size_t part, std::size_t begin, std::size_t end)
      {
        Counts& counts = this->Starts[part];
        counts.fill(0);
        for (std::size_t i = begin; i < end; ++i)
        {
          ++counts[this->DigitOf(keys[i])];
        }
      });
    std::size_t next = 0;
    bool several = true;
    for (std::size_t bucket = 0; bucket < Buckets; ++bucket)
    {
      const std::size_t before = next;
      for (Counts& counts : this->Starts)
      {
        const std::size_t here = counts[bucket];
        counts[bucket] = next;
        next += here;
      }
      several = several && next - before != this->Count;
    }
    return several;
  }

  void Move(const std::uint64_t* keys, const std::uint32_t* values, std::uint64_t* toKeys,
    std::uint32_t* toValues)
  {
    this->ForParts(
      [&](std::size_t part, std::size_t begin, std::size_t end)
      {
        Counts& next = this->Starts[part];
        for (std::size_t i = begin; i < end; ++i)
        {
          const std::size_t to = next[this->DigitOf(keys[i])]++;
          toKeys[to] = keys[i];
          toValues[to] = values[i];
        }
      });
  }

private:
  std::size_t DigitOf(std::uint64_t key) const { return key >> this->Shift & this->Mask; }

  template <class Function>
  void ForParts(Function&& function)
  {
    this->Pool.ParallelFor(static_cast<std::int64_t>(this->Parts),
      [&](std::int64_t i)
      {
        const auto part = static_cast<std::size_t>(i);
        function(part, this->Count * part / this->Parts, this->Count * (part + 1) / this->Parts);
      });
  }

  std::size_t Count;
  int Shift;
  std::size_t Mask; ///< of the digit's bits
  std::size_t Parts;
  ThreadPool& Pool;
  std::vector<Counts> Starts; ///< per part and bucket: where the next key goes
};

/// Where keys and values are, and where they can be moved to.
struct TwoPlaces
{
  std::uint64_t* Keys[2];
  std::uint32_t* Values[2];
};

/// Sorts by one digit after the other, from one place to the other.
/// @return which place the sorted keys are in
int SortByDigits(const TwoPlaces& places, std::size_t count, int first, int end, ThreadPool& pool)
{
  int at = 0;
  for (int shift = first; shift < end; shift += RadixDigitBits)
  {
    Pass pass(count, shift, std::min(RadixDigitBits, end - shift), pool);
    if (pass.Plan(places.Keys[at]))
    {
      pass.Move(places.Keys[at], places.Values[at], places.Keys[1 - at], places.Values[1 - at]);
      at = 1 - at;
    }
  }
  return at;
}

} // namespace

void RadixSort(
  std::vector<std::uint64_t>& keys, std::vector<std::uint32_t>& values, int bits, ThreadPool& pool)
{
  if (std::is_sorted(keys.begin(), keys.end()))
  {
    return;
  }
  std::vector<std::uint64_t> otherKeys(keys.size());
  std::vector<std::uint32_t> otherValues(values.size());
  const TwoPlaces places{ { keys.data(), otherKeys.data() },
    { values.data(), otherValues.data() } };
  if (SortByDigits(places, keys.size(), 0, bits, pool) == 1)
  {
    keys.swap(otherKeys);
    values.swap(otherValues);
  }
}

void RadixSort(KeyedNumbers& numbers, int first, int end, ThreadPool& pool)
{
  if (std::is_sorted(numbers.Keys.get(), numbers.Keys.get() + numbers.Count))
  {
    return;
  }
  KeyedNumbers others(numbers.Count);
  const TwoPlaces places{ { numbers.Keys.get(), others.Keys.get() },
    { numbers.Values.get(), others.Values.get() } };
  if (SortByDigits(places, numbers.Count, first, end, pool) == 1)
  {
    std::swap(numbers, others);
  }
}

} // namespace banyan
