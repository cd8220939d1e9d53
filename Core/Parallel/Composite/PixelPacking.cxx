// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/PixelPacking.h"

#include "Base/Error.h"
#include "Parallel/Composite/PixelBits.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <vector>

namespace banyan
{
namespace
{

constexpr std::size_t Slack = 8; ///< whole words are written where only some bytes count

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

/// Says that the codes of a group follow as they are.
constexpr unsigned Anew = 255;

/// The codes of the four channels of a group, red lowest.
struct Codes
{
  unsigned Of[4] = {};

  /// How to get here from those of the group before, in a byte; Anew if it takes more.
  unsigned StepFrom(const Codes& before) const
  {
    unsigned steps = 0;
    for (unsigned c = 0; c < 4; ++c)
    {
      const int step = static_cast<int>(this->Of[c]) - static_cast<int>(before.Of[c]);
      if (step < -2 || step > 1)
      {
        return Anew;
      }
      steps |= (step >= 0 ? static_cast<unsigned>(step) : static_cast<unsigned>(1 - step))
               << (2 * c);
    }
    return steps;
  }

  /// @return false where one would leave the range of codes
  bool Step(unsigned steps)
  {
    constexpr int by[] = { 0, 1, -1, -2 };
    bool possible = true;
    for (unsigned c = 0; c < 4; ++c)
    {
      this->Of[c] += static_cast<unsigned>(by[(steps >> (2 * c)) & 3u]);
      possible = possible && this->Of[c] < 16u;
    }
    return possible;
  }
};

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
  for (std::size_t i = 0; i < PixelGroup; ++i)
  {
    std::memcpy(group + 4 * i, numbers + 4 * std::min(i, count - 1), 4 * sizeof(std::uint16_t));
  }
}

/// @param before codes of the group before; becomes those of this one
std::uint8_t* PackGroup(const std::int16_t* differences, Codes& before, std::uint8_t* to)
{
  std::uint16_t zigzag[4 * PixelGroup];
  std::uint16_t any[4] = {};
  for (std::size_t i = 0; i < 4 * PixelGroup; ++i)
  {
    const std::int16_t difference = differences[i];
    zigzag[i] = static_cast<std::uint16_t>(
      (static_cast<std::uint16_t>(difference) << 1) ^ static_cast<std::uint16_t>(difference >> 15));
  }
  for (std::size_t i = 0; i < 4 * PixelGroup; ++i)
  {
    any[i % 4] = static_cast<std::uint16_t>(any[i % 4] | zigzag[i]);
  }
  Codes codes;
  for (unsigned c = 0; c < 4; ++c)
  {
    codes.Of[c] = CodeOf(BitsOf(any[c]));
  }
  const unsigned steps = codes.StepFrom(before);
  *to++ = static_cast<std::uint8_t>(steps);
  if (steps == Anew)
  {
    *to++ = static_cast<std::uint8_t>(codes.Of[0] | codes.Of[1] << 4);
    *to++ = static_cast<std::uint8_t>(codes.Of[2] | codes.Of[3] << 4);
  }
  for (unsigned c = 0; c < 4; ++c)
  {
    const unsigned bits = BitsOfCode(codes.Of[c]);
    to = bits > 0 ? WriteBits(to, zigzag + c, bits) : to;
  }
  before = codes;
  return to;
}

/// Goes on behind the codes of a group.
/// @param codes of the group before, or 0; receives those of this one
/// @param bytes that there are in all, for what is said when they are too few
void ReadCodes(const std::uint8_t*& from, const std::uint8_t* end, std::size_t bytes, Codes& codes)
{
  const std::ptrdiff_t needed = from < end && *from == Anew ? 3 : 1;
  if (end - from < needed)
  {
    Fail(bytes, bytes + static_cast<std::size_t>(needed));
  }
  if (needed == 3)
  {
    for (unsigned c = 0; c < 4; ++c)
    {
      codes.Of[c] = (from[1 + c / 2] >> (4 * (c % 2))) & 15u;
    }
  }
  else if (!codes.Step(*from))
  {
    Fail(bytes, bytes);
  }
  from += needed;
}

/// Holds how the differences of a channel follow from those of others, in parts of 32.
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
  for (std::size_t first = 0; first < count; first += 4 * PixelGroup)
  {
    const std::size_t last = std::min(first + PixelGroup, count);
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
  std::int16_t d[4 * PixelGroup];
  for (std::size_t i = 0; i < 4 * PixelGroup; ++i)
  {
    const unsigned z = zigzag[i];
    d[i] = static_cast<std::int16_t>((z >> 1) ^ (0u - (z & 1u)));
  }
  for (std::size_t i = 0; i < 4 * PixelGroup; i += 4)
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
  for (std::size_t i = 0; i < 4 * PixelGroup; ++i)
  {
    before[i % 4] = static_cast<std::uint16_t>(before[i % 4] + d[i]);
    group[i] = before[i % 4];
  }
}

} // namespace

