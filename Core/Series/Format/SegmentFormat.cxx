// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/SegmentFormat.h"

#include "Base/Error.h"
#include "Base/Hash.h"

#include <string>

namespace banyan::segment
{

void StoreHeader(const Header& header, std::uint8_t* to)
{
  std::memcpy(to, Magic, 8);
  StoreNumber(to + 8, Version);
  StoreNumber(to + 12, header.Steps);
  StoreNumber(to + 16, header.PayloadHash);
  StoreNumber(to + 20, header.Sections);
  StoreNumber(to + 24, header.DirectoryOffset);
  StoreNumber(to + 32, header.DirectoryHash);
  StoreNumber(to + 40, header.PayloadEnd);
  StoreNumber(to + 48, header.FileBytes);
  StoreNumber(to + 56, ShortHashOf(to, 56));
}

Header LoadHeader(const std::uint8_t* from)
{
  if (std::memcmp(from, Magic, 8) != 0)
  {
    throw Error("This is not a segment of a Banyan series");
  }
  const auto version = LoadNumber<std::uint32_t>(from + 8);
  if (version != Version)
  {
    throw Error("A segment has format version " + std::to_string(version) +
                ", and this Banyan reads version " + std::to_string(Version) +
                ": it needs a newer one");
  }
  if (LoadNumber<std::uint64_t>(from + 56) != ShortHashOf(from, 56))
  {
    throw Error("The header of a segment is damaged");
  }
  Header header;
  header.Steps = LoadNumber<std::uint32_t>(from + 12);
  header.PayloadHash = LoadNumber<std::uint32_t>(from + 16);
  header.Sections = LoadNumber<std::uint32_t>(from + 20);
  header.DirectoryOffset = LoadNumber<std::uint64_t>(from + 24);
  header.DirectoryHash = LoadNumber<std::uint64_t>(from + 32);
  header.PayloadEnd = LoadNumber<std::uint64_t>(from + 40);
  header.FileBytes = LoadNumber<std::uint64_t>(from + 48);
  return header;
}

} // namespace banyan::segment
