#include "Codec/SymbolWriter.h"

#include "Base/Error.h"
#include "Codec/SharedContexts.h"

#include <algorithm>
#include <cstring>

namespace banyan
{
namespace
{

/// Collects bits, lowest first.
class BitWriter
{
public:
  /// @param bits that will be put at most
  explicit BitWriter(std::size_t bits)
    : Bytes(bits / 8 + 16)
  {
  }

  /// At most 32 bits.
  void Put(std::uint32_t value, std::uint32_t bits)
  {
    this->Add(value, bits);
    this->Flush();
  }

  /// At most 56 bits between two calls of Flush.
  void Add(std::uint32_t value, std::uint32_t bits)
  {
    this->Word |= std::uint64_t{ value } << this->Filled;
    this->Filled += bits;
  }

  void Flush()
  {
    std::memcpy(this->Bytes.data() + this->At, &this->Word, 8);
    const std::uint32_t whole = this->Filled >> 3;
    this->At += whole;
    this->Word >>= 8 * whole;
    this->Filled &= 7;
  }

  std::vector<std::uint8_t> Finish()
  {
    this->Bytes.resize(this->At + (this->Filled > 0 ? 1 : 0));
    this->Bytes.shrink_to_fit();
    return std::move(this->Bytes);
  }

private:
  std::vector<std::uint8_t> Bytes;
  std::size_t At = 0;
  std::uint64_t Word = 0;
  std::uint32_t Filled = 0;
};

} // namespace

void ContextCounts::Add(const std::vector<std::uint16_t>& tokens)
{
  for (const std::uint16_t token : tokens)
  {
    ++this->Of[token >> residual::TokenShift][token & residual::TokenMask];
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

SymbolTables::SymbolTables(const ContextCounts& each)
  : Tables(residual::ContextCount)
{
  ContextCounts counts = each;
  ShareContexts(counts);
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

/// More lanes decode faster, but each costs its first state: as many as make a payload about 1 %
/// larger.
int SymbolTables::LanesLogFor(const std::vector<std::uint16_t>& tokens) const
{
  const std::size_t every = tokens.size() < 1024 ? 1 : 8; // of many, some tell enough
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < tokens.size(); i += every)
  {
    const std::uint16_t token = tokens[i];
    bits += (tans::TableSize * 3 / 2 +
              this->Tables[token >> residual::TokenShift].Symbols[token & residual::TokenMask].DeltaBits) >> 16;
  }
  bits *= every;
  return bits < 600 ? 0 : bits < 2400 ? 1 : bits < 8000 ? 2 : 3;
}

std::vector<std::uint8_t> SymbolTables::Encode(const std::vector<std::uint16_t>& tokens,
  const std::vector<std::uint32_t>& extra, const std::vector<std::uint16_t>& runs) const
{
  const int lanesLog = this->LanesLogFor(tokens);
  const std::size_t lanes = std::size_t{ 1 } << lanesLog;
  thread_local std::vector<std::uint32_t> written; // bits << 4 | their number
  written.resize(tokens.size());
  std::uint32_t states[tans::MostLanes];
  std::fill(states, states + lanes, static_cast<std::uint32_t>(tans::TableSize));
  std::size_t begin = tokens.size();
  std::size_t total = 2 + lanes * tans::TableBits + 32 * extra.size();
  for (std::size_t run = runs.size(); run-- > 0;)
  {
    const std::size_t end = begin;
    begin -= runs[run];
    for (std::size_t i = end; i-- > begin;)
    {
      const Table& table = this->Tables[tokens[i] >> residual::TokenShift];
      const Transform& transform = table.Symbols[tokens[i] & residual::TokenMask];
      std::uint32_t& state = states[(i - begin) & (lanes - 1)];
      const std::uint32_t bits = (state + transform.DeltaBits) >> 16;
      written[i] = (state & ((1u << bits) - 1u)) << 4 | bits;
      total += bits;
      state = table.Next[static_cast<std::size_t>(
        static_cast<std::int32_t>(state >> bits) + transform.DeltaState)];
    }
  }
  BitWriter writer(total);
  writer.Put(static_cast<std::uint32_t>(lanesLog), 2);
  for (std::size_t lane = 0; lane < lanes; ++lane)
  {
    writer.Put(states[lane] - tans::TableSize, tans::TableBits);
  }
  std::size_t nextExtra = 0;
  for (const std::uint16_t run : runs)
  {
    const std::size_t end = begin + run;
    std::size_t i = begin;
    for (; i + 4 <= end; i += 4) // at most 40 bits
    {
      writer.Add(written[i] >> 4, written[i] & 15u);
      writer.Add(written[i + 1] >> 4, written[i + 1] & 15u);
      writer.Add(written[i + 2] >> 4, written[i + 2] & 15u);
      writer.Add(written[i + 3] >> 4, written[i + 3] & 15u);
      writer.Flush();
    }
    for (; i < end; ++i)
    {
      writer.Put(written[i] >> 4, written[i] & 15u);
    }
    for (i = begin; i < end && nextExtra < extra.size(); ++i)
    {
      const int symbol = tokens[i] & residual::TokenMask;
      if (symbol >= residual::DirectSymbols)
      {
        writer.Put(extra[nextExtra++], static_cast<std::uint32_t>(residual::ExtraBits(symbol)));
      }
    }
    begin = end;
  }
  return writer.Finish();
}

namespace
{

/// Stands for the number of symbols where a context has the table of another one.
constexpr std::uint8_t SharedTable = tans::SymbolCount + 1;

bool Same(const tans::Frequencies& a, const tans::Frequencies& b)
{
  return std::equal(std::begin(a.Count), std::end(a.Count), std::begin(b.Count));
}

/// How many contexts before there is one with the same frequencies; 0: none, or none of them comes.
std::size_t SharedWith(const std::vector<tans::Frequencies>& frequencies, std::size_t context)
{
  if (Same(frequencies[context], tans::Frequencies{}))
  {
    return 0;
  }
  for (std::size_t before = 1; before <= std::min<std::size_t>(context, 255); ++before)
  {
    if (Same(frequencies[context], frequencies[context - before]))
    {
      return before;
    }
  }
  return 0;
}

} // namespace

std::vector<std::uint8_t> PackFrequencies(const std::vector<tans::Frequencies>& frequencies)
{
  // Per context: number of symbols up to the last that comes, then their frequencies, 7 bits per
  // byte. The bytes are compressed with the table that they are part of.
  std::vector<std::uint8_t> bytes;
  for (std::size_t c = 0; c < frequencies.size(); ++c)
  {
    const tans::Frequencies& context = frequencies[c];
    const std::size_t shared = SharedWith(frequencies, c);
    if (shared > 0)
    {
      bytes.push_back(SharedTable);
      bytes.push_back(static_cast<std::uint8_t>(shared));
      continue;
    }
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
  for (std::size_t c = 0; c < result.size(); ++c)
  {
    tans::Frequencies& context = result[c];
    const unsigned count = next();
    if (count == SharedTable)
    {
      const std::size_t before = next();
      if (before == 0 || before > c)
      {
        throw Error("A table of symbols is that of a context which does not come before");
      }
      context = result[c - before];
      continue;
    }
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

DecodeTables DecodeTablesOf(const std::vector<tans::Frequencies>& frequencies)
{
  DecodeTables tables;
  tans::DecodeEntry entries[tans::TableSize];
  const auto add = [&](std::size_t first, int classes)
  {
    DecodeTables::Band band;
    band.First = tables.Entries.size();
    int count = 0;
    for (int c = 0; c < classes; ++c)
    {
      const tans::Frequencies& context = frequencies[first + static_cast<std::size_t>(c)];
      int same = 0;
      while (same < c && !Same(context, frequencies[first + static_cast<std::size_t>(same)]))
      {
        ++same;
      }
      band.Tables[c] = same < c ? band.Tables[same] : static_cast<std::uint8_t>(count++);
      if (same == c)
      {
        tans::BuildDecodeTable(context, entries);
        for (const tans::DecodeEntry& entry : entries)
        {
          tables.Entries.push_back(residual::Packed(entry));
        }
      }
    }
    tables.Bands.push_back(band);
  };
  for (std::size_t band = 0; band < residual::Bands; ++band)
  {
    add(band * residual::Classes, residual::Classes);
  }
  for (std::size_t band = 0; band < residual::Bands; ++band)
  {
    add(residual::FlagContext + band * residual::RowClasses, residual::RowClasses);
  }
  tables.Entries.shrink_to_fit();
  return tables;
}

} // namespace banyan
