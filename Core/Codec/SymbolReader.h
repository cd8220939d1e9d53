#ifndef banyan_Codec_SymbolReader_h
#define banyan_Codec_SymbolReader_h

#include "Codec/Residual.h"

#include <hwy/base.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <vector>

namespace banyan
{

/// Reads the symbols of one payload. Any bytes are safe: reading past the end gives zeros, and
/// `AtEnd` says so.
///
/// Layout of a payload: the first states of the lanes (tans::TableBits bits each), then for each
/// symbol the bits that its table asks for and its extra bits; lowest bit of a byte first.
class SymbolReader
{
public:
  /// What moves while reading. Copy it out, read a row, and put it back: so it stays in registers.
  struct Cursor
  {
    const std::uint32_t* Tables;
    const std::uint8_t* Data;
    std::uint64_t Position;
    std::uint32_t First, Second, Third, Fourth; ///< states of the lanes, in turn

    std::uint32_t Take(std::uint32_t bits)
    {
      std::uint64_t word;
      std::memcpy(&word, this->Data + (this->Position >> 3), 8);
      const std::uint64_t value =
        (word >> (this->Position & 7)) & ((std::uint64_t{ 1 } << bits) - 1);
      this->Position += bits;
      return static_cast<std::uint32_t>(value);
    }

    /// Next entry in a context: see residual::Packed.
    std::uint32_t Next(const std::uint32_t* table)
    {
      const std::uint32_t entry = table[this->First];
      const std::uint32_t next = (entry & 1023u) + this->Take((entry >> 10) & 15u);
      this->First = this->Second;
      this->Second = this->Third;
      this->Third = this->Fourth;
      this->Fourth = next;
      return entry;
    }

    /// Residual of an entry with extra bits.
    std::int32_t Long(std::uint32_t entry)
    {
      const int bits = static_cast<int>(entry >> 24);
      return residual::Unzigzag(residual::CodeOf(
        residual::DirectSymbols + bits, this->Take(static_cast<std::uint32_t>(bits))));
    }
  };

  /// @param tables TableSize entries for each context
  /// @param most bytes that will be read at most
  void Open(const std::uint32_t* tables, const std::uint8_t* data, std::size_t bytes,
    std::size_t most)
  {
    bytes = std::min(bytes, most);
    if (this->Buffer.size() < bytes + Slack)
    {
      this->Buffer.resize(bytes + Slack);
    }
    std::memcpy(this->Buffer.data(), data, bytes);
    std::memset(this->Buffer.data() + bytes, 0, Slack);
    this->End = bytes * 8;
    this->Overrun = false;
    this->At = { tables, this->Buffer.data(), 0, 0, 0, 0, 0 };
    this->At.First = this->At.Take(tans::TableBits);
    this->At.Second = this->At.Take(tans::TableBits);
    this->At.Third = this->At.Take(tans::TableBits);
    this->At.Fourth = this->At.Take(tans::TableBits);
  }

  /// To read at most 65 symbols with.
  Cursor Here() const { return this->At; }

  void MoveTo(const Cursor& cursor)
  {
    this->At = cursor;
    if (HWY_UNLIKELY(this->At.Position > this->End))
    {
      this->At.Position = this->End; // zeros from here on
      this->Overrun = true;
    }
  }

  /// Whether all was read and the lanes are back where encoding began: anything else is damage.
  bool AtEnd() const
  {
    return !this->Overrun && this->End - this->At.Position < 8 &&
           (this->At.First | this->At.Second | this->At.Third | this->At.Fourth) == 0;
  }

private:
  /// No row takes more: 65 symbols of 10 bits, 31 extra bits each; and a word is read at a time.
  static constexpr std::size_t Slack = 65 * 41 / 8 + 16;

  std::vector<std::uint8_t> Buffer;
  std::uint64_t End = 0;
  bool Overrun = false;
  Cursor At = {};
};

} // namespace banyan

#endif
