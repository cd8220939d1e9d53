// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_ScalarPacking_h
#define banyan_Testing_ScalarPacking_h

#include <algorithm>
#include <cstdint>
#include <vector>

// The packing of pixels as PixelPacking.h says it, bit by bit.
namespace banyan::testing
{

/// What a group begins with.
inline std::vector<std::uint8_t> StepsSlowly(
  const std::vector<unsigned>& before, const std::vector<unsigned>& codes)
{
  const int possible[] = { 0, 1, -1, -2 };
  unsigned byte = 0;
  unsigned found = 0;
  for (unsigned channel = 0; channel < 4; ++channel)
  {
    for (unsigned step = 0; step < 4; ++step)
    {
      if (static_cast<int>(before[channel]) + possible[step] == static_cast<int>(codes[channel]))
      {
        byte += step << (2 * channel);
        ++found;
      }
    }
  }
  if (found == 4 && byte != 255)
  {
    return { static_cast<std::uint8_t>(byte) };
  }
  return { 255, static_cast<std::uint8_t>(codes[0] + 16 * codes[1]),
    static_cast<std::uint8_t>(codes[2] + 16 * codes[3]) };
}

/// @param factors what the packing has fitted, which may be anything
inline std::vector<std::uint8_t> PackedSlowly(
  const std::vector<std::uint16_t>& numbers, const std::vector<std::int8_t>& factors)
{
  const std::size_t count = numbers.size() / 4;
  const auto difference = [&](std::size_t pixel, std::size_t channel)
  {
    const int before = pixel == 0 || pixel >= count ? 0 : numbers[4 * (pixel - 1) + channel];
    return static_cast<std::int16_t>(pixel < count ? numbers[4 * pixel + channel] - before : 0);
  };
  const auto rest = [&](std::size_t pixel, std::size_t channel)
  {
    const int green = difference(pixel, 1);
    const int alpha = difference(pixel, 3);
    int expected = 0;
    switch (channel)
    {
      case 0:
        expected = (alpha * factors[1] + green * factors[2]) >> 5;
        break;
      case 1:
        expected = (alpha * factors[0]) >> 5;
        break;
      case 2:
        expected = (alpha * factors[3] + green * factors[4]) >> 5;
        break;
      default:
        break;
    }
    return static_cast<std::int16_t>(difference(pixel, channel) - expected);
  };
  std::vector<std::uint8_t> packed;
  for (const std::int8_t factor : factors)
  {
    packed.push_back(static_cast<std::uint8_t>(factor));
  }
  std::vector<unsigned> before(4, 0);
  for (std::size_t first = 0; first < count; first += 8)
  {
    std::vector<unsigned> codes;
    std::vector<std::uint8_t> planes;
    for (std::size_t channel = 0; channel < 4; ++channel)
    {
      unsigned zigzag[8];
      unsigned bits = 0;
      for (std::size_t i = 0; i < 8; ++i)
      {
        const int number = rest(first + i, channel);
        zigzag[i] = static_cast<unsigned>(number < 0 ? -2 * number - 1 : 2 * number);
        while (zigzag[i] >> bits != 0)
        {
          ++bits;
        }
      }
      const unsigned code = std::min(bits, 15u);
      codes.push_back(code);
      for (unsigned bit = 0; bit < (code == 15 ? 16 : code); ++bit)
      {
        unsigned plane = 0;
        for (std::size_t i = 0; i < 8; ++i)
        {
          plane |= (zigzag[i] >> bit & 1u) << i;
        }
        planes.push_back(static_cast<std::uint8_t>(plane));
      }
    }
    const auto steps = StepsSlowly(before, codes);
    packed.insert(packed.end(), steps.begin(), steps.end());
    before = codes;
    packed.insert(packed.end(), planes.begin(), planes.end());
  }
  return packed;
}

} // namespace banyan::testing

#endif
