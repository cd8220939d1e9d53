// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/ContextClustering.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace banyan::testing
{
namespace
{

/// Counts of symbols that fall off geometrically.
void Fill(std::array<std::uint32_t, tans::SymbolCount>& counts, double total, double ratio)
{
  double share = total * (1 - ratio);
  for (std::uint32_t& count : counts)
  {
    count = static_cast<std::uint32_t>(share);
    share *= ratio;
  }
}

TEST(ContextClustering, FewSymbolsShareTablesAndManyDoNot)
{
  ContextCounts few, many;
  for (std::size_t c = 0; c < few.Of.size(); ++c)
  {
    const double ratio = 0.1 + 0.05 * static_cast<double>(c % 16);
    Fill(few.Of[c], 40, ratio);
    Fill(many.Of[c], 4e6, ratio);
  }
  few.Of[5] = {};
  ClusterContexts(few);
  ClusterContexts(many);
  std::size_t distinct = 0, distinctOfMany = 0;
  for (std::size_t c = 1; c < 16; ++c)
  {
    distinct += few.Of[c] != few.Of[c - 1] ? 1 : 0;
    distinctOfMany += many.Of[c] != many.Of[c - 1] ? 1 : 0;
  }
  EXPECT_LT(distinct, 8u);
  EXPECT_EQ(distinctOfMany, 15u);
  EXPECT_EQ(few.Of[5], (std::array<std::uint32_t, tans::SymbolCount>{})) << "it never comes";
}

/// Whatever is shared, all symbols that come have a code, and tables that are shared take less.
TEST(ContextClustering, AllSymbolsCanBeCoded)
{
  std::mt19937 random(11);
  ContextCounts counts;
  for (auto& context : counts.Of)
  {
    for (int i = static_cast<int>(random() % 4); i > 0; --i)
    {
      context[random() % tans::SymbolCount] += 1 + random() % 9;
    }
  }
  const SymbolTables tables(counts);
  std::vector<tans::Frequencies> own;
  for (std::size_t c = 0; c < counts.Of.size(); ++c)
  {
    own.push_back(tans::Normalize(counts.Of[c].data()));
    for (std::size_t s = 0; s < counts.Of[c].size(); ++s)
    {
      ASSERT_TRUE(counts.Of[c][s] == 0 || tables.Frequencies()[c].Count[s] > 0) << c << " " << s;
    }
  }
  const std::vector<std::uint8_t> packed = PackFrequencies(tables.Frequencies());
  EXPECT_LT(2 * packed.size(), PackFrequencies(own).size());
  EXPECT_LT(DecodeTablesOf(tables.Frequencies()).Bytes(), DecodeTablesOf(own).Bytes());
}

} // namespace
} // namespace banyan::testing
