// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_SegmentFormat_h
#define banyan_Series_Format_SegmentFormat_h

#include "Base/Bytes.h"

#include <cstdint>

/// The numbers of Documentation/format.md, "A segment".
namespace banyan::segment
{

constexpr char Magic[9] = "BanyanSg";
constexpr std::uint32_t Version = 1;
constexpr std::size_t HeaderBytes = 64;

/// No zstd frame unpacks to more than this many times its size: a block of 128 KiB takes 4 bytes.
constexpr std::uint64_t GreatestExpansion = 32768;

struct Header
{
  std::uint32_t Steps = 0;
  /// Half a hash of all payloads, so that no two segments have the same header but equal ones.
  std::uint32_t PayloadHash = 0;
  std::uint32_t Sections = 0;
  std::uint64_t DirectoryOffset = 0;
  std::uint64_t DirectoryHash = 0;
  std::uint64_t PayloadEnd = 0;
  std::uint64_t FileBytes = 0;
};

/// Writes `HeaderBytes` bytes, the header's own hash included.
void StoreHeader(const Header& header, std::uint8_t* to);

/// Reads and checks magic, version and hash. Throws Error.
Header LoadHeader(const std::uint8_t* from);

} // namespace banyan::segment

#endif
