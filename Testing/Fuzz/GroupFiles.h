// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_GroupFiles_h
#define banyan_Testing_GroupFiles_h

#include "Series/Format/SeriesIndex.h"

#include <string>
#include <vector>

namespace banyan::fuzz
{

using Bytes = std::vector<std::uint8_t>;

/// What a segment holds behind its checksums and compression.
struct GroupParts
{
  Bytes Payloads;              ///< from offset 64 on
  std::vector<Bytes> Sections; ///< heads and step tables, not the hashes of pages
};

/// The series that the fuzzer takes turns with: four types, each with the first and with the second
/// segment as what is not as it should be.
constexpr int SeriesKinds = 8;

/// A series of three steps in one segment and two in another, which refers to the first; small: its
/// index, and the parts of one of its segments.
struct SmallSeries
{
  /// Encodes one in the folder.
  SmallSeries(const std::string& folder, int kind);

  SegmentIndex& Changed() { return this->Index.Segments[this->Number]; }

  std::string Path;
  std::size_t Number; ///< of the segment
  SeriesIndex Index;
  GroupParts Parts;
};

/// Parts as the bytes of an input, and back; any bytes are safe.
Bytes ToInput(int kind, const GroupParts& parts);
GroupParts FromInput(const std::uint8_t* data, std::size_t size, std::size_t sections);

/// The file of a segment made of these parts, all checksums right.
Bytes Assemble(const GroupParts& parts, const SegmentIndex& segment);

} // namespace banyan::fuzz

#endif
