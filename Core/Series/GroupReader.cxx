#include "Series/GroupReader.h"

#include "Base/Error.h"
#include "Series/GroupWriter.h"
#include "Series/Hash.h"
#include "Series/Zstd.h"

#include <algorithm>

namespace banyan
{

GroupReader::GroupReader(
  const std::string& folder, const SegmentIndex& index, std::uint32_t components)
  : GroupReader(std::make_shared<const MappedSegment>(folder, index), index, components)
{
}

GroupReader::GroupReader(std::shared_ptr<const MappedSegment> file, const SegmentIndex& index,
  std::uint32_t components)
  : File(std::move(file))
  , Index(index)
  , Components(components)
  , Expected{ index.HashLow, index.HashHigh }
{
}

void GroupReader::Check()
{
  std::lock_guard<std::mutex> lock(this->Mutex);
  if (this->Checked)
  {
    return;
  }
  this->Head = segment::LoadHeader(this->File->Data(), group::Version);
  if (HashOf(this->File->Data(), segment::HeaderBytes) != this->Expected)
  {
    throw Error("The segment is not the one that the index names");
  }
  const std::uint64_t sections =
    1 + std::uint64_t{ this->Components } * (1 + static_cast<std::uint64_t>(this->Index.Steps));
  const std::uint64_t bytes = this->File->Bytes();
  const std::uint64_t directoryBytes = sections * group::EntryBytes;
  if (this->Head.FileBytes != bytes ||
      this->Head.Steps != static_cast<std::uint32_t>(this->Index.Steps) ||
      this->Head.Tables != sections || directoryBytes > bytes ||
      this->Head.DirectoryOffset != bytes - directoryBytes ||
      this->Head.PayloadEnd < segment::HeaderBytes ||
      this->Head.PayloadEnd > this->Head.DirectoryOffset)
  {
    throw Error("The header of the segment does not fit the index");
  }
  if (ShortHashOf(this->File->Data() + this->Head.DirectoryOffset,
        static_cast<std::size_t>(directoryBytes)) != this->Head.DirectoryHash)
  {
    throw Error("The directory of the segment is damaged");
  }
  this->Checked = true;
}

std::uint64_t GroupReader::PayloadEnd()
{
  this->Check();
  return this->Head.PayloadEnd;
}

Bytes GroupReader::Section(std::uint32_t number)
{
  this->Check();
  const std::uint8_t* entry =
    this->File->Data() + this->Head.DirectoryOffset + std::uint64_t{ number } * group::EntryBytes;
  const auto offset = LoadNumber<std::uint64_t>(entry);
  const auto stored = LoadNumber<std::uint32_t>(entry + 8);
  const auto raw = LoadNumber<std::uint32_t>(entry + 12);
  const std::uint64_t end = this->Head.DirectoryOffset;
  if (offset < this->Head.PayloadEnd || offset > end || stored > end - offset ||
      raw / segment::GreatestExpansion > stored || (number > this->Components && raw != stored))
  {
    throw Error("An entry of the directory is not valid");
  }
  if (ShortHashOf(this->File->Data() + offset, stored) != LoadNumber<std::uint64_t>(entry + 16))
  {
    throw Error("A table of the segment is damaged: its checksum does not fit");
  }
  if (stored == raw)
  {
    return { this->File->Data() + offset, this->File->Data() + offset + stored };
  }
  Bytes bytes(raw);
  Decompress(this->File->Data() + offset, stored, bytes.data(), bytes.size());
  return bytes;
}

const std::uint8_t* GroupReader::Payload(const group::Place& place)
{
  std::call_once(this->PagesOnce,
    [this]
    {
      const Bytes hashes = this->Section(0);
      this->PageBytes = PageBytesOf(this->Head.PayloadEnd);
      const std::uint64_t pages = (this->Head.PayloadEnd + this->PageBytes - 1) / this->PageBytes;
      if (hashes.size() != pages * sizeof(std::uint32_t))
      {
        throw Error("The hashes of the segment's pages are not as many as its pages");
      }
      this->PageHashes.resize(static_cast<std::size_t>(pages));
      std::memcpy(this->PageHashes.data(), hashes.data(), hashes.size());
      this->PageGood = std::vector<std::atomic<bool>>(static_cast<std::size_t>(pages));
    });
  const std::uint64_t end = place.Offset + place.Bytes; // inside: tables were checked
  for (std::uint64_t page = place.Offset / this->PageBytes; page * this->PageBytes < end; ++page)
  {
    std::atomic<bool>& good = this->PageGood[static_cast<std::size_t>(page)];
    if (good.load(std::memory_order_relaxed))
    {
      continue;
    }
    const std::uint64_t from =
      std::max<std::uint64_t>(page * this->PageBytes, segment::HeaderBytes);
    const std::uint64_t to = std::min((page + 1) * this->PageBytes, this->Head.PayloadEnd);
    if (static_cast<std::uint32_t>(ShortHashOf(this->File->Data() + from, to - from)) !=
        this->PageHashes[static_cast<std::size_t>(page)])
    {
      throw Error("Payloads of the segment are damaged: their checksum does not fit",
        { this->Path(), from });
    }
    good.store(true, std::memory_order_relaxed);
  }
  return this->File->Data() + place.Offset;
}

} // namespace banyan
