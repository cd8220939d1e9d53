#include "Series/SegmentWriter.h"

#include "Series/Hash.h"

namespace banyan
{

SegmentWriter::SegmentWriter(const std::string& folder, const std::string& file, int firstStep)
  : Name(file)
  , Output(folder + "/" + file)
  , FirstStep(firstStep)
{
  const std::uint8_t nothing[segment::HeaderBytes] = {};
  this->Output.Append(nothing, sizeof(nothing));
}

void SegmentWriter::PadTo(std::uint64_t alignment)
{
  const std::uint8_t zeros[segment::SectionAlignment] = {};
  const std::uint64_t size = this->Output.Size();
  this->Output.Append(zeros, static_cast<std::size_t>(AlignUp(size, alignment) - size));
}

std::uint64_t SegmentWriter::AddPayload(
  const Bytes& payload, const PayloadIdentity& identity, bool& merged)
{
  const auto [place, isNew] = this->Stored.try_emplace(identity, 0);
  merged = !isNew;
  if (isNew)
  {
    this->PadTo(segment::PayloadAlignment);
    place->second = this->Output.Size();
    this->Output.Append(payload.data(), payload.size());
  }
  return place->second;
}

void SegmentWriter::AddTable(Bytes packed, segment::TableEntry entry)
{
  entry.StoredBytes = packed.size();
  entry.Hash = ShortHashOf(packed.data(), packed.size());
  this->Tables.push_back(std::move(packed));
  this->Entries.push_back(entry);
}

SegmentIndex SegmentWriter::Finish(int steps)
{
  segment::Header header;
  header.PayloadEnd = this->Output.Size();
  Bytes directory(this->Entries.size() * segment::EntryBytes);
  for (std::size_t i = 0; i < this->Entries.size(); ++i)
  {
    this->PadTo(segment::SectionAlignment);
    this->Entries[i].Offset = this->Output.Size();
    this->Output.Append(this->Tables[i].data(), this->Tables[i].size());
    segment::StoreEntry(this->Entries[i], directory.data() + i * segment::EntryBytes);
  }
  this->PadTo(segment::SectionAlignment);
  header.Steps = static_cast<std::uint32_t>(steps);
  header.FirstStep = static_cast<std::uint32_t>(this->FirstStep);
  header.Tables = static_cast<std::uint32_t>(this->Entries.size());
  header.DirectoryOffset = this->Output.Size();
  header.DirectoryHash = ShortHashOf(directory.data(), directory.size());
  this->Output.Append(directory.data(), directory.size());
  header.FileBytes = this->Output.Size();
  std::uint8_t bytes[segment::HeaderBytes];
  segment::StoreHeader(header, bytes);
  this->Output.Overwrite(0, bytes, sizeof(bytes));
  this->Output.Commit();

  SegmentIndex index;
  index.File = this->Name;
  index.FirstStep = this->FirstStep;
  index.Steps = steps;
  index.Bytes = header.FileBytes;
  const Hash128 hash = HashOf(bytes, sizeof(bytes));
  index.HashLow = hash.Low;
  index.HashHigh = hash.High;
  return index;
}

} // namespace banyan