std::size_t PackedBytesAtMost(std::size_t count)
{
  const std::size_t groups = (count + PixelGroup - 1) / PixelGroup;
  return groups * (3 + 4 * 16) + Factors::Bytes + 2 * Slack;
}

std::size_t PackPixels(const std::uint16_t* numbers, std::size_t count, std::uint8_t* packed)
{
  // Whole groups: what is missing has differences 0.
  std::vector<std::int16_t> differences((count + PixelGroup - 1) / PixelGroup * 4 * PixelGroup, 0);
  for (std::size_t i = 0; i < 4 * count; ++i)
  {
    differences[i] = static_cast<std::int16_t>(numbers[i] - (i < 4 ? 0 : numbers[i - 4]));
  }
  const Factors factors = Fitted(differences.data(), count);
  SubtractShares(factors, differences.data(), count);
  std::memcpy(packed, &factors, Factors::Bytes);
  std::uint8_t* to = packed + Factors::Bytes;
  Codes codes;
  for (std::size_t first = 0; first < count; first += PixelGroup)
  {
    to = PackGroup(differences.data() + 4 * first, codes, to);
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
  Codes codes;
  for (std::size_t first = 0; first < count; first += PixelGroup)
  {
    ReadCodes(from, end, bytes, codes);
    std::uint16_t zigzag[4 * PixelGroup] = {};
    for (unsigned c = 0; c < 4; ++c)
    {
      const unsigned bits = BitsOfCode(codes.Of[c]);
      const std::ptrdiff_t left = end - from;
      if (left < static_cast<std::ptrdiff_t>(bits))
      {
        Fail(bytes, bytes + bits);
      }
      from = bits > 0 ? ReadBits(from, bits, left >= 16, zigzag + c) : from;
    }
    std::uint16_t padded[4 * PixelGroup];
    const std::size_t here = std::min(PixelGroup, count - first);
    UndoDifferences(factors, zigzag, before, here == PixelGroup ? numbers + 4 * first : padded);
    if (here < PixelGroup)
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
  for (std::size_t first = 0; first < count; first += PixelGroup)
  {
    std::uint16_t padded[4 * PixelGroup];
    const std::uint16_t* group = numbers + 4 * first;
    if (count - first < PixelGroup)
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
  const std::size_t groups = (count + PixelGroup - 1) / PixelGroup;
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
  for (std::size_t first = 0; first < count; first += PixelGroup)
  {
    std::uint16_t group[4 * PixelGroup] = {};
    for (unsigned c = 0; c < 4; ++c)
    {
      from = written[c] > 0 ? ReadBits(from, written[c], end - from >= 16, group + c) : from;
    }
    std::memcpy(
      numbers + 4 * first, group, 4 * std::min(PixelGroup, count - first) * sizeof(std::uint16_t));
  }
}

} // namespace banyan
