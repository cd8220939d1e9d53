#include "Parallel/PixelPacking.h"

#include "Base/Error.h"

#include <algorithm>
#include <cstring>

namespace banyan
{
namespace
{

constexpr std::size_t Group = 8;
constexpr std::size_t Slack = 8; ///< whole words are written where only some bytes count

/// Transposes 8 x 8 bits: byte k of the result holds bit k of each of the 8 bytes. Its own inverse.
/// (Warren, Hacker's Delight, section 7-3.)
std::uint64_t Transposed(std::uint64_t x)
{
  std::uint64_t t = (x ^ (x >> 7)) & 0x00AA00AA00AA00AAu;
  x ^= t ^ (t << 7);
  t = (x ^ (x >> 14)) & 0x0000CCCC0000CCCCu;
  x ^= t ^ (t << 14);
  t = (x ^ (x >> 28)) & 0x00000000F0F0F0F0u;
  return x ^ t ^ (t << 28);
}

/// The low and the high bytes of eight numbers, the first one lowest.
struct Halves
{
  std::uint64_t Low = 0;
  std::uint64_t High = 0;
};

/// Of channel c of the group: numbers[4 * i + c].
Halves HalvesOf(const std::uint16_t* numbers)
{
  Halves halves;
  for (std::size_t i = 0; i < Group; ++i)
  {
    halves.Low |= static_cast<std::uint64_t>(numbers[4 * i] & 0xFFu) << (8 * i);
    halves.High |= static_cast<std::uint64_t>(numbers[4 * i] >> 8) << (8 * i);
  }
  return halves;
}

std::uint8_t* WriteBits(std::uint8_t* to, const std::uint16_t* numbers, unsigned bits)
{
  const Halves halves = HalvesOf(numbers);
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

/// @param safe whether 16 bytes can be read from `from`
const std::uint8_t* ReadBits(
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
  for (std::size_t i = 0; i < Group; ++i)
  {
    const auto value = ((low >> (8 * i)) & 0xFFu) | (((high >> (8 * i)) & 0xFFu) << 8);
    numbers[4 * i] = static_cast<std::uint16_t>(value);
  }
  return from + bits;
}

unsigned BitsOf(unsigned number)
{
  return number == 0 ? 0u : 32u - static_cast<unsigned>(__builtin_clz(number));
}

/// The code of 4 bits, and the bits that it stands for.
unsigned CodeOf(unsigned bits)
{
  return std::min(bits, 15u);
}
unsigned BitsOfCode(unsigned code)
{
  return code == 15u ? 16u : code;
}

void Fail(std::size_t found, std::size_t allowed)
{
  ErrorPlace place;
  place.Found = found;
  place.Allowed = allowed;
  throw Error("Pixels that another rank has sent end too early or too late.", place);
}

/// Copies a group that is not full, its last pixel repeated.
void CopyLastGroup(const std::uint16_t* numbers, std::size_t count, std::uint16_t* group)
{
  for (std::size_t i = 0; i < Group; ++i)
  {
    std::memcpy(group + 4 * i, numbers + 4 * std::min(i, count - 1), 4 * sizeof(std::uint16_t));
  }
}

std::uint8_t* PackGroup(const std::uint16_t* group, std::uint16_t* before, std::uint8_t* to)
{
  std::uint16_t zigzag[4 * Group];
  std::uint16_t any[4] = {};
  for (std::size_t i = 0; i < 4 * Group; ++i)
  {
    const std::uint16_t previous = i < 4 ? before[i] : group[i - 4];
    const auto difference = static_cast<std::int16_t>(group[i] - previous);
    zigzag[i] = static_cast<std::uint16_t>(
      (static_cast<std::uint16_t>(difference) << 1) ^ static_cast<std::uint16_t>(difference >> 15));
  }
  for (std::size_t i = 0; i < 4 * Group; ++i)
  {
    any[i % 4] = static_cast<std::uint16_t>(any[i % 4] | zigzag[i]);
  }
  std::memcpy(before, group + 4 * (Group - 1), 4 * sizeof(std::uint16_t));
  unsigned header = 0;
  for (unsigned c = 0; c < 4; ++c)
  {
    header |= CodeOf(BitsOf(any[c])) << (4 * c);
  }
  to[0] = static_cast<std::uint8_t>(header & 0xFFu);
  to[1] = static_cast<std::uint8_t>(header >> 8);
  to += 2;
  for (unsigned c = 0; c < 4; ++c)
  {
    const unsigned bits = BitsOfCode((header >> (4 * c)) & 15u);
    to = bits > 0 ? WriteBits(to, zigzag + c, bits) : to;
  }
  return to;
}

void UndoDifferences(const std::uint16_t* zigzag, std::uint16_t* before, std::uint16_t* group)
{
  for (std::size_t i = 0; i < 4 * Group; ++i)
  {
    const unsigned z = zigzag[i];
    const unsigned difference = (z >> 1) ^ (0u - (z & 1u));
    before[i % 4] = static_cast<std::uint16_t>(before[i % 4] + difference);
    group[i] = before[i % 4];
  }
}

} // namespace

std::size_t PackedBytesAtMost(std::size_t count)
{
  const std::size_t groups = (count + Group - 1) / Group;
  return groups * (2 + 4 * 16) + 4 + 2 * Slack;
}

std::size_t PackPixels(const std::uint16_t* numbers, std::size_t count, std::uint8_t* packed)
{
  std::uint8_t* to = packed;
  std::uint16_t before[4] = {};
  for (std::size_t first = 0; first < count; first += Group)
  {
    std::uint16_t padded[4 * Group];
    const std::uint16_t* group = numbers + 4 * first;
    if (count - first < Group)
    {
      CopyLastGroup(group, count - first, padded);
      group = padded;
    }
    to = PackGroup(group, before, to);
  }
  return static_cast<std::size_t>(to - packed);
}

void UnpackPixels(
  const std::uint8_t* packed, std::size_t bytes, std::size_t count, std::uint16_t* numbers)
{
  const std::uint8_t* from = packed;
  const std::uint8_t* end = packed + bytes;
  std::uint16_t before[4] = {};
  for (std::size_t first = 0; first < count; first += Group)
  {
    if (end - from < 2)
    {
      Fail(bytes, bytes + 2);
    }
    const unsigned header = from[0] | static_cast<unsigned>(from[1]) << 8;
    from += 2;
    std::uint16_t zigzag[4 * Group] = {};
    for (unsigned c = 0; c < 4; ++c)
    {
      const unsigned bits = BitsOfCode((header >> (4 * c)) & 15u);
      const std::ptrdiff_t left = end - from;
      if (left < static_cast<std::ptrdiff_t>(bits))
      {
        Fail(bytes, bytes + bits);
      }
      from = bits > 0 ? ReadBits(from, bits, left >= 16, zigzag + c) : from;
    }
    std::uint16_t padded[4 * Group];
    const std::size_t here = std::min(Group, count - first);
    UndoDifferences(zigzag, before, here == Group ? numbers + 4 * first : padded);
    if (here < Group)
    {
      std::memcpy(numbers + 4 * first, padded, 4 * here * sizeof(std::uint16_t));
    }
  }
  if (from != end)
  {
    Fail(bytes, static_cast<std::size_t>(from - packed));
  }
}

std::size_t WritePlain(const std::uint16_t* numbers, std::size_t count, std::uint8_t* written)
{
  std::uint16_t any[4] = {};
  for (std::size_t i = 0; i < 4 * count; ++i)
  {
    any[i % 4] = static_cast<std::uint16_t>(any[i % 4] | numbers[i]);
  }
  std::uint8_t* to = written;
  for (unsigned c = 0; c < 4; ++c)
  {
    *to++ = static_cast<std::uint8_t>(BitsOf(any[c]));
  }
  for (std::size_t first = 0; first < count; first += Group)
  {
    std::uint16_t padded[4 * Group];
    const std::uint16_t* group = numbers + 4 * first;
    if (count - first < Group)
    {
      CopyLastGroup(group, count - first, padded);
      group = padded;
    }
    for (unsigned c = 0; c < 4; ++c)
    {
      to = written[c] > 0 ? WriteBits(to, group + c, written[c]) : to;
    }
  }
  return static_cast<std::size_t>(to - written);
}

void ReadPlain(
  const std::uint8_t* written, std::size_t bytes, std::size_t count, std::uint16_t* numbers)
{
  const std::size_t groups = (count + Group - 1) / Group;
  std::size_t expected = 4;
  for (unsigned c = 0; c < 4 && bytes >= 4; ++c)
  {
    expected += written[c] <= 16 ? groups * written[c] : bytes;
  }
  if (bytes != expected)
  {
    Fail(bytes, expected);
  }
  const std::uint8_t* from = written + 4;
  const std::uint8_t* end = written + bytes;
  for (std::size_t first = 0; first < count; first += Group)
  {
    std::uint16_t group[4 * Group] = {};
    for (unsigned c = 0; c < 4; ++c)
    {
      from = written[c] > 0 ? ReadBits(from, written[c], end - from >= 16, group + c) : from;
    }
    std::memcpy(
      numbers + 4 * first, group, 4 * std::min(Group, count - first) * sizeof(std::uint16_t));
  }
}

} // namespace banyan
