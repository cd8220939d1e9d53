// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SegmentFormat.h"

#include "Base/Error.h"
#include "Series/Hash.h"

namespace banyan::segment
{

void StoreHeader(const Header& header, std::uint8_t* to)
{
  std::memcpy(to, Magic, 8);
  StoreNumber(to + 8, header.Version);
  StoreNumber(to + 12, header.Steps);
  StoreNumber(to + 16, header.FirstStep);
  StoreNumber(to + 20, header.Tables);
  StoreNumber(to + 24, header.DirectoryOffset);
  StoreNumber(to + 32, header.DirectoryHash);
  StoreNumber(to + 40, header.PayloadEnd);
  StoreNumber(to + 48, header.FileBytes);
  StoreNumber(to + 56, ShortHashOf(to, 56));
}

Header LoadHeader(const std::uint8_t* from, std::uint32_t wantedVersion)
{
  if (std::memcmp(from, Magic, 8) != 0)
  {
    throw Error("This is not a segment of a Banyan series");
  }
  const auto version = LoadNumber<std::uint32_t>(from + 8);
  if (version != wantedVersion)
  {
    throw Error("This segment has another format version than its series",
      { {}, {}, version, wantedVersion });
  }
  if (LoadNumber<std::uint64_t>(from + 56) != ShortHashOf(from, 56))
  {
    throw Error("The header of a segment is damaged");
  }
  Header header;
  header.Version = version;
  header.Steps = LoadNumber<std::uint32_t>(from + 12);
  header.FirstStep = LoadNumber<std::uint32_t>(from + 16);
  header.Tables = LoadNumber<std::uint32_t>(from + 20);
  header.DirectoryOffset = LoadNumber<std::uint64_t>(from + 24);
  header.DirectoryHash = LoadNumber<std::uint64_t>(from + 32);
  header.PayloadEnd = LoadNumber<std::uint64_t>(from + 40);
  header.FileBytes = LoadNumber<std::uint64_t>(from + 48);
  return header;
}

TableEntry LoadEntry(const std::uint8_t* from)
{
  TableEntry entry;
  entry.Offset = LoadNumber<std::uint64_t>(from);
  entry.StoredBytes = LoadNumber<std::uint64_t>(from + 8);
  entry.RawBytes = LoadNumber<std::uint64_t>(from + 16);
  entry.Hash = LoadNumber<std::uint64_t>(from + 24);
  entry.Masks = { LoadNumber<double>(from + 32), LoadNumber<double>(from + 40) };
  entry.QuantizerOrigin = LoadNumber<std::uint64_t>(from + 48);
  entry.QuantizerStep = LoadNumber<std::uint64_t>(from + 56);
  return entry;
}

} // namespace banyan::segment
