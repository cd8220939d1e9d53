// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/Tans.h"

#include <algorithm>
#include <array>
#include <numeric>

namespace banyan::tans
{
namespace
{

/// Scatters the symbols over the table: a step that is coprime to the size visits every slot.
std::array<std::uint8_t, TableSize> Spread(const Frequencies& frequencies)
{
  constexpr int step = (TableSize >> 1) + (TableSize >> 3) + 3;
  std::array<std::uint8_t, TableSize> slots = {};
  int position = 0;
  for (int symbol = 0; symbol < SymbolCount; ++symbol)
  {
    for (int i = 0; i < frequencies.Count[symbol]; ++i)
    {
      slots[static_cast<std::size_t>(position)] = static_cast<std::uint8_t>(symbol);
      position = (position + step) & (TableSize - 1);
    }
  }
  return slots;
}

} // namespace

Frequencies Normalize(const std::uint32_t* counts)
{
  Frequencies result;
  const std::uint64_t total = std::accumulate(counts, counts + SymbolCount, std::uint64_t{ 0 });
  if (total == 0)
  {
    return result;
  }
  int sum = 0;
  for (int s = 0; s < SymbolCount; ++s)
  {
    if (counts[s] > 0)
    {
      const std::uint64_t scaled = (std::uint64_t{ counts[s] } * TableSize + total / 2) / total;
      result.Count[s] = static_cast<std::uint16_t>(std::max<std::uint64_t>(1, scaled));
      sum += result.Count[s];
    }
  }
  // The rest that rounding left, or took too much, goes where one more or less changes the least:
  // to the symbol with the most slots per count.
  while (sum != TableSize)
  {
    const bool more = sum < TableSize;
    int best = -1;
    std::uint64_t bestGain = 0;
    for (int s = 0; s < SymbolCount; ++s)
    {
      const std::uint64_t slots = result.Count[s];
      if (slots == 0 || (!more && slots == 1))
      {
        continue;
      }
      const std::uint64_t gain =
        more
          ? (std::uint64_t{ counts[s] } << 16) / (2 * slots + 1)
          : (std::uint64_t{ 1 } << 62) / ((std::uint64_t{ counts[s] } << 16) / (2 * slots - 1) + 1);
      if (best < 0 || gain > bestGain)
      {
        best = s;
        bestGain = gain;
      }
    }
    result.Count[best] = static_cast<std::uint16_t>(result.Count[best] + (more ? 1 : -1));
    sum += more ? 1 : -1;
  }
  return result;
}

bool Valid(const Frequencies& frequencies)
{
  const int sum = std::accumulate(frequencies.Count, frequencies.Count + SymbolCount, 0);
  return sum == 0 || sum == TableSize;
}

void BuildDecodeTable(const Frequencies& frequencies, DecodeEntry* table)
{
  if (std::accumulate(frequencies.Count, frequencies.Count + SymbolCount, 0) == 0)
  {
    std::fill(table, table + TableSize, DecodeEntry{});
    return;
  }
  const std::array<std::uint8_t, TableSize> slots = Spread(frequencies);
  std::array<int, SymbolCount> next = {};
  std::copy(frequencies.Count, frequencies.Count + SymbolCount, next.begin());
  for (int slot = 0; slot < TableSize; ++slot)
  {
    const std::uint8_t symbol = slots[static_cast<std::size_t>(slot)];
    const int state = next[symbol]++;
    const int bits = TableBits - (31 - __builtin_clz(static_cast<unsigned>(state)));
    table[slot].Symbol = symbol;
    table[slot].Bits = static_cast<std::uint8_t>(bits);
    table[slot].Base = static_cast<std::uint16_t>((state << bits) - TableSize);
  }
}

EncodeTable::EncodeTable(const Frequencies& frequencies)
  : Next(TableSize)
{
  std::copy(frequencies.Count, frequencies.Count + SymbolCount, this->Used);
  std::array<int, SymbolCount> place = {};
  int sum = 0;
  for (int s = 0; s < SymbolCount; ++s)
  {
    this->First[s] = static_cast<std::uint16_t>(sum);
    place[static_cast<std::size_t>(s)] = sum;
    sum += frequencies.Count[s];
  }
  if (sum == 0)
  {
    return;
  }
  const std::array<std::uint8_t, TableSize> slots = Spread(frequencies);
  for (int slot = 0; slot < TableSize; ++slot)
  {
    const std::uint8_t symbol = slots[static_cast<std::size_t>(slot)];
    this->Next[static_cast<std::size_t>(place[symbol]++)] =
      static_cast<std::uint16_t>(TableSize + slot);
  }
}

} // namespace banyan::tans
