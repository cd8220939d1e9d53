// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_SegmentFormat_h
#define banyan_Series_SegmentFormat_h

#include "Series/Bytes.h"
#include "Series/Quantizer.h"
#include "Series/ValueMask.h"

#include <cstdint>

/// The numbers of Documentation/format.md, "A segment".
namespace banyan::segment
{

constexpr char Magic[9] = "BanyanSg";
constexpr std::uint32_t Version = 1;
constexpr std::size_t HeaderBytes = 64;
constexpr std::size_t EntryBytes = 64;
constexpr std::size_t NodeBytes = 54;
constexpr std::uint64_t SectionAlignment = 64;
constexpr std::uint64_t PayloadAlignment = 8;

/// No zstd frame unpacks to more than this many times its size: a block of 128 KiB takes 4 bytes.
constexpr std::uint64_t GreatestExpansion = 32768;

struct Header
{
  std::uint32_t Version = segment::Version;
  std::uint32_t Steps = 0;
  /// Version 2: half a hash of all payloads instead, so that no two segments have the same header
  /// but equal ones.
  std::uint32_t FirstStep = 0;
  std::uint32_t Tables = 0;
  std::uint64_t DirectoryOffset = 0;
  std::uint64_t DirectoryHash = 0;
  std::uint64_t PayloadEnd = 0;
  std::uint64_t FileBytes = 0;
};

/// One entry of the directory.
struct TableEntry
{
  std::uint64_t Offset = 0;
  std::uint64_t StoredBytes = 0;
  std::uint64_t RawBytes = 0;
  std::uint64_t Hash = 0;
  MaskRange Masks;
  std::uint64_t QuantizerOrigin = 0;
  std::uint64_t QuantizerStep = 0;
};

/// Writes `HeaderBytes` bytes, the header's own hash included.
void StoreHeader(const Header& header, std::uint8_t* to);

/// Reads and checks magic, version and hash. Throws Error.
Header LoadHeader(const std::uint8_t* from, std::uint32_t wantedVersion = Version);

/// Reads `EntryBytes` bytes.
TableEntry LoadEntry(const std::uint8_t* from);

} // namespace banyan::segment

#endif
