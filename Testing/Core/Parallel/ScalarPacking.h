#ifndef banyan_Testing_ScalarPacking_h
#define banyan_Testing_ScalarPacking_h

#include <algorithm>
#include <cstdint>
#include <vector>

// The packing of pixels as PixelPacking.h says it, bit by bit.
namespace banyan::testing
{

inline std::vector<std::uint8_t> PackedSlowly(const std::vector<std::uint16_t>& numbers)
{
  const std::size_t count = numbers.size() / 4;
  const auto numberOf = [&](std::size_t pixel, std::size_t channel)
  { return numbers[4 * std::min(pixel, count - 1) + channel]; };
  std::vector<std::uint8_t> packed;
  for (std::size_t first = 0; first < count; first += 8)
  {
    unsigned header = 0;
    std::vector<std::uint8_t> planes;
    for (std::size_t channel = 0; channel < 4; ++channel)
    {
      unsigned zigzag[8];
      unsigned bits = 0;
      for (std::size_t i = 0; i < 8; ++i)
      {
        const int before = first + i == 0 ? 0 : numberOf(first + i - 1, channel);
        const int difference = static_cast<std::int16_t>(numberOf(first + i, channel) - before);
        zigzag[i] = static_cast<unsigned>(difference < 0 ? -2 * difference - 1 : 2 * difference);
        while (zigzag[i] >> bits != 0)
        {
          ++bits;
        }
      }
      const unsigned code = std::min(bits, 15u);
      header |= code << (4 * channel);
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
    packed.push_back(static_cast<std::uint8_t>(header & 255u));
    packed.push_back(static_cast<std::uint8_t>(header >> 8));
    packed.insert(packed.end(), planes.begin(), planes.end());
  }
  return packed;
}

} // namespace banyan::testing

#endif
