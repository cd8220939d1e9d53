#include "Base/Error.h"
#include "Codec/SymbolReader.h"
#include "Codec/SymbolWriter.h"

#include <gtest/gtest.h>

#include <random>
#include <vector>

namespace banyan::testing
{
namespace
{

/// Tokens in contexts that come and contexts that do not, with symbols of all sizes.
struct Tokens
{
  explicit Tokens(std::size_t count, unsigned seed)
  {
    std::mt19937 random(seed);
    for (std::size_t i = 0; i < count; ++i)
    {
      const unsigned context = random() % 3 == 0 ? 7 : random() % residual::ContextCount / 2 * 2;
      const std::int32_t residual = static_cast<std::int32_t>(random()) >> random() % 32;
      std::uint32_t extra = 0;
      const int symbol = residual::SymbolOf(residual::Zigzag(residual), extra);
      this->Of.push_back(static_cast<std::uint16_t>(context << 8 | static_cast<unsigned>(symbol)));
      this->Codes.push_back(residual::Zigzag(residual));
      if (symbol >= residual::DirectSymbols)
      {
        this->Extra.push_back(extra);
      }
    }
    this->Counts.Add(this->Of);
  }

  std::vector<std::uint16_t> Of;
  std::vector<std::uint32_t> Extra;
  std::vector<std::uint32_t> Codes;
  ContextCounts Counts;
};

/// Zigzag code of the next residual in a context.
std::uint32_t NextCode(SymbolReader::Cursor& cursor, int context)
{
  const std::uint32_t entry = cursor.Next(cursor.Tables + context * tans::TableSize);
  if ((entry >> residual::EscapeBit & 1u) != 0)
  {
    return residual::Zigzag(cursor.Long(entry));
  }
  const std::int32_t residual = static_cast<std::int32_t>(entry) >> 24;
  EXPECT_EQ(entry >> 14 & 15u, residual::Magnitude(residual::Zigzag(residual)));
  return residual::Zigzag(residual);
}

TEST(Symbols, ComeBack)
{
  for (const std::size_t count : { 1, 2, 3, 4, 5, 64, 65, 1000, 50000 })
  {
    const Tokens tokens(count, static_cast<unsigned>(count));
    const SymbolTables tables(tokens.Counts);
    const std::vector<std::uint8_t> payload = tables.Encode(tokens.Of, tokens.Extra);
    const auto decode = DecodeTablesOf(tables.Frequencies());
    SymbolReader reader;
    reader.Open(decode.data(), payload.data(), payload.size(), payload.size());
    SymbolReader::Cursor cursor = reader.Here();
    for (std::size_t i = 0; i < count; ++i)
    {
      EXPECT_FALSE(reader.AtEnd() && i + 8 < count);
      ASSERT_EQ(NextCode(cursor, tokens.Of[i] >> 8), tokens.Codes[i]) << i << " of " << count;
      if (i % 32 == 31)
      {
        reader.MoveTo(cursor);
        cursor = reader.Here();
      }
    }
    reader.MoveTo(cursor);
    EXPECT_TRUE(reader.AtEnd());
  }
}

TEST(Symbols, MissingAndSuperfluousBytesAreNoticed)
{
  const Tokens tokens(500, 9);
  const SymbolTables tables(tokens.Counts);
  const std::vector<std::uint8_t> good = tables.Encode(tokens.Of, tokens.Extra);
  const auto decode = DecodeTablesOf(tables.Frequencies());
  const auto endsWell = [&](const std::vector<std::uint8_t>& payload)
  {
    SymbolReader reader;
    reader.Open(decode.data(), payload.data(), payload.size(), payload.size());
    for (std::size_t i = 0; i < tokens.Of.size(); ++i)
    {
      SymbolReader::Cursor cursor = reader.Here();
      (void)NextCode(cursor, tokens.Of[i] >> 8);
      reader.MoveTo(cursor);
    }
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
    const SymbolTables tables(tokens->Counts);
    const std::vector<std::uint8_t> payload = tables.Encode(tokens->Of, tokens->Extra);
    const auto decode = DecodeTablesOf(tables.Frequencies());
    reader.Open(decode.data(), payload.data(), payload.size(), payload.size());
    for (std::size_t i = 0; i < tokens->Of.size(); ++i)
    {
      SymbolReader::Cursor cursor = reader.Here();
      ASSERT_EQ(NextCode(cursor, tokens->Of[i] >> 8), tokens->Codes[i]);
      reader.MoveTo(cursor);
    }
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
