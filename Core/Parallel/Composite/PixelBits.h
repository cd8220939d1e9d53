// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_PixelBits_h
#define banyan_Parallel_Composite_PixelBits_h

#include <cstddef>
#include <cstdint>
#include <cstring>

namespace banyan
{

/// Pixels whose numbers are packed together.
constexpr std::size_t PixelGroup = 8;

/// Transposes 8 x 8 bits: byte k of the result holds bit k of each of the 8 bytes. Its own inverse.
/// (Warren, Hacker's Delight, section 7-3.)
inline std::uint64_t Transposed(std::uint64_t x)
{
  std::uint64_t t = (x ^ (x >> 7)) & 0x00AA00AA00AA00AAu;
  x ^= t ^ (t << 7);
  t = (x ^ (x >> 14)) & 0x0000CCCC0000CCCCu;
  x ^= t ^ (t << 14);
  t = (x ^ (x >> 28)) & 0x00000000F0F0F0F0u;
  return x ^ t ^ (t << 28);
}

/// The low and the high bytes of eight numbers, the first one lowest.
struct ByteHalves
{
  std::uint64_t Low = 0;
  std::uint64_t High = 0;
};

/// Reads one channel c of the group: numbers[4 * i + c].
inline ByteHalves HalvesOf(const std::uint16_t* numbers)
{
  ByteHalves halves;
  for (std::size_t i = 0; i < PixelGroup; ++i)
  {
    halves.Low |= static_cast<std::uint64_t>(numbers[4 * i] & 0xFFu) << (8 * i);
    halves.High |= static_cast<std::uint64_t>(numbers[4 * i] >> 8) << (8 * i);
  }
  return halves;
}

/// The lowest bits of eight numbers, those of channel c of a group, a byte for each bit: the lowest
/// one first, first number lowest. Writes 8 or 16 bytes, of which `bits` count.
/// @return behind those
inline std::uint8_t* WriteBits(std::uint8_t* to, const std::uint16_t* numbers, unsigned bits)
{
  const ByteHalves halves = HalvesOf(numbers);
  const std::uint64_t low = Transposed(halves.Low);
  std::memcpy(to, &low, 8);
  if (bits <= 8)
  {
    return to + bits;
  }
  const std::uint64_t high = Transposed(halves.High);
  std::memcpy(to + 8, &high, 8);
  return to + bits;
}

/// The inverse.
/// @param safe whether 16 bytes can be read from `from`
inline const std::uint8_t* ReadBits(
  const std::uint8_t* from, unsigned bits, bool safe, std::uint16_t* numbers)
{
  std::uint8_t copy[16] = {};
  const std::uint8_t* source = from;
  if (!safe)
  {
    std::memcpy(copy, from, bits);
    source = copy;
  }
  std::uint64_t low = 0;
  std::uint64_t high = 0;
  std::memcpy(&low, source, 8);
  low = bits < 8 ? low & ((std::uint64_t{ 1 } << (8 * bits)) - 1) : low;
  low = Transposed(low);
  if (bits > 8)
  {
    std::memcpy(&high, source + 8, 8);
    high = bits < 16 ? high & ((std::uint64_t{ 1 } << (8 * (bits - 8))) - 1) : high;
    high = Transposed(high);
  }
  for (std::size_t i = 0; i < PixelGroup; ++i)
  {
    const auto value = ((low >> (8 * i)) & 0xFFu) | (((high >> (8 * i)) & 0xFFu) << 8);
    numbers[4 * i] = static_cast<std::uint16_t>(value);
  }
  return from + bits;
}

} // namespace banyan

#endif
