#include "Parallel/PixelPacking.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

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

std::uint8_t* PackGroup(const std::int16_t* differences, std::uint8_t* to)
{
  std::uint16_t zigzag[4 * Group];
  std::uint16_t any[4] = {};
  for (std::size_t i = 0; i < 4 * Group; ++i)
  {
    const std::int16_t difference = differences[i];
    zigzag[i] = static_cast<std::uint16_t>(
      (static_cast<std::uint16_t>(difference) << 1) ^ static_cast<std::uint16_t>(difference >> 15));
  }
  for (std::size_t i = 0; i < 4 * Group; ++i)
  {
    any[i % 4] = static_cast<std::uint16_t>(any[i % 4] | zigzag[i]);
  }
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

/// What differences of some channels say about those of others, in parts of 32.
struct Factors
{
  static constexpr std::size_t Bytes = 5;
  std::int8_t GreenOfAlpha = 0;
  std::int8_t RedOfAlpha = 0;
  std::int8_t RedOfGreen = 0;
  std::int8_t BlueOfAlpha = 0;
  std::int8_t BlueOfGreen = 0;
};

std::int8_t InParts(double factor)
{
  return static_cast<std::int8_t>(std::clamp(std::floor(32.0 * factor + 0.5), -127.0, 127.0));
}

/// Least squares, from a part of the pixels: with too few or with flat ones all are 0.
Factors Fitted(const std::int16_t* differences, std::size_t count)
{
  // Every fourth group: how well they fit matters, not which they are.
  float sums[9] = {};
  for (std::size_t first = 0; first < count; first += 4 * Group)
  {
    const std::size_t last = std::min(first + Group, count);
    for (std::size_t i = first; i < last; ++i)
    {
      const std::int16_t* d = differences + 4 * i;
      const float r = d[0], g = d[1], b = d[2], a = d[3];
      const float products[9] = { a * a, a * g, g * g, r * a, r * g, b * a, b * g, r * r, b * b };
      for (int k = 0; k < 9; ++k)
      {
        sums[k] += products[k];
      }
    }
  }
  const double aa = sums[0], ag = sums[1], gg = sums[2];
  Factors factors;
  factors.GreenOfAlpha = InParts(aa > 0.0 ? ag / aa : 0.0);
  const double determinant = aa * gg - ag * ag;
  // Green that follows alpha says nothing that alpha does not.
  const bool both = determinant > 1e-3 * aa * gg;
  const auto fit = [&](double ca, double cg, std::int8_t& ofAlpha, std::int8_t& ofGreen)
  {
    ofAlpha = InParts(both ? (ca * gg - cg * ag) / determinant : (aa > 0.0 ? ca / aa : 0.0));
    ofGreen = InParts(
      both ? (cg * aa - ca * ag) / determinant : (aa > 0.0 ? 0.0 : (gg > 0.0 ? cg / gg : 0.0)));
  };
  fit(sums[3], sums[4], factors.RedOfAlpha, factors.RedOfGreen);
  fit(sums[5], sums[6], factors.BlueOfAlpha, factors.BlueOfGreen);
  return factors;
}

int Share(int alpha, int ofAlpha, int green, int ofGreen)
{
  return (alpha * ofAlpha + green * ofGreen) >> 5;
}

void SubtractShares(const Factors& factors, std::int16_t* differences, std::size_t count)
{
  for (std::size_t i = 0; i < count; ++i)
  {
    std::int16_t* d = differences + 4 * i;
    const int green = d[1];
    const int alpha = d[3];
    d[0] =
      static_cast<std::int16_t>(d[0] - Share(alpha, factors.RedOfAlpha, green, factors.RedOfGreen));
    d[2] = static_cast<std::int16_t>(
      d[2] - Share(alpha, factors.BlueOfAlpha, green, factors.BlueOfGreen));
    d[1] = static_cast<std::int16_t>(green - Share(alpha, factors.GreenOfAlpha, 0, 0));
  }
}

/// Numbers of a group from what PackGroup has written down of them.
void UndoDifferences(
  const Factors& factors, const std::uint16_t* zigzag, std::uint16_t* before, std::uint16_t* group)
{
  std::int16_t d[4 * Group];
  for (std::size_t i = 0; i < 4 * Group; ++i)
  {
    const unsigned z = zigzag[i];
    d[i] = static_cast<std::int16_t>((z >> 1) ^ (0u - (z & 1u)));
  }
  for (std::size_t i = 0; i < 4 * Group; i += 4)
  {
    const int alpha = d[i + 3];
    const auto green =
      static_cast<std::int16_t>(d[i + 1] + Share(alpha, factors.GreenOfAlpha, 0, 0));
    d[i] =
      static_cast<std::int16_t>(d[i] + Share(alpha, factors.RedOfAlpha, green, factors.RedOfGreen));
    d[i + 2] = static_cast<std::int16_t>(
      d[i + 2] + Share(alpha, factors.BlueOfAlpha, green, factors.BlueOfGreen));
    d[i + 1] = green;
  }
  for (std::size_t i = 0; i < 4 * Group; ++i)
  {
    before[i % 4] = static_cast<std::uint16_t>(before[i % 4] + d[i]);
    group[i] = before[i % 4];
  }
}

} // namespace

std::size_t PackedBytesAtMost(std::size_t count)
{
  const std::size_t groups = (count + Group - 1) / Group;
  return groups * (2 + 4 * 16) + Factors::Bytes + 2 * Slack;
}

std::size_t PackPixels(const std::uint16_t* numbers, std::size_t count, std::uint8_t* packed)
{
  // Whole groups: what is missing has differences 0.
  std::vector<std::int16_t> differences((count + Group - 1) / Group * 4 * Group, 0);
  for (std::size_t i = 0; i < 4 * count; ++i)
  {
    differences[i] = static_cast<std::int16_t>(numbers[i] - (i < 4 ? 0 : numbers[i - 4]));
  }
  const Factors factors = Fitted(differences.data(), count);
  SubtractShares(factors, differences.data(), count);
  std::memcpy(packed, &factors, Factors::Bytes);
  std::uint8_t* to = packed + Factors::Bytes;
  for (std::size_t first = 0; first < count; first += Group)
  {
    to = PackGroup(differences.data() + 4 * first, to);
  }
  return static_cast<std::size_t>(to - packed);
}

void UnpackPixels(
  const std::uint8_t* packed, std::size_t bytes, std::size_t count, std::uint16_t* numbers)
{
  if (bytes < Factors::Bytes)
  {
    Fail(bytes, Factors::Bytes);
  }
  Factors factors;
  std::memcpy(&factors, packed, Factors::Bytes);
  const std::uint8_t* from = packed + Factors::Bytes;
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
    UndoDifferences(factors, zigzag, before, here == Group ? numbers + 4 * first : padded);
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
