// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/TokenHistogram.h"

#include <gtest/gtest.h>

#include <random>

namespace
{

using namespace banyan;

TEST(TokenHistogram, CountsAsContextCountsDo)
{
  std::mt19937 random(7);
  std::uniform_int_distribution<std::size_t> context(0, residual::ContextCount - 1);
  std::uniform_int_distribution<std::size_t> symbol(0, tans::SymbolCount - 1);
  TokenHistogram counter;
  ContextCounts expected;
  // None, odd numbers and even ones, and the same token often.
  for (const int count : { 0, 1, 2, 7, 500, 501 })
  {
    std::vector<std::uint16_t> tokens;
    for (int i = 0; i < count; ++i)
    {
      tokens.push_back(i % 3 == 1 ? tokens.back()
                                  : static_cast<std::uint16_t>(
                                      (context(random) << residual::TokenShift) + symbol(random)));
    }
    counter.Add(tokens);
    expected.Add(tokens);
    EXPECT_EQ(counter.Counts().Of, expected.Of) << count;
  }
}

} // namespace
