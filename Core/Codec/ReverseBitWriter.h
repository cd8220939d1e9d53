// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_ReverseBitWriter_h
#define banyan_Codec_ReverseBitWriter_h

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <vector>

namespace banyan
{

/// Collects bits from the last to the first: states take symbols in the order opposite to the one
/// in which they are read. A thread has one at a time, as all use one piece of its memory.
class ReverseBitWriter
{
public:
  /// @param bits that will be put at most
  explicit ReverseBitWriter(std::size_t bits)
  {
    thread_local std::vector<std::uint8_t> memory;
    const std::size_t bytes = bits / 8 + 32;
    if (memory.size() < bytes)
    {
      memory.resize(2 * bytes);
    }
    this->End = memory.data() + memory.size() - 8;
    this->At = this->End;
  }

  /// Puts the lowest bits of a value, the others being 0, before those that are there. At most 56
  /// between two calls of Flush.
  void Add(std::uint64_t value, std::uint32_t bits)
  {
    this->Word = this->Word << bits | value;
    this->Filled += bits;
  }

  void Flush()
  {
    const std::uint64_t word = this->Word << 1 << (63 - this->Filled);
    std::memcpy(this->At - 8, &word, 8);
    this->At -= this->Filled >> 3;
    this->Filled &= 7;
  }

  void Put(std::uint64_t value, std::uint32_t bits)
  {
    this->Add(value, bits);
    this->Flush();
  }

  /// All bits, as bytes of which the lowest bit comes first. To be called after Flush.
  std::vector<std::uint8_t> Finish() const
  {
    // Bits that make no whole byte are the highest of the one before: all move down by the rest of
    // it.
    const std::uint32_t down = (8 - this->Filled) & 7;
    const std::uint8_t* from = this->At - (this->Filled > 0 ? 1 : 0);
    const std::size_t bits = 8 * static_cast<std::size_t>(this->End - this->At) + this->Filled;
    std::vector<std::uint8_t> bytes((bits + 7) / 8);
    std::memset(this->End, 0, 8);
    std::size_t i = 0;
    for (; i + 8 <= bytes.size(); i += 7)
    {
      std::uint64_t word;
      std::memcpy(&word, from + i, 8);
      word >>= down;
      std::memcpy(bytes.data() + i, &word, 8); // of the eighth byte some bits may be missing
    }
    for (; i < bytes.size(); ++i)
    {
      bytes[i] = static_cast<std::uint8_t>((from[i] | from[i + 1] << 8) >> down);
    }
    return bytes;
  }

private:
  std::uint8_t* End;
  std::uint8_t* At; ///< where the whole bytes begin
  std::uint64_t Word = 0;
  std::uint32_t Filled = 0; ///< bits of the word that are no whole bytes in memory, its lowest
};

} // namespace banyan

#endif
