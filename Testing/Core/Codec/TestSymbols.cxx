// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Codec/Simd/SymbolRun-inl.h"
#include "Codec/SymbolWriter.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace banyan::testing
{
namespace
{

/// Those of the first band.
constexpr unsigned ContextsOfARun = residual::Classes;

/// Tokens in contexts that come and contexts that do not, with symbols of all sizes, in runs of all
/// lengths.
struct Tokens
{
  explicit Tokens(std::size_t count, unsigned seed)
  {
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < count; ++i)
    {
      const unsigned context = random() % 3 == 0 ? 7u : random() % ContextsOfARun / 2 * 2;
      const std::int32_t residual = static_cast<std::int32_t>(random()) >> random() % 32;
      std::uint32_t extra = 0;
      const int symbol = residual::SymbolOf(residual::Zigzag(residual), extra);
      this->Of.push_back(residual::TokenOf(static_cast<int>(context), symbol));
      this->Codes.push_back(residual::Zigzag(residual));
      if (symbol >= residual::DirectSymbols)
      {
        this->Extra.push_back(extra);
      }
    }
    for (std::size_t left = count; left > 0; left -= this->Runs.back())
    {
      const std::size_t longest = random() % 10 == 0 ? 4096 : 65;
      this->Runs.push_back(
        static_cast<std::uint16_t>(std::min<std::size_t>(left, 1 + random() % longest)));
    }
    this->Counts.Add(this->Of);
  }

  std::vector<std::uint8_t> Payload() const
  {
    return SymbolTables(this->Counts).Encode(this->Of, this->Extra, this->Runs);
  }

  banyan::DecodeTables Tables() const
  {
    return DecodeTablesOf(SymbolTables(this->Counts).Frequencies());
  }

  std::vector<std::uint16_t> Of;
  std::vector<std::uint32_t> Extra;
  std::vector<std::uint32_t> Codes;
  std::vector<std::uint16_t> Runs;
  ContextCounts Counts;
};

/// All codes that a reader gives.
std::vector<std::uint32_t> ReadAll(SymbolReader& reader, const Tokens& tokens)
{
  std::vector<std::uint32_t> codes;
  std::size_t begin = 0;
  for (const std::uint16_t run : tokens.Runs)
  {
    // Contexts differ within a run by what is added to the first one.
    std::vector<std::uint16_t> contexts;
    std::vector<std::int8_t> tops(run + 16u);
    for (std::size_t i = 0; i < run; ++i)
    {
      const int context = tokens.Of[begin + i] >> residual::TokenShift;
      contexts.push_back(
        static_cast<std::uint16_t>(reader.BandOf(0).Tables[context] << tans::TableBits));
    }
    HWY_NAMESPACE::ReadRun(
      reader, reader.TablesOf(0), contexts.data(), static_cast<int>(run), tops.data());
    tops.resize(run);
    for (const std::int8_t top : tops)
    {
      codes.push_back(residual::Zigzag(
        top < residual::EscapeSymbol
          ? top
          : reader.Long(static_cast<std::uint32_t>(top - residual::EscapeSymbol))));
    }
    begin += run;
  }
  return codes;
}

TEST(Symbols, ComeBack)
{
  int lanes = 0;
  for (const std::size_t count : { 1, 2, 3, 4, 5, 30, 64, 65, 100, 300, 1000, 50000 })
  {
    const Tokens tokens(count, static_cast<unsigned>(count));
    const std::vector<std::uint8_t> payload = tokens.Payload();
    lanes |= 1 << (payload[0] & 3);
    const auto decode = tokens.Tables();
    SymbolReader reader;
    reader.Open(decode, payload.data(), payload.size(), payload.size());
    EXPECT_FALSE(reader.AtEnd() && count > 8);
    ASSERT_EQ(ReadAll(reader, tokens), tokens.Codes) << count;
    EXPECT_TRUE(reader.AtEnd());
  }
  EXPECT_EQ(lanes, 15) << "some number of lanes never came";
}

TEST(Symbols, MissingAndSuperfluousBytesAreNoticed)
{
  const Tokens tokens(500, 9);
  const std::vector<std::uint8_t> good = tokens.Payload();
  const auto decode = tokens.Tables();
  const auto endsWell = [&](const std::vector<std::uint8_t>& payload)
  {
    SymbolReader reader;
    reader.Open(decode, payload.data(), payload.size(), payload.size());
    (void)ReadAll(reader, tokens);
    return reader.AtEnd();
  };
  EXPECT_TRUE(endsWell(good));
  std::vector<std::uint8_t> longer = good;
  longer.push_back(0);
  EXPECT_FALSE(endsWell(longer));
  for (const std::size_t bytes :
    { std::size_t{ 0 }, std::size_t{ 1 }, std::size_t{ 4 }, good.size() / 2, good.size() - 1 })
  {
    EXPECT_FALSE(endsWell({ good.begin(), good.begin() + static_cast<std::ptrdiff_t>(bytes) }))
      << bytes;
  }
}

/// A reader that was used before reads the next payload as a new one does.
TEST(Symbols, ReadersAreUsedAgain)
{
  const Tokens many(3000, 21);
  const Tokens few(40, 22);
  SymbolReader reader;
  for (const Tokens* tokens : { &many, &few, &many })
  {
    const std::vector<std::uint8_t> payload = tokens->Payload();
    const auto decode = tokens->Tables();
    reader.Open(decode, payload.data(), payload.size(), payload.size());
    ASSERT_EQ(ReadAll(reader, *tokens), tokens->Codes);
    EXPECT_TRUE(reader.AtEnd());
  }
}

TEST(Frequencies, ComeBackAndDamageIsNoticed)
{
  const SymbolTables tables(Tokens(20000, 4).Counts);
  const std::vector<std::uint8_t> packed = PackFrequencies(tables.Frequencies());
  const auto unpacked = UnpackFrequencies(packed.data(), packed.size());
  ASSERT_EQ(unpacked.size(), tables.Frequencies().size());
  for (std::size_t c = 0; c < unpacked.size(); ++c)
  {
    for (int s = 0; s < tans::SymbolCount; ++s)
    {
      ASSERT_EQ(unpacked[c].Count[s], tables.Frequencies()[c].Count[s]);
    }
  }
  for (std::size_t bytes = 0; bytes < packed.size(); ++bytes)
  {
    EXPECT_THROW(UnpackFrequencies(packed.data(), bytes), Error) << bytes;
  }
  std::vector<std::uint8_t> longer = packed;
  longer.push_back(0);
  EXPECT_THROW(UnpackFrequencies(longer.data(), longer.size()), Error);
  std::mt19937 random(5);
  for (int i = 0; i < 2000; ++i)
  {
    std::vector<std::uint8_t> bad = packed;
    bad[random() % bad.size()] = static_cast<std::uint8_t>(random());
    try
    {
      for (const tans::Frequencies& context : UnpackFrequencies(bad.data(), bad.size()))
      {
        EXPECT_TRUE(tans::Valid(context));
      }
    }
    catch (const Error&)
    {
    }
  }
}

} // namespace
} // namespace banyan::testing
