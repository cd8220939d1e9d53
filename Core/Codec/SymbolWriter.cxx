#include "Codec/SymbolWriter.h"

#include "Base/Error.h"

#include <cstring>

namespace banyan
{
namespace
{

/// Collects bits, lowest first.
class BitWriter
{
public:
  explicit BitWriter(std::size_t expectedBytes) { this->Bytes.reserve(expectedBytes); }

  void Put(std::uint32_t value, int bits)
  {
    this->Word |= std::uint64_t{ value } << this->Filled;
    this->Filled += bits;
    while (this->Filled >= 8)
    {
      this->Bytes.push_back(static_cast<std::uint8_t>(this->Word));
      this->Word >>= 8;
      this->Filled -= 8;
    }
  }

  std::vector<std::uint8_t> Finish()
  {
    if (this->Filled > 0)
    {
      this->Bytes.push_back(static_cast<std::uint8_t>(this->Word));
    }
    return std::move(this->Bytes);
  }

private:
  std::vector<std::uint8_t> Bytes;
  std::uint64_t Word = 0;
  int Filled = 0;
};

} // namespace

void ContextCounts::Add(const std::vector<std::uint16_t>& tokens)
{
  for (const std::uint16_t token : tokens)
  {
    ++this->Of[token >> 8][token & 0xff];
  }
}

void ContextCounts::Add(const ContextCounts& other)
{
  for (std::size_t c = 0; c < this->Of.size(); ++c)
  {
    for (std::size_t s = 0; s < this->Of[c].size(); ++s)
    {
      this->Of[c][s] += other.Of[c][s];
    }
  }
}

SymbolTables::SymbolTables(const ContextCounts& counts)
  : Tables(residual::ContextCount)
{
  for (std::size_t c = 0; c < counts.Of.size(); ++c)
  {
    this->Of.push_back(tans::Normalize(counts.Of[c].data()));
    const tans::EncodeTable encode(this->Of.back());
    Table& table = this->Tables[c];
    std::copy(encode.Next.begin(), encode.Next.end(), table.Next.begin());
    for (int s = 0; s < tans::SymbolCount; ++s)
    {
      const std::uint32_t frequency = encode.Used[s];
      if (frequency == 0)
      {
        continue;
      }
      int most = 0; // bits written from the greatest states
      while ((2u * tans::TableSize - 1u) >> most >= 2 * frequency)
      {
        ++most;
      }
      Transform& transform = table.Symbols[static_cast<std::size_t>(s)];
      transform.DeltaBits = most == 0 ? 0
                                      : (static_cast<std::uint32_t>(most) << 16) -
                                          (frequency << most);
      transform.DeltaState =
        static_cast<std::int32_t>(encode.First[s]) - static_cast<std::int32_t>(frequency);
    }
  }
}

std::vector<std::uint8_t> SymbolTables::Encode(
  const std::vector<std::uint16_t>& tokens, const std::vector<std::uint32_t>& extra) const
{
  thread_local std::vector<std::uint32_t> written; // bits << 4 | their number
  written.resize(tokens.size());
  std::uint32_t lanes[tans::Lanes];
  std::fill(lanes, lanes + tans::Lanes, static_cast<std::uint32_t>(tans::TableSize));
  for (std::size_t i = tokens.size(); i-- > 0;)
  {
    const Table& table = this->Tables[tokens[i] >> 8];
    const Transform& transform = table.Symbols[tokens[i] & 0xff];
    std::uint32_t& state = lanes[i % tans::Lanes];
    const std::uint32_t bits = (state + transform.DeltaBits) >> 16;
    written[i] = (state & ((1u << bits) - 1u)) << 4 | bits;
    state = table.Next[static_cast<std::size_t>(
      static_cast<std::int32_t>(state >> bits) + transform.DeltaState)];
  }
  BitWriter writer(tokens.size() / 2 + 16);
  for (const std::uint32_t lane : lanes)
  {
    writer.Put(lane - tans::TableSize, tans::TableBits);
  }
  std::size_t nextExtra = 0;
  for (std::size_t i = 0; i < tokens.size(); ++i)
  {
    writer.Put(written[i] >> 4, static_cast<int>(written[i] & 15u));
    const int symbol = tokens[i] & 0xff;
    if (symbol >= residual::DirectSymbols)
    {
      writer.Put(extra[nextExtra++], residual::ExtraBits(symbol));
    }
  }
  return writer.Finish();
}

std::vector<std::uint8_t> PackFrequencies(const std::vector<tans::Frequencies>& frequencies)
{
  // Per context: number of symbols up to the last that comes, then their frequencies, 7 bits per
  // byte. The bytes are compressed with the table that they are part of.
  std::vector<std::uint8_t> bytes;
  for (const tans::Frequencies& context : frequencies)
  {
    int count = tans::SymbolCount;
    while (count > 0 && context.Count[count - 1] == 0)
    {
      --count;
    }
    bytes.push_back(static_cast<std::uint8_t>(count));
    for (int s = 0; s < count; ++s)
    {
      const unsigned frequency = context.Count[s];
      if (frequency >= 128)
      {
        bytes.push_back(static_cast<std::uint8_t>(128 + (frequency & 127)));
        bytes.push_back(static_cast<std::uint8_t>(frequency >> 7));
      }
      else
      {
        bytes.push_back(static_cast<std::uint8_t>(frequency));
      }
    }
  }
  return bytes;
}

std::vector<tans::Frequencies> UnpackFrequencies(const std::uint8_t* data, std::size_t bytes)
{
  std::vector<tans::Frequencies> result(residual::ContextCount);
  std::size_t at = 0;
  const auto next = [&]() -> unsigned
  {
    if (at >= bytes)
    {
      throw Error("The frequencies of a table of symbols end too early");
    }
    return data[at++];
  };
  for (tans::Frequencies& context : result)
  {
    const unsigned count = next();
    if (count > static_cast<unsigned>(tans::SymbolCount))
    {
      throw Error("A table of symbols has too many of them");
    }
    for (unsigned s = 0; s < count; ++s)
    {
      unsigned frequency = next();
      frequency = frequency < 128 ? frequency : (frequency & 127) + (next() << 7);
      context.Count[s] = static_cast<std::uint16_t>(frequency);
    }
    if (!tans::Valid(context))
    {
      throw Error("The frequencies of a table of symbols do not sum up");
    }
  }
  if (at != bytes)
  {
    throw Error("The frequencies of a table of symbols are followed by more");
  }
  return result;
}

std::vector<std::uint32_t> DecodeTablesOf(const std::vector<tans::Frequencies>& frequencies)
{
  std::vector<std::uint32_t> tables;
  tables.reserve(frequencies.size() * tans::TableSize);
  tans::DecodeEntry context[tans::TableSize];
  for (const tans::Frequencies& each : frequencies)
  {
    tans::BuildDecodeTable(each, context);
    for (const tans::DecodeEntry& entry : context)
    {
      tables.push_back(residual::Packed(entry));
    }
  }
  return tables;
}

} // namespace banyan
