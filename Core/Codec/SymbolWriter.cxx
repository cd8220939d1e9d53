// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/SymbolWriter.h"

#include "Base/Error.h"
#include "Codec/ContextClustering.h"
#include "Codec/ReverseBitWriter.h"

#include <algorithm>
#include <functional>

// Compiled for processors with quick shifts, too.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) &&                             \
  !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define BANYAN_CLONES __attribute__((target_clones("arch=haswell", "default")))
#else
#define BANYAN_CLONES
#endif

namespace banyan
{
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

void ContextCounts::ForgetClasses()
{
  const auto merge = [this](std::size_t first, std::size_t count)
  {
    std::array<std::uint32_t, tans::SymbolCount> sum = {};
    for (std::size_t c = first; c < first + count; ++c)
    {
      std::transform(sum.begin(), sum.end(), this->Of[c].begin(), sum.begin(), std::plus<>());
    }
    std::fill_n(this->Of.begin() + static_cast<std::ptrdiff_t>(first), count, sum);
  };
  for (std::size_t band = 0; band < residual::Bands; ++band)
  {
    merge(band * residual::Classes, residual::Classes);
    merge(residual::FlagContext + band * residual::RowClasses, residual::RowClasses);
  }
}

SymbolTables::SymbolTables(const ContextCounts& each, bool share)
  : Transforms(std::size_t{ residual::ContextCount } << residual::TokenShift)
{
  ContextCounts counts = each;
  if (share)
  {
    ClusterContexts(counts);
  }
  for (const auto& context : counts.Of)
  {
    this->Of.push_back(tans::Normalize(context.data()));
  }
  for (std::size_t c = 0; c < this->Of.size(); ++c)
  {
    this->AddTable(c);
  }
}

/// Makes the table of a context, or takes that of one before.
void SymbolTables::AddTable(std::size_t context)
{
  Transform* const to = this->Transforms.data() + (context << residual::TokenShift);
  const std::size_t shared = SharedWith(this->Of, context);
  if (shared > 0)
  {
    const Transform* const from = to - (shared << residual::TokenShift);
    std::copy(from, from + tans::SymbolCount, to);
    return;
  }
  if (Same(this->Of[context], tans::Frequencies{}))
  {
    return; // it never comes
  }
  const tans::EncodeTable encode(this->Of[context]);
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
    to[s].DeltaBits =
      most == 0 ? 0 : (static_cast<std::uint32_t>(most) << 16) - (frequency << most);
    to[s].DeltaState = static_cast<std::int32_t>(this->Next.size() + encode.First[s]) -
                       static_cast<std::int32_t>(frequency);
  }
  this->Next.insert(this->Next.end(), encode.Next.begin(), encode.Next.end());
}

/// More lanes decode faster, because a symbol waits for the one before in its lane; but each costs
/// its first state. They make the shortest payloads that have some 15 % larger, series at most 3 %.
int SymbolTables::LanesLogFor(const std::vector<std::uint16_t>& tokens) const
{
  const std::size_t every = tokens.size() < 1024 ? 1 : 8; // of many, some tell enough
  std::uint64_t bits = 0;
  for (std::size_t i = 0; i < tokens.size(); i += every)
  {
    bits += (tans::TableSize * 3 / 2 + this->Transforms[tokens[i]].DeltaBits) >> 16;
  }
  bits *= every;
  return bits < 60 ? 0 : bits < 250 ? 1 : bits < 8000 ? 2 : 3;
}

/// Writes a payload from its end to its beginning.
struct SymbolTables::Backwards
{
  const Transform* Transforms;
  const std::uint16_t* Next;
  ReverseBitWriter Bits;
  std::uint32_t States[tans::MostLanes];

  void Symbol(std::uint16_t token, std::uint32_t& state)
  {
    const Transform transform = this->Transforms[token];
    const std::uint32_t bits = (state + transform.DeltaBits) >> 16;
    this->Bits.Add(state & ((1u << bits) - 1u), bits);
    state = this->Next[static_cast<std::int32_t>(state >> bits) + transform.DeltaState];
  }

