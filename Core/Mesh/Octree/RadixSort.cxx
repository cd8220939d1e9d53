// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/RadixSort.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <array>

namespace banyan
{
namespace
{

constexpr int DigitBits = 11;
constexpr std::size_t Buckets = std::size_t{ 1 } << DigitBits;

using Counts = std::array<std::size_t, Buckets>;

/// One digit of all keys, in as many parts as there are threads.
class Pass
{
public:
  Pass(std::size_t count, int shift, ThreadPool& pool)
    : Count(count)
    , Shift(shift)
    , Parts(static_cast<std::size_t>(pool.Width()))
    , Pool(pool)
    , Starts(Parts)
  {
  }

  /// @return false when all keys have the same digit
  bool Plan(const std::vector<std::uint64_t>& keys)
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

  void Move(const std::vector<std::uint64_t>& keys, const std::vector<std::uint32_t>& values,
    std::vector<std::uint64_t>& toKeys, std::vector<std::uint32_t>& toValues)
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
  std::size_t DigitOf(std::uint64_t key) const { return key >> this->Shift & (Buckets - 1); }

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
  std::size_t Parts;
  ThreadPool& Pool;
  std::vector<Counts> Starts; ///< per part and bucket: where the next key goes
};

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
  for (int shift = 0; shift < bits; shift += DigitBits)
  {
    Pass pass(keys.size(), shift, pool);
    if (pass.Plan(keys))
    {
      pass.Move(keys, values, otherKeys, otherValues);
      keys.swap(otherKeys);
      values.swap(otherValues);
    }
  }
}

} // namespace banyan
