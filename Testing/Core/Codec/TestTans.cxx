// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/Tans.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace banyan::testing
{
namespace
{

using Counts = std::vector<std::uint32_t>;

/// Distributions that go wrong easily: one symbol, two, all equal, all but equal, powers, counts
/// near the limits of 32 bits, one among very many; and random ones.
std::vector<Counts> Distributions()
{
  const auto empty = [] { return Counts(tans::SymbolCount, 0); };
  std::vector<Counts> result;
  for (const int symbol : { 0, 1, tans::SymbolCount - 1 })
  {
    result.push_back(empty());
    result.back()[static_cast<std::size_t>(symbol)] = 5;
  }
  result.push_back(empty());
  result.back()[3] = 0xffffffffu;
  result.back()[70] = 1;
  result.push_back(Counts(tans::SymbolCount, 1));
  result.push_back(Counts(tans::SymbolCount, 0xffffffffu));
  result.push_back(Counts(tans::SymbolCount, 1));
  result.back()[10] = 1000000000;
  result.push_back(empty());
  for (std::size_t s = 0; s < 31; ++s)
  {
    result.back()[s] = 1u << s;
  }
  std::mt19937 random(1);
  for (int i = 0; i < 40; ++i)
  {
    result.push_back(empty());
    for (std::uint32_t& count : result.back())
    {
      count = random() % 3 == 0 ? 0 : random() >> random() % 32;
    }
    result.back()[random() % tans::SymbolCount] += 1;
  }
  return result;
}

TEST(Tans, FrequenciesSumUpAndForgetNoSymbol)
{
  for (const Counts& counts : Distributions())
  {
    const tans::Frequencies frequencies = tans::Normalize(counts.data());
    EXPECT_TRUE(tans::Valid(frequencies));
    EXPECT_EQ(std::accumulate(frequencies.Count, frequencies.Count + tans::SymbolCount, 0),
      tans::TableSize);
    for (int s = 0; s < tans::SymbolCount; ++s)
    {
      EXPECT_EQ(frequencies.Count[s] > 0, counts[static_cast<std::size_t>(s)] > 0) << s;
    }
  }
  const tans::Frequencies none = tans::Normalize(Counts(tans::SymbolCount, 0).data());
  EXPECT_TRUE(tans::Valid(none));
  EXPECT_EQ(std::accumulate(none.Count, none.Count + tans::SymbolCount, 0), 0);
}

TEST(Tans, OtherSumsAreNotValid)
{
  tans::Frequencies frequencies;
  frequencies.Count[0] = tans::TableSize - 1;
  EXPECT_FALSE(tans::Valid(frequencies));
  frequencies.Count[5] = 1;
  EXPECT_TRUE(tans::Valid(frequencies));
  frequencies.Count[6] = 1;
  EXPECT_FALSE(tans::Valid(frequencies));
}

/// Every state leads to a state: bits and base never leave the table.
TEST(Tans, DecodeTablesStayInside)
{
  std::vector<tans::DecodeEntry> table(tans::TableSize);
  for (const Counts& counts : Distributions())
  {
    tans::BuildDecodeTable(tans::Normalize(counts.data()), table.data());
    for (const tans::DecodeEntry& entry : table)
    {
      EXPECT_LE(entry.Bits, tans::TableBits);
      EXPECT_LE(entry.Base + (1 << entry.Bits), tans::TableSize);
      EXPECT_GT(counts[entry.Symbol], 0u);
    }
  }
  tans::BuildDecodeTable({}, table.data());
  for (const tans::DecodeEntry& entry : table)
  {
    EXPECT_EQ(entry.Symbol + entry.Bits + entry.Base, 0);
  }
}

struct Coded
{
  std::uint32_t Value;
  int Bits;
};

TEST(Tans, SymbolsComeBackInAboutTheirEntropy)
{
  std::mt19937 random(2);
  std::vector<tans::DecodeEntry> table(tans::TableSize);
  for (const Counts& counts : Distributions())
  {
    const tans::Frequencies frequencies = tans::Normalize(counts.data());
    std::discrete_distribution<int> draw(frequencies.Count, frequencies.Count + tans::SymbolCount);
    std::vector<int> symbols(20000);
    double entropy = 0;
    for (int& symbol : symbols)
    {
      symbol = draw(random);
      entropy -= std::log2(frequencies.Count[symbol] / double(tans::TableSize));
    }
    const tans::EncodeTable encode(frequencies);
    std::uint32_t state = tans::TableSize;
    std::vector<Coded> written;
    double bits = 0;
    for (std::size_t i = symbols.size(); i-- > 0;)
    {
      ASSERT_TRUE(encode.Has(symbols[i]));
      Coded coded{};
      state = encode.Put(state, symbols[i], coded.Value, coded.Bits);
      ASSERT_TRUE(state >= tans::TableSize && state < 2 * tans::TableSize);
      written.push_back(coded);
      bits += coded.Bits;
    }
    EXPECT_LE(bits, 1.02 * entropy + 16);
    tans::BuildDecodeTable(frequencies, table.data());
    std::uint32_t at = state - tans::TableSize;
    for (std::size_t i = 0; i < symbols.size(); ++i)
    {
      const tans::DecodeEntry entry = table[at];
      const Coded coded = written[symbols.size() - 1 - i];
      ASSERT_EQ(entry.Symbol, symbols[i]);
      ASSERT_EQ(entry.Bits, coded.Bits);
      at = entry.Base + coded.Value;
    }
    EXPECT_EQ(at, 0u);
  }
}

} // namespace
} // namespace banyan::testing
