// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SegmentReader.h"

#include "Base/Error.h"
#include "Series/Hash.h"

#include <cmath>

namespace banyan
{

SegmentReader::SegmentReader(
  const std::string& folder, const SegmentIndex& index, std::uint32_t tablesPerStep)
  : File(folder, index)
  , Index(index)
  , TableCount(tablesPerStep * static_cast<std::uint32_t>(index.Steps))
{
}

void SegmentReader::CheckHeader() const
{
  const Bytes header = this->File.Read(0, segment::HeaderBytes);
  this->Head = segment::LoadHeader(header.data());
  const Hash128 hash = HashOf(header.data(), header.size());
  if (hash != Hash128{ this->Index.HashLow, this->Index.HashHigh })
  {
    throw Error("The segment is not the one that the index names");
  }
  const std::uint64_t directoryBytes = std::uint64_t{ this->TableCount } * segment::EntryBytes;
  const std::uint64_t offset = this->Head.DirectoryOffset;
  if (this->Head.FileBytes != this->Index.Bytes ||
      this->Head.Steps != static_cast<std::uint32_t>(this->Index.Steps) ||
      this->Head.FirstStep != static_cast<std::uint32_t>(this->Index.FirstStep) ||
      this->Head.Tables != this->TableCount || directoryBytes > this->Index.Bytes ||
      offset != this->Index.Bytes - directoryBytes || offset % segment::SectionAlignment != 0 ||
      this->Head.PayloadEnd < segment::HeaderBytes || this->Head.PayloadEnd > offset)
  {
    throw Error("The header of the segment does not fit the index");
  }
  this->Directory = this->File.Read(offset, static_cast<std::size_t>(directoryBytes));
  if (ShortHashOf(this->Directory.data(), this->Directory.size()) != this->Head.DirectoryHash)
  {
    throw Error("The directory of the segment is damaged");
  }
}

segment::TableEntry SegmentReader::Entry(std::uint32_t table) const
{
  std::lock_guard<std::mutex> lock(this->Mutex);
  if (!this->Checked)
  {
    this->CheckHeader();
    this->Checked = true;
  }
  const segment::TableEntry entry =
    segment::LoadEntry(this->Directory.data() + std::size_t{ table } * segment::EntryBytes);
  const std::uint64_t end = this->Head.DirectoryOffset;
  if (entry.Offset < this->Head.PayloadEnd || entry.Offset > end ||
      entry.Offset % segment::SectionAlignment != 0 || entry.StoredBytes > end - entry.Offset ||
      !std::isfinite(entry.Masks.Low) || !std::isfinite(entry.Masks.High))
  {
    throw Error("An entry of the directory is not valid");
  }
  return entry;
}

NodeTable SegmentReader::Table(
  const segment::TableEntry& entry, const BrickLayout& layout, ScalarType type) const
{
  const Bytes stored = this->File.Read(entry.Offset, static_cast<std::size_t>(entry.StoredBytes));
  if (ShortHashOf(stored.data(), stored.size()) != entry.Hash)
  {
    throw Error("A node table is damaged: its checksum does not fit");
  }
  return UnpackNodeTable(stored.data(), entry, layout, type, this->Head.PayloadEnd);
}

} // namespace banyan
