// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/GroupWriter.h"

#include "Base/Hash.h"
#include "Codec/GroupOrder.h"
#include "Series/Format/SegmentFormat.h"
#include "Series/Format/Zstd.h"

#include <algorithm>

namespace banyan
{

namespace
{

constexpr int TableLevel = 19; ///< of zstd: tables are small, and read more often than written

} // namespace

GroupWriter::GroupWriter(SegmentFolder& folder, int number)
  : Folder(folder)
  , Output(folder.Path() + "/" + folder.TemporaryNameOf(number))
  , Payloads(segment::HeaderBytes)
{
}

group::Place GroupWriter::Store(const Bytes& payload, EncodeStatistics& statistics)
{
  const Hash128 hash = HashOf(payload.data(), payload.size());
  const auto [place, isNew] = this->Stored.try_emplace(hash, group::Place{});
  if (isNew)
  {
    place->second = { this->Payloads.size(), static_cast<std::uint32_t>(payload.size()) };
    this->Payloads.insert(this->Payloads.end(), payload.begin(), payload.end());
    statistics.PayloadBytes += payload.size();
  }
  else
  {
    ++statistics.MergedBricks;
  }
  return place->second;
}

void GroupWriter::AddStep(const EncodedStep& step, EncodeStatistics& statistics)
{
  group::StepTable table;
  table.FirstPayload = this->Payloads.size();
  table.Top = step.Top;
  table.Levels = step.Levels;
  for (const auto& plane : step.Planes)
  {
    table.Planes.emplace_back(plane.size());
    for (std::size_t b = 0; b < plane.size(); ++b)
    {
      group::BlockEntry& entry = table.Planes.back()[b];
      const EncodedBlock& block = plane[b];
      entry.Mode = block.Mode;
      entry.Uniform = block.Uniform;
      entry.Same = block.Same;
      statistics.MergedBricks += block.Same ? 1 : 0;
      entry.Value = block.Value;
      if (!block.Payload.empty())
      {
        entry.Payload = this->Store(block.Payload, statistics);
      }
      if (!block.Exceptions.empty())
      {
        entry.Exceptions = this->Store(block.Exceptions, statistics);
        ++statistics.RawBricks;
      }
      ++statistics.Blocks;
      statistics.EmptyBlocks += block.Payload.empty() && block.Exceptions.empty() ? 1 : 0;
    }
  }
  for (const auto& level : step.Levels)
  {
    for (const group::NodeEntry& node : level)
    {
      ++statistics.Bricks;
      statistics.MacroVoxelBricks += node.Uniform ? 1 : 0;
      statistics.UnchangedBricks += node.Age > 0 ? 1 : 0;
    }
  }
  this->Tables.push_back(std::move(table));
}

void GroupWriter::AddStaticStep(const EncodedStep& like, EncodeStatistics& statistics)
{
  for (const auto& plane : like.Planes)
  {
    statistics.Blocks += static_cast<std::int64_t>(plane.size());
    statistics.EmptyBlocks += static_cast<std::int64_t>(plane.size());
  }
  for (const auto& level : like.Levels)
  {
    statistics.Bricks += static_cast<std::int64_t>(level.size());
    statistics.UnchangedBricks += static_cast<std::int64_t>(level.size());
    for (const group::NodeEntry& node : level)
    {
      statistics.MacroVoxelBricks += node.Uniform ? 1 : 0;
    }
  }
  this->Tables.emplace_back();
}

group::Section GroupWriter::AddSection(const Bytes& raw, bool compressed)
{
  Bytes packed;
  if (compressed)
  {
    AppendCompressed(raw.data(), raw.size(), TableLevel, packed);
  }
  if (!compressed || packed.size() >= raw.size())
  {
    packed = raw;
  }
  group::Section section;
  section.Offset = this->Output.Size();
  section.StoredBytes = static_cast<std::uint32_t>(packed.size());
  section.RawBytes = static_cast<std::uint32_t>(raw.size());
  section.Hash = ShortHashOf(packed.data(), packed.size());
  if (raw.size() > 0xffffffffu || packed.size() > 0xffffffffu)
  {
    throw Error("A table of the segment is larger than 4 GiB: lower 'Keyframe Interval' "
                "(KeyframeInterval), or take bricks of 32 cells");
  }
  this->Output.Append(packed.data(), packed.size());
  return section;
}

Bytes GroupWriter::PageHashes() const
{
  const std::uint64_t end = this->Payloads.size();
  const std::uint64_t page = PageBytesOf(end);
  Bytes hashes;
  for (std::uint64_t at = 0; at < end; at += page)
  {
    // The first page begins with the header, which is hashed elsewhere and written last.
    const std::uint64_t from = std::max<std::uint64_t>(at, segment::HeaderBytes);
    const std::uint32_t hash = static_cast<std::uint32_t>(
      ShortHashOf(this->Payloads.data() + from, std::min(at + page, end) - from));
    const std::size_t place = hashes.size();
    hashes.resize(place + sizeof(hash));
    StoreNumber(hashes.data() + place, hash);
  }
  return hashes;
}

SegmentIndex GroupWriter::Finish(const std::vector<group::FieldHead>& heads,
  const std::vector<group::TableShape>& shapes, int firstStep, int steps)
{
  this->Output.Append(this->Payloads.data(), this->Payloads.size());
  segment::Header header;
  header.PayloadEnd = this->Output.Size();
  std::vector<group::Section> sections;
  sections.push_back(this->AddSection(this->PageHashes(), true));
  for (const group::FieldHead& head : heads)
  {
    sections.push_back(this->AddSection(group::PackHead(head), true));
  }
  this->AddSteps(heads, shapes, steps, sections);
  header.Steps = static_cast<std::uint32_t>(steps);
  const std::uint64_t content = ShortHashOf(
    this->Payloads.data() + segment::HeaderBytes, this->Payloads.size() - segment::HeaderBytes);
  header.PayloadHash =
    static_cast<std::uint32_t>(content >> 32); // pages have the low half of theirs
  this->AddDirectory(sections, header);
  header.FileBytes = this->Output.Size();
  std::uint8_t bytes[segment::HeaderBytes];
  segment::StoreHeader(header, bytes);
  this->Output.Overwrite(0, bytes, sizeof(bytes));
  const Hash128 hash = HashOf(bytes, sizeof(bytes));
  SegmentIndex index;
  index.File = this->Folder.FinalNameOf(hash);
  this->Output.CommitAs(this->Folder.Path() + "/" + index.File);
  index.FirstStep = firstStep;
  index.Steps = steps;
  index.Bytes = header.FileBytes;
  index.HashLow = hash.Low;
  index.HashHigh = hash.High;
  return index;
}

/// Appends the tables of all steps.
void GroupWriter::AddSteps(const std::vector<group::FieldHead>& heads,
  const std::vector<group::TableShape>& shapes, int steps, std::vector<group::Section>& sections)
{
  for (std::size_t i = 0; i < this->Tables.size(); ++i)
  {
    const std::size_t component = i % heads.size();
    const int step = static_cast<int>(i / heads.size());
    if (heads[component].Static)
    {
      sections.push_back(this->AddSection({}, false));
      continue;
    }
    group::TableReference reference;
    reference.Step = ReferencesOfStep(step, steps, heads[component].Open).B;
    if (reference.Step >= 0)
    {
      reference.Table =
        &this->Tables[static_cast<std::size_t>(reference.Step) * heads.size() + component];
    }
    sections.push_back(this->AddSection(
      group::PackStep(this->Tables[i], shapes[component], step, reference), false));
  }
}

/// Appends the directory, and says in the header where it is.
void GroupWriter::AddDirectory(const std::vector<group::Section>& sections, segment::Header& header)
{
  Bytes directory(sections.size() * group::EntryBytes);
  for (std::size_t i = 0; i < sections.size(); ++i)
  {
    std::uint8_t* to = directory.data() + i * group::EntryBytes;
    StoreNumber(to, sections[i].Offset);
    StoreNumber(to + 8, sections[i].StoredBytes);
    StoreNumber(to + 12, sections[i].RawBytes);
    StoreNumber(to + 16, sections[i].Hash);
  }
  header.Sections = static_cast<std::uint32_t>(sections.size());
  header.DirectoryOffset = this->Output.Size();
  header.DirectoryHash = ShortHashOf(directory.data(), directory.size());
  this->Output.Append(directory.data(), directory.size());
}

} // namespace banyan
