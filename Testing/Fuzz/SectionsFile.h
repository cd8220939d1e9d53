// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_SectionsFile_h
#define banyan_Testing_SectionsFile_h

#include "Base/Hash.h"
#include "Base/Varint.h"

#include <cstring>

namespace banyan::fuzz
{

/// The file of a mesh with these sections, none of them compressed, checksums right.
/// @param magic eight letters, the first ones of the file
/// @param sections how many the file has
/// @param data the sections, each behind its size (a varint)
/// Throws Error when the input ends early.
inline Bytes FileOfSections(
  const char* magic, std::uint32_t sections, const std::uint8_t* data, std::size_t size)
{
  constexpr std::size_t head = 24;
  Bytes file(head);
  std::memcpy(file.data(), magic, 8);
  StoreNumber(file.data() + 8, std::uint32_t{ 1 });
  StoreNumber(file.data() + 12, sections);
  ByteReader reader(data, size);
  for (std::uint32_t i = 0; i < sections; ++i)
  {
    const std::uint64_t bytes = reader.Varint();
    const std::uint8_t* part = reader.Skip(bytes);
    PutVarint(file, bytes);
    PutVarint(file, bytes);
    file.insert(file.end(), part, part + bytes);
  }
  StoreNumber(file.data() + 16, ShortHashOf(file.data() + head, file.size() - head));
  return file;
}

} // namespace banyan::fuzz

#endif
