// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/Residual.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace banyan::testing
{
namespace
{

constexpr std::int32_t Least = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t Greatest = std::numeric_limits<std::int32_t>::max();

std::vector<std::int32_t> Residuals()
{
  std::vector<std::int32_t> result = { Least, Least + 1, Greatest, Greatest - 1 };
  for (std::int32_t i = -300; i <= 300; ++i)
  {
    result.push_back(i);
  }
  for (int bit = 0; bit < 31; ++bit)
  {
    for (const int near : { -1, 0, 1 })
    {
      result.push_back(static_cast<std::int32_t>((1u << bit) + static_cast<unsigned>(near)));
      result.push_back(static_cast<std::int32_t>(0u - (1u << bit) + static_cast<unsigned>(near)));
    }
  }
  std::mt19937 random(3);
  for (int i = 0; i < 1000; ++i)
  {
    result.push_back(static_cast<std::int32_t>(random()));
  }
  return result;
}

TEST(Residual, EveryNumberHasASymbolAndComesBack)
{
  for (const std::int32_t residual : Residuals())
  {
    const std::uint32_t code = residual::Zigzag(residual);
    ASSERT_EQ(residual::Unzigzag(code), residual);
    std::uint32_t extra = 0;
    const int symbol = residual::SymbolOf(code, extra);
    ASSERT_TRUE(symbol >= 0 && symbol < tans::SymbolCount) << residual;
    const int bits = residual::ExtraBits(symbol);
    ASSERT_TRUE(bits >= 0 && bits <= 31) << residual;
    ASSERT_LT(std::uint64_t{ extra }, std::uint64_t{ 1 } << bits) << residual;
    ASSERT_EQ(residual::CodeOf(symbol, extra), code) << residual;
  }
}

TEST(Residual, SmallOnesAreSymbolsByThemselves)
{
  EXPECT_EQ(residual::Zigzag(0), 0u);
  EXPECT_EQ(residual::Zigzag(1), 2u);
  EXPECT_EQ(residual::Zigzag(-1), 1u);
  std::uint32_t extra = 7;
  EXPECT_EQ(residual::SymbolOf(39, extra), 39);
  EXPECT_EQ(extra, 0u);
  EXPECT_EQ(residual::SymbolOf(40, extra), 40);
  EXPECT_EQ(residual::SymbolOf(41, extra), 41);
  EXPECT_EQ(extra, 0u);
  EXPECT_EQ(residual::SymbolOf(42, extra), 41);
  EXPECT_EQ(extra, 1u);
}

TEST(Residual, MagnitudesGrow)
{
  EXPECT_EQ(residual::MagnitudeOf(0), 0);
  for (std::int32_t size = 1; size < 1000; ++size)
  {
    EXPECT_GE(residual::MagnitudeOf(size), residual::MagnitudeOf(size - 1)) << size;
    EXPECT_EQ(residual::MagnitudeOf(size), residual::MagnitudeOf(-size)) << size;
    EXPECT_NEAR(residual::MagnitudeOf(size), std::min(8.0, 2 * std::log2(1 + size)), 0.8) << size;
  }
  EXPECT_EQ(residual::MagnitudeOf(Least), 8);
  EXPECT_EQ(residual::MagnitudeOf(Greatest), 8);
}

} // namespace
} // namespace banyan::testing
