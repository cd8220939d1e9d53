// SPDX-License-Identifier: BSD-3-Clause
#include "Series/FieldReader.h"

#include "Base/Error.h"
#include "Series/SegmentReader.h"

#include <algorithm>
#include <atomic>
#include <list>
#include <mutex>

namespace banyan
{
namespace
{

/// A table together with what is needed to decode its bricks.
struct OpenField
{
  NodeTable Table;
  Quantizer Lattice;
  ScalarType Type = ScalarType::Float32;
  BrickLayout Layout;
  const SegmentReader* Segment = nullptr;
};

class Reader1 : public FieldReader
{
public:
  explicit Reader1(const OpenSeries& series);

  std::shared_ptr<const std::vector<BrickNode>> Nodes(const FieldKey& field) override;
  void DecodeBrick(const FieldKey& field, std::int64_t brick, void* values) override;
  void VerifyBricks(const FieldKey& field, const std::vector<std::int64_t>& bricks) override;
  std::uint64_t BytesRead() const override { return this->Read; }
  std::uint64_t BricksDecoded() const override { return this->Decoded; }

private:
  using Kept = std::pair<std::uint64_t, std::shared_ptr<const OpenField>>;

  const SegmentReader& Segment(int step);
  std::shared_ptr<const OpenField> Load(const FieldKey& field, std::uint32_t table);
  std::shared_ptr<const OpenField> Open(const FieldKey& field);
  /// The payload of a brick, checked; nothing where there is none.
  Bytes Payload(const OpenField& open, std::int64_t brick);

