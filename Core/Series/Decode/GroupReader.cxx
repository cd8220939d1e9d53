// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/GroupReader.h"

#include "Base/Error.h"
#include "Base/Hash.h"
#include "Series/Format/Zstd.h"

#include <algorithm>

namespace banyan
{

GroupReader::GroupReader(const std::string& folder, const SegmentIndex& index,
  std::uint32_t components, CacheContext& caches)
  : GroupReader(std::make_shared<const SegmentFile>(folder, index), index, components, caches)
{
}

GroupReader::GroupReader(std::shared_ptr<const SegmentFile> file, const SegmentIndex& index,
  std::uint32_t components, CacheContext& caches)
  : File(std::move(file))
  , Index(index)
  , Components(components)
  , Context(caches)
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
  const Bytes header = this->File->Read(0, segment::HeaderBytes);
  this->Head = segment::LoadHeader(header.data());
  if (HashOf(header.data(), header.size()) != this->Expected)
  {
    throw Error("The segment is not the one that the index names");
  }
  const std::uint64_t sections =
    1 + std::uint64_t{ this->Components } * (1 + static_cast<std::uint64_t>(this->Index.Steps));
  const std::uint64_t bytes = this->File->Bytes();
  const std::uint64_t directoryBytes = sections * group::EntryBytes;
  if (this->Head.FileBytes != bytes ||
      this->Head.Steps != static_cast<std::uint32_t>(this->Index.Steps) ||
      this->Head.Sections != sections || directoryBytes > bytes ||
      this->Head.DirectoryOffset != bytes - directoryBytes ||
      this->Head.PayloadEnd < segment::HeaderBytes ||
      this->Head.PayloadEnd > this->Head.DirectoryOffset)
  {
    throw Error("The header of the segment does not fit the index");
  }
  this->Directory =
    this->File->Read(this->Head.DirectoryOffset, static_cast<std::size_t>(directoryBytes));
  if (ShortHashOf(this->Directory.data(), this->Directory.size()) != this->Head.DirectoryHash)
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
  const std::uint8_t* entry = this->Directory.data() + std::size_t{ number } * group::EntryBytes;
  const auto offset = LoadNumber<std::uint64_t>(entry);
  const auto stored = LoadNumber<std::uint32_t>(entry + 8);
  const auto raw = LoadNumber<std::uint32_t>(entry + 12);
  const std::uint64_t end = this->Head.DirectoryOffset;
  if (offset < this->Head.PayloadEnd || offset > end || stored > end - offset ||
      raw / segment::GreatestExpansion > stored || (number > this->Components && raw != stored))
  {
    throw Error("An entry of the directory is not valid");
  }
  Bytes packed = this->File->Read(offset, stored);
  if (ShortHashOf(packed.data(), packed.size()) != LoadNumber<std::uint64_t>(entry + 16))
  {
    throw Error("A table of the segment is damaged: its checksum does not fit");
  }
  if (stored == raw)
  {
    return packed;
  }
  Bytes bytes(raw);
  Decompress(packed.data(), packed.size(), bytes.data(), bytes.size());
  return bytes;
}

PayloadPages& GroupReader::Payloads()
{
  std::call_once(this->PagesOnce,
    [this]
    {
      const Bytes hashes = this->Section(0);
      const std::uint64_t end = this->Head.PayloadEnd;
      const std::uint64_t page = PageBytesOf(end);
      const std::uint64_t pages = (end + page - 1) / page;
      if (hashes.size() != pages * sizeof(std::uint32_t))
      {
        throw Error("The hashes of the segment's pages are not as many as its pages");
      }
      std::vector<std::uint32_t> numbers(static_cast<std::size_t>(pages));
      std::memcpy(numbers.data(), hashes.data(), hashes.size());
      this->Pages = std::make_unique<PayloadPages>(
        this->Context.Payloads(), *this->File, end, std::move(numbers));
    });
  return *this->Pages;
}

} // namespace banyan
