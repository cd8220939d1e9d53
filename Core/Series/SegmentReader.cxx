#include "Series/SegmentReader.h"

#include "Base/Error.h"
#include "Series/Hash.h"

#include <cerrno>
#include <cmath>
#include <cstring>

#include <fcntl.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <unistd.h>

namespace banyan
{

SegmentReader::SegmentReader(
  const std::string& folder, const SegmentIndex& index, std::uint32_t tablesPerStep)
  : FilePath(folder + "/" + index.File)
  , Index(index)
  , TableCount(tablesPerStep * static_cast<std::uint32_t>(index.Steps))
{
  this->Map();
}

SegmentReader::~SegmentReader()
{
  munmap(const_cast<std::uint8_t*>(this->Data), static_cast<std::size_t>(this->Index.Bytes));
}

void SegmentReader::LetGo() const
{
  (void)madvise(const_cast<std::uint8_t*>(this->Data), static_cast<std::size_t>(this->Index.Bytes),
    MADV_DONTNEED);
}

void SegmentReader::Map()
{
  const int descriptor = open(this->FilePath.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK);
  if (descriptor < 0)
  {
    throw Error(std::string("A segment of the series cannot be opened: ") + std::strerror(errno),
      { this->FilePath });
  }
  struct stat status = {};
  const bool plain = fstat(descriptor, &status) == 0 && S_ISREG(status.st_mode);
  const std::uint64_t size = plain ? static_cast<std::uint64_t>(status.st_size) : 0;
  if (size != this->Index.Bytes || size < segment::HeaderBytes)
  {
    (void)close(descriptor);
    throw Error("A segment of the series does not have the size that the index says: it is cut "
                "short, or not of this series",
      { this->FilePath, {}, size, this->Index.Bytes });
  }
  void* data = mmap(nullptr, static_cast<std::size_t>(size), PROT_READ, MAP_SHARED, descriptor, 0);
  const int code = errno;
  (void)close(descriptor);
  if (data == MAP_FAILED)
  {
    throw Error(std::string("A segment of the series cannot be mapped: ") + std::strerror(code),
      { this->FilePath });
  }
  this->Data = static_cast<const std::uint8_t*>(data);
}

void SegmentReader::CheckHeader() const
{
  this->Head = segment::LoadHeader(this->Data);
  const Hash128 hash = HashOf(this->Data, segment::HeaderBytes);
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
  if (ShortHashOf(this->Data + offset, static_cast<std::size_t>(directoryBytes)) !=
      this->Head.DirectoryHash)
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
  const segment::TableEntry entry = segment::LoadEntry(
    this->Data + this->Head.DirectoryOffset + std::uint64_t{ table } * segment::EntryBytes);
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
  const std::uint8_t* stored = this->Data + entry.Offset;
  if (ShortHashOf(stored, static_cast<std::size_t>(entry.StoredBytes)) != entry.Hash)
  {
    throw Error("A node table is damaged: its checksum does not fit");
  }
  return UnpackNodeTable(stored, entry, layout, type, this->Head.PayloadEnd);
}

} // namespace banyan