  /// The symbols of a run, which take turns with the states. Unrolled by hand: states are registers
  /// only where their numbers are constants.
  template <int Lanes>
  void Run(const std::uint16_t* tokens, std::size_t count)
  {
    for (; count % 8 != 0; --count)
    {
      this->Symbol(tokens[count - 1], this->States[(count - 1) % Lanes]);
      this->Bits.Flush();
    }
    for (; count > 0; count -= 8)
    {
      const std::uint16_t* const some = tokens + count - 8;
      this->Symbol(some[7], this->States[7 % Lanes]); // each takes at most 9 bits
      this->Symbol(some[6], this->States[6 % Lanes]);
      this->Symbol(some[5], this->States[5 % Lanes]);
      this->Symbol(some[4], this->States[4 % Lanes]);
      this->Bits.Flush();
      this->Symbol(some[3], this->States[3 % Lanes]);
      this->Symbol(some[2], this->States[2 % Lanes]);
      this->Symbol(some[1], this->States[1 % Lanes]);
      this->Symbol(some[0], this->States[0]);
      this->Bits.Flush();
    }
  }

  /// The bits that follow the symbols of a run.
  /// @param extra behind the last of them
  /// @return its first
  const std::uint32_t* Extra(
    const std::uint16_t* tokens, std::size_t count, const std::uint32_t* extra)
  {
    int any = 0;
    for (std::size_t i = 0; i < count; ++i)
    {
      any |= static_cast<int>((tokens[i] & residual::TokenMask) >= residual::DirectSymbols);
    }
    for (std::size_t i = any != 0 ? count : 0; i-- > 0;)
    {
      const int symbol = tokens[i] & residual::TokenMask;
      if (symbol >= residual::DirectSymbols)
      {
        this->Bits.Put(*--extra, static_cast<std::uint32_t>(residual::ExtraBits(symbol)));
      }
    }
    return extra;
  }
};

template <int Lanes>
BANYAN_CLONES void SymbolTables::Write(Backwards& to, const std::vector<std::uint16_t>& tokens,
  const std::vector<std::uint32_t>& extra, const std::vector<std::uint16_t>& runs)
{
  Backwards writer = to; // registers
  const std::uint16_t* end = tokens.data() + tokens.size();
  const std::uint32_t* lastExtra = extra.data() + extra.size();
  for (std::size_t run = runs.size(); run-- > 0;)
  {
    end -= runs[run];
    if (lastExtra != extra.data())
    {
      lastExtra = writer.Extra(end, runs[run], lastExtra);
    }
    writer.template Run<Lanes>(end, runs[run]);
  }
  to = writer;
}

std::vector<std::uint8_t> SymbolTables::Encode(const std::vector<std::uint16_t>& tokens,
  const std::vector<std::uint32_t>& extra, const std::vector<std::uint16_t>& runs) const
{
  const int lanesLog = this->LanesLogFor(tokens);
  const std::size_t lanes = std::size_t{ 1 } << lanesLog;
  Backwards writer{ this->Transforms.data(), this->Next.data(),
    ReverseBitWriter(2 + tans::TableBits * (lanes + tokens.size()) + 32 * extra.size()), {} };
  std::fill(writer.States, writer.States + lanes, static_cast<std::uint32_t>(tans::TableSize));
  const auto write = lanesLog == 0   ? &SymbolTables::Write<1>
                     : lanesLog == 1 ? &SymbolTables::Write<2>
                     : lanesLog == 2 ? &SymbolTables::Write<4>
                                     : &SymbolTables::Write<8>;
  write(writer, tokens, extra, runs);
  for (std::size_t lane = lanes; lane-- > 0;)
  {
    writer.Bits.Put(writer.States[lane] - tans::TableSize, tans::TableBits);
  }
  writer.Bits.Put(static_cast<std::uint32_t>(lanesLog), 2);
  return writer.Bits.Finish();
}

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
  std::vector<const tans::Frequencies*> known; // those of the tables so far
  const auto tableOf = [&](const tans::Frequencies& context, std::size_t first)
  {
    const auto same = std::find_if(known.begin() + static_cast<std::ptrdiff_t>(first), known.end(),
      [&](const tans::Frequencies* other) { return Same(context, *other); });
    if (same == known.end())
    {
      tans::DecodeEntry entries[tans::TableSize];
      tans::BuildDecodeTable(context, entries);
      std::transform(std::begin(entries), std::end(entries), std::back_inserter(tables.Entries),
        residual::Packed);
      known.push_back(&context);
      return known.size() - 1;
    }
    return static_cast<std::size_t>(same - known.begin());
  };
  const auto add = [&](std::size_t context, std::size_t classes)
  {
    // Tables that lie too far behind are made again: places of symbols have 16 bits.
    const std::size_t end = known.size() + classes;
    const std::size_t first = end - std::min(end, DecodeTables::MostOfBand);
    DecodeTables::Band band;
    band.First = first * tans::TableSize;
    for (std::size_t c = 0; c < classes; ++c)
    {
      band.Tables[c] = static_cast<std::uint8_t>(tableOf(frequencies[context + c], first) - first);
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