  const OpenSeries& Series;
  std::uint32_t TablesPerStep = 0;
  std::mutex SegmentMutex;
  std::vector<std::unique_ptr<SegmentReader>> Segments;
  std::mutex TableMutex;
  std::list<Kept> Tables; ///< most recently used first
  std::atomic<std::uint64_t> Read{ 0 };
  std::atomic<std::uint64_t> Decoded{ 0 };
};

Reader1::Reader1(const OpenSeries& series)
  : Series(series)
  , TablesPerStep(series.Components * static_cast<std::uint32_t>(series.Index.Levels))
  , Segments(series.Index.Segments.size())
{
  for (std::size_t i = 0; i < std::min(this->Segments.size(), OpenedAtOnce); ++i)
  {
    (void)this->Segment(series.Index.Segments[i].FirstStep);
  }
}

const SegmentReader& Reader1::Segment(int step)
{
  const SegmentIndex& index = this->Series.Index.SegmentOf(step);
  const std::size_t number = static_cast<std::size_t>(&index - this->Series.Index.Segments.data());
  std::lock_guard<std::mutex> lock(this->SegmentMutex);
  std::unique_ptr<SegmentReader>& segment = this->Segments[number];
  if (!segment)
  {
    segment = std::make_unique<SegmentReader>(this->Series.Folder, index, this->TablesPerStep);
  }
  return *segment;
}

std::shared_ptr<const OpenField> Reader1::Load(const FieldKey& field, std::uint32_t table)
{
  const SegmentReader& segment = this->Segment(field.Step);
  return InFile(segment.Path(), 0,
    [&]
    {
      const segment::TableEntry entry = segment.Entry(table);
      auto open = std::make_shared<OpenField>();
      open->Segment = &segment;
      open->Layout = this->Series.Layouts[static_cast<std::size_t>(field.Level)];
      const ArrayIndex& array = this->Series.Index.Arrays[static_cast<std::size_t>(field.Array)];
      open->Type = array.Type;
      open->Lattice = QuantizerFromBits(array.Type, entry.QuantizerOrigin, entry.QuantizerStep);
      open->Table = segment.Table(entry, open->Layout, array.Type);
      TranslateMasks(
        open->Table, entry.Masks, this->Series.MaskRangeOf(field.Array, field.Component));
      this->Read += entry.StoredBytes;
      return std::shared_ptr<const OpenField>(open);
    });
}

std::shared_ptr<const OpenField> Reader1::Open(const FieldKey& field)
{
  const std::uint32_t inStep =
    this->Series.ComponentOf(field) * static_cast<std::uint32_t>(this->Series.Index.Levels) +
    static_cast<std::uint32_t>(field.Level);
  const std::uint64_t key = static_cast<std::uint64_t>(field.Step) * this->TablesPerStep + inStep;
  // Loading under the lock: threads that start on a new step together then load its table once.
  std::lock_guard<std::mutex> lock(this->TableMutex);
  const auto found = std::find_if(this->Tables.begin(), this->Tables.end(),
    [key](const Kept& kept) { return kept.first == key; });
  if (found != this->Tables.end())
  {
    this->Tables.splice(this->Tables.begin(), this->Tables, found);
    return this->Tables.front().second;
  }
  const std::uint32_t step =
    static_cast<std::uint32_t>(field.Step - this->Series.Index.SegmentOf(field.Step).FirstStep);
  this->Tables.emplace_front(key, this->Load(field, step * this->TablesPerStep + inStep));
  std::uint64_t bytes = 0;
  std::size_t count = 0;
  for (auto kept = this->Tables.begin(); kept != this->Tables.end();)
  {
    bytes += kept->second->Table.MemoryBytes();
    ++count;
    const bool keep = count <= 1 || (count <= KeptTables && bytes <= KeptTableBytes);
    kept = keep ? std::next(kept) : this->Tables.erase(kept);
  }
  return this->Tables.front().second;
}

Bytes Reader1::Payload(const OpenField& open, std::int64_t brick)
{
  const BrickNode& node = open.Table.Nodes[static_cast<std::size_t>(brick)];
  const PayloadReference& payload = open.Table.Payloads[static_cast<std::size_t>(brick)];
  if (node.Uniform)
  {
    return {};
  }
  Bytes bytes = open.Segment->Payload(payload, node.PayloadBytes);
  const glm::ivec3 samples = open.Layout.SamplesOf(brick).Size();
  const Hash128 hash =
    IdentityOf(payload.Mode, bytes.data(), bytes.size(), open.Lattice, open.Type, samples);
  this->Read += node.PayloadBytes;
  if (!(PayloadIdentity{ hash.Low, hash.High } == node.Identity))
  {
    throw Error(
      "The payload of brick " + std::to_string(brick) + " is damaged: its checksum does not fit",
      { open.Segment->Path(), payload.Offset });
  }
  return bytes;
}

std::shared_ptr<const std::vector<BrickNode>> Reader1::Nodes(const FieldKey& field)
{
  const std::shared_ptr<const OpenField> open = this->Open(field);
  return { open, &open->Table.Nodes };
}

void Reader1::DecodeBrick(const FieldKey& field, std::int64_t brick, void* values)
{
  const std::shared_ptr<const OpenField> open = this->Open(field);
  const BrickNode& node = open->Table.Nodes[static_cast<std::size_t>(brick)];
  const PayloadReference& payload = open->Table.Payloads[static_cast<std::size_t>(brick)];
  const Bytes bytes = this->Payload(*open, brick);
  InFile(open->Segment->Path(), payload.Offset,
    [&]
    {
      banyan::DecodeBrick(payload.Mode, bytes.data(), bytes.size(), open->Lattice, open->Type,
        open->Layout.SamplesOf(brick).Size(), node.Range.Low, values);
    });
  this->Decoded += node.Uniform ? 0 : 1;
}

void Reader1::VerifyBricks(const FieldKey& field, const std::vector<std::int64_t>& bricks)
{
  const std::shared_ptr<const OpenField> open = this->Open(field);
  for (const std::int64_t brick : bricks)
  {
    (void)this->Payload(*open, brick);
  }
}

} // namespace

std::unique_ptr<FieldReader> MakeFieldReader1(const OpenSeries& series)
{
  return std::make_unique<Reader1>(series);
}

} // namespace banyan
