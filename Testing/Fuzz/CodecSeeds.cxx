// SPDX-License-Identifier: BSD-3-Clause
#include "CodecSeeds.h"

#include <cstring>
#include <random>
#include <utility>

namespace banyan::fuzz
{
namespace
{

template <class T>
void Put(std::vector<std::uint8_t>& to, T value)
{
  const std::size_t at = to.size();
  to.resize(at + sizeof(T));
  std::memcpy(to.data() + at, &value, sizeof(T));
}

} // namespace

std::vector<std::vector<std::uint8_t>> BlockSeeds()
{
  std::vector<std::vector<std::uint8_t>> seeds;
  std::mt19937 random(1);
  for (const unsigned edge : { 0u, 3u }) // 16 and 32
  {
    for (const unsigned tables : { 1u, 25u }) // the second with a lattice of 16 bits
    {
      std::vector<std::uint8_t> input{ static_cast<std::uint8_t>(edge | tables << 3) };
      Put(input, std::int32_t{ 31 });
      Put(input, std::int32_t{ 15 });
      Put(input, std::int32_t{ -4000 });
      Put(input, std::int32_t{ 3999 });
      Put(input, static_cast<std::uint32_t>(random()));
      const std::uint16_t bytes = edge == 3 ? 60 : 40;
      for (unsigned block = 0; block < 8; ++block)
      {
        Put(input, static_cast<std::uint8_t>(block == 6 ? 2 : block == 7 ? 4 : block << 3));
        Put(input, static_cast<std::int32_t>(random() % 4000));
        // In the first block, whose end counts: within the block behind it, or further away.
        for (int axis = 0; axis < 3; ++axis)
        {
          input.push_back(static_cast<std::uint8_t>(tables == 1 ? 200 : 11 + axis));
        }
        Put(input, bytes);
      }
      for (int i = 0; i < 8 * bytes; ++i)
      {
        input.push_back(static_cast<std::uint8_t>(random()));
      }
      seeds.push_back(std::move(input));
    }
  }
  return seeds;
}

} // namespace banyan::fuzz
