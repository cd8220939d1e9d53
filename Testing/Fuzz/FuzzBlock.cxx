// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Codec/BlockDecoder.h"
#include "Codec/BlockModes.h"
#include "Codec/BlockScratch.h"
#include "Codec/SymbolWriter.h"
#include "Fuzz.h"

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <vector>

namespace
{

using namespace banyan;

/// Decode tables of all contexts, of 8 kinds from very skewed to flat, some contexts empty.
const DecodeTables& TablesOf(unsigned kind)
{
  static const auto all = []
  {
    std::array<DecodeTables, 8> tables;
    for (unsigned k = 0; k < tables.size(); ++k)
    {
      std::vector<tans::Frequencies> frequencies;
      for (unsigned context = 0; context < residual::ContextCount; ++context)
      {
        if (context > 0 && (context * 7 + k) % 5 == 0)
        {
          frequencies.push_back(frequencies.back()); // contexts with one table
          continue;
        }
        std::array<std::uint32_t, tans::SymbolCount> counts = {};
        for (unsigned s = 0; s < counts.size() && (context + k) % 13 != 12; ++s)
        {
          counts[s] =
            1 + (0x10000u >> (s * k / 4 % 20)) + (context * 2654435761u >> (s % 32)) % 100;
        }
        frequencies.push_back(tans::Normalize(counts.data()));
      }
      tables[k] = DecodeTablesOf(frequencies);
    }
    return tables;
  }();
  return all[kind % 8];
}

/// Samples that are anything between small numbers and the ends of their type.
template <class Number>
std::vector<Number> Samples(std::size_t count, std::uint32_t seed)
{
  std::vector<Number> samples(count);
  for (Number& sample : samples)
  {
    seed = seed * 1664525u + 1013904223u;
    sample = static_cast<Number>(static_cast<std::int32_t>(seed) >> (seed % 8 * 4));
  }
  return samples;
}

/// Decodes twice; what was decoded before must not matter to samples of the field.
template <class Number>
void DecodeTwice(int edge, const PlaneCode& plane, const BlockCode (&blocks)[8], std::uint32_t seed)
{
  const std::size_t n = static_cast<std::size_t>(edge) + 1;
  const std::size_t coarse = static_cast<std::size_t>(edge) / 4 + 1;
  const auto coarseSamples = Samples<Number>(coarse * coarse * coarse, seed);
  const auto a = Samples<Number>(n * n * n, seed + 1);
  const auto b = Samples<Number>(n * n * n, seed + 2);
  BoxCodeOf<Number> code;
  std::copy(std::begin(blocks), std::end(blocks), std::begin(code.Blocks));
  code.Coarse = coarseSamples.data();
  code.A = seed % 5 == 0 ? nullptr : a.data();
  code.B = seed % 7 == 0 ? nullptr : b.data();
  for (std::uint32_t axis = 0; axis < 3; ++axis)
  {
    const bool given = (seed >> (8 + axis) & 3) == 3 && blocks[1u << axis].Exists;
    code.Neighbours[axis] = given ? a.data() : nullptr;
  }
  std::vector<Number> box(n * n * n);
  DecodeBox(edge, plane, code, box.data());
  std::vector<Number> again(n * n * n);
  DecodeBox(edge, plane, code, again.data());
  const glm::ivec3 last = glm::min(blocks[0].Limit, glm::ivec3(edge));
  for (int z = 0; z <= last.z; ++z)
  {
    for (int y = 0; y <= last.y; ++y)
    {
      const auto row = box.begin() + static_cast<std::ptrdiff_t>(n * (n * z + y));
      if (!std::equal(row, row + last.x + 1, again.begin() + (row - box.begin())))
      {
        std::abort();
      }
    }
  }
}

/// Which blocks there are, and where the field ends in each, as for any field that ends where the
/// first block says so: other combinations no reader asks for.
void PlaceInField(int edge, BlockCode (&blocks)[8])
{
  const glm::ivec3 last = blocks[0].Limit;
  for (int i = 0; i < 8; ++i)
  {
    const glm::ivec3 limit = last - edge * glm::ivec3(i & 1, i >> 1 & 1, i >> 2);
    if (!glm::all(glm::greaterThanEqual(limit, glm::ivec3(0))))
    {
      blocks[i] = BlockCode();
      continue;
    }
    blocks[i].Limit = limit;
    blocks[i].Exists = true;
  }
}

} // namespace

/// The input: edge, tables and references, limits of the lattice; for each of 8 blocks flags, mode,
/// value, field's end and size of its payload; then the payloads.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size)
{
  fuzz::Input in(data, size);
  const std::uint8_t head = in.Take<std::uint8_t>();
  const int edge = head % 4 == 3 ? 32 : 16;
  PlaneCode plane;
  plane.Tables = &TablesOf(head >> 3);
  plane.CoarseBin = in.Take<std::int32_t>();
  plane.FineBin = in.Take<std::int32_t>();
  plane.Least = in.Take<std::int32_t>();
  plane.Greatest = std::max(plane.Least, in.Take<std::int32_t>());
  if (head >> 6 == 3)
  {
    plane.Least %= 4001;
    plane.Greatest = plane.Least + (plane.Greatest & 4095); // a lattice of 16 bits
  }
  const std::uint32_t seed = in.Take<std::uint32_t>();
  BlockCode blocks[8];
  std::array<std::vector<std::uint8_t>, 8> payloads;
  std::array<std::size_t, 8> sizes = {};
  for (std::size_t i = 0; i < 8; ++i)
  {
    BlockCode& block = blocks[i];
    const std::uint8_t flags = in.Take<std::uint8_t>();
    block.Uniform = (flags & 6) == 2;
    block.Same = (flags & 6) == 4;
    block.Mode = static_cast<std::uint8_t>((flags >> 3) % block::ModeCount);
    block.Value = in.Take<std::int32_t>();
    for (int a = 0; a < 3; ++a)
    {
      block.Limit[a] = in.Take<std::uint8_t>();
    }
    sizes[i] = in.Take<std::uint16_t>();
  }
  PlaceInField(edge, blocks);
  for (std::size_t i = 0; i < 8; ++i)
  {
    // Copies of the exact size, so that reading behind them is noticed.
    payloads[i] = in.Bytes(blocks[i].Exists ? sizes[i] : 0);
    blocks[i].Data = payloads[i].data();
    blocks[i].Bytes = payloads[i].size();
  }
  try
  {
    if (block::Narrow(plane.Least, plane.Greatest))
    {
      DecodeTwice<std::int16_t>(edge, plane, blocks, seed);
    }
    DecodeTwice<std::int32_t>(edge, plane, blocks, seed);
  }
  catch (const Error&)
  {
  }
  return 0;
}
