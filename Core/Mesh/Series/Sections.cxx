// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/Sections.h"

#include "Base/Error.h"
#include "Base/Hash.h"
#include "Base/Varint.h"
#include "Series/Format/Zstd.h"

#include <algorithm>
#include <cstring>
#include <string>

namespace banyan::mesh_file
{
namespace
{

/// Bytes before the first section: magic, version, number of sections, hash of all that follows.
constexpr std::size_t HeadBytes = 24;
/// Once per series, so that time matters less than size; higher ones gain little.
constexpr int CompressionLevel = 15;
/// A section may be at most so many times its stored bytes: zstd does not compress more.
constexpr std::uint64_t GreatestRatio = 32768;

} // namespace

void Require(bool good, const char* sentence)
{
  if (!good)
  {
    throw Error(sentence);
  }
}

Bytes JoinSections(const Magic& magic, std::uint32_t version, const std::vector<Bytes>& sections)
{
  Bytes out(HeadBytes);
  for (const Bytes& section : sections)
  {
    Bytes stored;
    if (!section.empty())
    {
      AppendCompressed(section.data(), section.size(), CompressionLevel, stored);
    }
    const bool smaller = stored.size() < section.size();
    PutVarint(out, section.size());
    PutVarint(out, smaller ? stored.size() : section.size());
    const Bytes& kept = smaller ? stored : section;
    out.insert(out.end(), kept.begin(), kept.end());
  }
  std::memcpy(out.data(), magic, sizeof(magic));
  StoreNumber(out.data() + 8, version);
  StoreNumber(out.data() + 12, static_cast<std::uint32_t>(sections.size()));
  StoreNumber(out.data() + 16, ShortHashOf(out.data() + HeadBytes, out.size() - HeadBytes));
  return out;
}

std::vector<Bytes> SplitSections(
  const Bytes& file, const Magic& magic, std::uint32_t version, std::size_t count)
{
  Require(file.size() >= HeadBytes && std::memcmp(file.data(), magic, sizeof(magic)) == 0,
    "This is no file of a mesh");
  const auto found = LoadNumber<std::uint32_t>(file.data() + 8);
  if (found != version)
  {
    throw Error("The file of the mesh has version " + std::to_string(found) +
                ", and this Banyan reads version " + std::to_string(version));
  }
  Require(LoadNumber<std::uint32_t>(file.data() + 12) == count &&
            LoadNumber<std::uint64_t>(file.data() + 16) ==
              ShortHashOf(file.data() + HeadBytes, file.size() - HeadBytes),
    "The file of the mesh is damaged: its checksum does not fit");
  ByteReader reader(file.data() + HeadBytes, file.size() - HeadBytes);
  std::vector<Bytes> sections(count);
  for (Bytes& section : sections)
  {
    const std::uint64_t whole = reader.Varint();
    const std::uint64_t stored = reader.Varint();
    Require(stored <= reader.Left() && stored <= whole && whole / GreatestRatio <= stored,
      "A part of the mesh has an impossible size");
    const std::uint8_t* from = reader.Skip(stored);
    section.resize(whole);
    if (stored < whole)
    {
      Decompress(from, stored, section.data(), whole);
    }
    else
    {
      std::copy(from, from + stored, section.begin());
    }
  }
  reader.MustBeDone();
  return sections;
}

} // namespace banyan::mesh_file
