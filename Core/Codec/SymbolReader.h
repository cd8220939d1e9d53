// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_SymbolReader_h
#define banyan_Codec_SymbolReader_h

#include "Codec/DecodeTables.h"

#include <hwy/base.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace banyan
{

/// Reads the symbols of one payload, run by run (ReadRun in SymbolRun-inl.h). Any bytes are safe:
/// reading past the end gives zeros, and `AtEnd` says so.
///
/// Layout of a payload: 2 bits, the logarithm of the number of lanes; the first states of the lanes
/// (tans::TableBits bits each); then for each run the bits that the tables of its symbols ask for,
/// and then the extra bits of those of its symbols that have some. Lanes take turns within a run,
/// which starts with the first lane. Lowest bit of a byte first.
class SymbolReader
{
public:
  /// @param tables must live as long as symbols are read
  /// @param most bytes that will be read at most
  void Open(
    const DecodeTables& tables, const std::uint8_t* data, std::size_t bytes, std::size_t most)
  {
    bytes = std::min(bytes, most);
    if (this->Buffer.size() < bytes + Slack)
    {
      this->Buffer.resize(bytes + Slack);
    }
    std::copy_n(data, bytes, this->Buffer.data()); // of no bytes data may be null
    std::memset(this->Buffer.data() + bytes, 0, Slack);
    this->End = bytes * 8;
    this->Overrun = false;
    this->Tables = &tables;
    this->Position = 0;
    this->LanesLog = static_cast<int>(this->Take(2));
    std::fill(this->States, this->States + tans::MostLanes, std::uint64_t{ 0 });
    for (int lane = 0; lane < 1 << this->LanesLog; ++lane)
    {
      this->States[lane] = this->Take(tans::TableBits);
    }
  }

  /// Residual of a symbol with extra bits.
  /// @param bits how many
  std::int32_t Long(std::uint32_t bits)
  {
    return residual::Unzigzag(
      residual::CodeOf(residual::DirectSymbols + static_cast<int>(bits), this->Take(bits)));
  }

  /// Whether all was read and the lanes are back where encoding began: anything else is damage.
  bool AtEnd() const
  {
    std::uint64_t states = 0;
    for (const std::uint64_t state : this->States)
    {
      states |= state;
    }
    return !this->Overrun && this->End - this->Position < 8 && states == 0;
  }

  /// State that ReadRun moves.
  std::uint64_t Position = 0;
  std::uint64_t States[tans::MostLanes] = {};
  int LanesLog = 0;

  const DecodeTables::Band& BandOf(int band) const
  {
    return this->Tables->Bands[static_cast<std::size_t>(band)];
  }
  const std::uint32_t* TablesOf(int band) const
  {
    return this->Tables->Entries.data() + this->BandOf(band).First;
  }

  /// So many symbols may be read before the position is checked: they leave the payload, but not
  /// the zeros behind it.
  static constexpr int MostUnchecked = 256;

  /// The bits from a position on, 57 at least. Positions lie at most MostUnchecked symbols behind
  /// the end, where all bits are zero.
  HWY_INLINE std::uint64_t Word(std::uint64_t position) const
  {
    std::uint64_t word;
    std::memcpy(&word, this->Buffer.data() + (position >> 3), 8);
    return word >> (position & 7);
  }

  /// Eight bytes from one on; as far behind the end as Word may lie, and eight bytes more.
  HWY_INLINE std::uint64_t Byte(std::uint64_t byte) const
  {
    std::uint64_t word;
    std::memcpy(&word, this->Buffer.data() + byte, 8);
    return word;
  }

  /// To be called when the position was moved.
  HWY_INLINE void Check()
  {
    if (HWY_UNLIKELY(this->Position > this->End))
    {
      this->Position = this->End; // zeros from here on
      this->Overrun = true;
    }
  }

private:
  /// Zeros behind the payload: what symbols may take, and two words.
  static constexpr std::size_t Slack = MostUnchecked * tans::TableBits / 8 + 24;

  HWY_INLINE std::uint32_t Take(std::uint32_t bits)
  {
    const std::uint64_t value = this->Word(this->Position) & ((std::uint64_t{ 1 } << bits) - 1);
    this->Position += bits;
    this->Check();
    return static_cast<std::uint32_t>(value);
  }

  std::vector<std::uint8_t> Buffer;
  const DecodeTables* Tables = nullptr;
  std::uint64_t End = 0;
  bool Overrun = false;
};

} // namespace banyan

#endif
