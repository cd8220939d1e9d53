// SPDX-License-Identifier: BSD-3-Clause
#include "CodecSeeds.h"

#include "Series/Hash.h"
#include "Series/IndexText.h"
#include "Series/SegmentReader.h"

#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
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

/// The shortest payloads by type and mode.
using Shortest = std::map<std::pair<int, int>, std::vector<std::uint8_t>>;

/// Adds the payloads of one table.
void AddTable(const SegmentReader& segment, std::uint32_t number, const BrickLayout& layout,
  ScalarType type, Shortest& shortest)
{
  const segment::TableEntry entry = segment.Entry(number);
  const NodeTable table = segment.Table(entry, layout, type);
  for (std::size_t i = 0; i < table.Nodes.size(); ++i)
  {
    const PayloadReference& payload = table.Payloads[i];
    const glm::ivec3 samples = layout.SamplesOf(static_cast<std::int64_t>(i)).Size();
    std::vector<std::uint8_t> input{ payload.Mode, static_cast<std::uint8_t>(type) };
    for (int axis = 0; axis < 3; ++axis)
    {
      input.push_back(static_cast<std::uint8_t>(samples[axis] - 1));
    }
    Put(input, entry.QuantizerOrigin);
    Put(input, entry.QuantizerStep);
    if (!table.Nodes[i].Uniform)
    {
      const Bytes bytes = segment.Payload(payload, table.Nodes[i].PayloadBytes);
      input.insert(input.end(), bytes.begin(), bytes.end());
    }
    auto& kept = shortest[{ static_cast<int>(type), payload.Mode }];
    if (kept.empty() || input.size() < kept.size())
    {
      kept = std::move(input);
    }
  }
}

} // namespace

std::vector<std::vector<std::uint8_t>> BlockSeeds()
{
  std::vector<std::vector<std::uint8_t>> seeds;
  std::mt19937 random(1);
  for (unsigned edge : { 0u, 1u, 2u, 7u }) // 8, 16, 32 and 64
  {
    for (const unsigned tables : { 1u, 25u }) // the second with a lattice of 16 bits
    {
      std::vector<std::uint8_t> input{ static_cast<std::uint8_t>(edge | tables << 3) };
      Put(input, std::int32_t{ 31 });
      Put(input, std::int32_t{ 15 });
      Put(input, std::int32_t{ -4000 });
      Put(input, std::int32_t{ 3999 });
      Put(input, static_cast<std::uint32_t>(random()));
      const std::uint16_t bytes = edge == 7 ? 60 : 40;
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

std::vector<std::vector<std::uint8_t>> BrickSeeds(const std::string& path)
{
  std::ifstream stream(path, std::ios::binary);
  const std::string text{ std::istreambuf_iterator<char>(stream), {} };
  const SeriesIndex index = IndexFromText(text, path);
  std::uint32_t tables = 0; // of a step
  for (const ArrayIndex& array : index.Arrays)
  {
    tables += static_cast<std::uint32_t>(array.Components.size()) *
              static_cast<std::uint32_t>(index.Levels);
  }
  Shortest shortest;
  for (const SegmentIndex& part : index.Segments)
  {
    const SegmentReader segment(path + ".d", part, tables);
    std::uint32_t number = 0;
    for (const ArrayIndex& array : index.Arrays)
    {
      for (std::size_t component = 0; component < array.Components.size(); ++component)
      {
        for (int level = 0; level < index.Levels; ++level)
        {
          const BrickLayout layout(index.Domain.Samples(), index.BrickCells, level);
          AddTable(segment, number++, layout, array.Type, shortest);
        }
      }
    }
  }
  std::vector<std::vector<std::uint8_t>> seeds;
  for (auto& [key, input] : shortest)
  {
    seeds.push_back(std::move(input));
  }
  return seeds;
}

} // namespace banyan::fuzz
