// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_Sections_h
#define banyan_Mesh_Series_Sections_h

#include "Base/Bytes.h"

#include <cstdint>
#include <vector>

namespace banyan::mesh_file
{

/// The first bytes of a kind of file.
using Magic = char[8];

/// A file of sections, each compressed where that makes it smaller: see Documentation/format.md.
Bytes JoinSections(const Magic& magic, std::uint32_t version, const std::vector<Bytes>& sections);

/// Inverse of JoinSections. Throws Error when the bytes are no such file, or are damaged. Takes no
/// memory that the file does not explain.
/// @param count how many sections the file has to have
std::vector<Bytes> SplitSections(
  const Bytes& file, const Magic& magic, std::uint32_t version, std::size_t count);

/// Throws Error with a sentence where something of a file is not as it must be.
void Require(bool good, const char* sentence);

} // namespace banyan::mesh_file

#endif
