#include "Series/SeriesFile.h"

#include "Base/Error.h"
#include "Series/AtomicFile.h"
#include "Series/IndexText.h"
#include "Series/SegmentReader.h"

#include <algorithm>
#include <atomic>
#include <list>
#include <mutex>

namespace banyan
{
namespace
{

std::atomic<std::uint64_t> NextId{ 1 };

// Segments are mapped when a series is opened, so that replacing the series does not take them away
// from readers; the kernel allows 65,530 mappings, so the rest of a very long series waits.
constexpr std::size_t MappedAtOnce = 16384;

// Mapped pages count as this process's memory once they are read: playing a long series must not
// collect all of them.
constexpr std::size_t SegmentsInMemory = 4;

constexpr std::size_t KeptTables = 64;
constexpr std::uint64_t KeptTableBytes = std::uint64_t{ 128 } << 20;

/// Runs `body`; an Error without a place gets the file and offset at hand.
template <class Body>
decltype(auto) InFile(const std::string& path, std::uint64_t offset, Body&& body)
{
  try
  {
    return body();
  }
  catch (const Error& failure)
  {
    if (!failure.Place().File.empty())
    {
      throw;
    }
    throw Error(failure.what(), { path, offset });
  }
}

} // namespace

/// A table together with what is needed to decode its bricks.
struct OpenField
{
  NodeTable Table;
  Quantizer Lattice;
  ScalarType Type = ScalarType::Float32;
  BrickLayout Layout;
  const SegmentReader* Segment = nullptr;
};

struct SeriesFile::Internals
{
  std::string Path;
  SeriesIndex Index;
  std::uint64_t Id = NextId++;
  std::vector<BrickLayout> Layouts;
  std::vector<std::uint32_t> FirstComponents; ///< number of components before each array
  std::uint32_t TablesPerStep = 0;

  mutable std::mutex SegmentMutex;
  mutable std::vector<std::unique_ptr<SegmentReader>> Segments;
  mutable std::list<const SegmentReader*> Recent; ///< most recently used first

  using Kept = std::pair<std::uint64_t, std::shared_ptr<const OpenField>>;
  mutable std::mutex TableMutex;
  mutable std::list<Kept> Tables; ///< most recently used first

  mutable std::atomic<std::uint64_t> BytesRead{ 0 };
  mutable std::atomic<std::uint64_t> BricksDecoded{ 0 };

  void Check(const FieldKey& field) const;
  const SegmentReader& Segment(int step) const;
  void Touch(const SegmentReader& segment) const;
  std::shared_ptr<const OpenField> Load(const FieldKey& field, std::uint32_t table) const;
  std::shared_ptr<const OpenField> Open(const FieldKey& field) const;
  void CheckBrick(const OpenField& open, std::int64_t brick) const;
  void CheckPayload(const OpenField& open, std::int64_t brick) const;
};

void SeriesFile::Internals::Check(const FieldKey& field) const
{
  (void)this->Index.SegmentOf(field.Step);
  if (field.Array < 0 || field.Array >= static_cast<int>(this->Index.Arrays.size()))
  {
    throw Error("The series has no array number " + std::to_string(field.Array), { this->Path });
  }
  const auto& components = this->Index.Arrays[static_cast<std::size_t>(field.Array)].Components;
  if (field.Component < 0 || field.Component >= static_cast<int>(components.size()))
  {
    throw Error("The array has no component " + std::to_string(field.Component), { this->Path });
  }
  if (field.Level < 0 || field.Level >= this->Index.Levels)
  {
    throw Error("The series has no level " + std::to_string(field.Level), { this->Path });
  }
}

const SegmentReader& SeriesFile::Internals::Segment(int step) const
{
  const SegmentIndex& index = this->Index.SegmentOf(step);
  const std::size_t number = static_cast<std::size_t>(&index - this->Index.Segments.data());
  std::lock_guard<std::mutex> lock(this->SegmentMutex);
  std::unique_ptr<SegmentReader>& segment = this->Segments[number];
  if (!segment)
  {
    segment = std::make_unique<SegmentReader>(this->Path + ".d", index, this->TablesPerStep);
  }
  return *segment;
}

void SeriesFile::Internals::Touch(const SegmentReader& segment) const
{
  std::lock_guard<std::mutex> lock(this->SegmentMutex);
  if (!this->Recent.empty() && this->Recent.front() == &segment)
  {
    return;
  }
  this->Recent.remove(&segment);
  this->Recent.push_front(&segment);
  if (this->Recent.size() > SegmentsInMemory)
  {
    this->Recent.back()->LetGo();
    this->Recent.pop_back();
  }
}

std::shared_ptr<const OpenField> SeriesFile::Internals::Load(
  const FieldKey& field, std::uint32_t table) const
{
  const SegmentReader& segment = this->Segment(field.Step);
  return InFile(segment.Path(), 0,
    [&]
    {
      const segment::TableEntry entry = segment.Entry(table);
      auto open = std::make_shared<OpenField>();
      open->Segment = &segment;
      open->Layout = this->Layouts[static_cast<std::size_t>(field.Level)];
      const ArrayIndex& array = this->Index.Arrays[static_cast<std::size_t>(field.Array)];
      open->Type = array.Type;
      open->Lattice = QuantizerFromBits(array.Type, entry.QuantizerOrigin, entry.QuantizerStep);
      open->Table = segment.Table(entry, open->Layout, array.Type);
      const ComponentIndex& component = array.Components[static_cast<std::size_t>(field.Component)];
      const ValueRange& range =
        component.PromisedRange.Empty() ? component.Range : component.PromisedRange;
      TranslateMasks(open->Table, entry.Masks,
        range.Empty() ? MaskRange{ 0, 0 } : MaskRange{ range.Low, range.High });
      this->BytesRead += entry.StoredBytes;
      return std::shared_ptr<const OpenField>(open);
    });
}

std::shared_ptr<const OpenField> SeriesFile::Internals::Open(const FieldKey& field) const
{
  this->Check(field);
  const std::uint32_t inStep = (this->FirstComponents[static_cast<std::size_t>(field.Array)] +
                                 static_cast<std::uint32_t>(field.Component)) *
                                 static_cast<std::uint32_t>(this->Index.Levels) +
                               static_cast<std::uint32_t>(field.Level);
  const std::uint64_t key = static_cast<std::uint64_t>(field.Step) * this->TablesPerStep + inStep;
  // Loading under the lock: threads that start on a new step together then load its table once.
  std::lock_guard<std::mutex> lock(this->TableMutex);
  const auto found = std::find_if(this->Tables.begin(), this->Tables.end(),
    [key](const Kept& kept) { return kept.first == key; });
  if (found != this->Tables.end())
  {
    this->Tables.splice(this->Tables.begin(), this->Tables, found);
    this->Touch(*this->Tables.front().second->Segment);
    return this->Tables.front().second;
  }
  const std::uint32_t step =
    static_cast<std::uint32_t>(field.Step - this->Index.SegmentOf(field.Step).FirstStep);
  this->Tables.emplace_front(key, this->Load(field, step * this->TablesPerStep + inStep));
  this->Touch(*this->Tables.front().second->Segment);
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

void SeriesFile::Internals::CheckBrick(const OpenField& open, std::int64_t brick) const
{
  if (brick < 0 || brick >= open.Layout.BrickCount())
  {
    throw Error("The level has no brick number " + std::to_string(brick), { this->Path });
  }
}

void SeriesFile::Internals::CheckPayload(const OpenField& open, std::int64_t brick) const
{
  const BrickNode& node = open.Table.Nodes[static_cast<std::size_t>(brick)];
  const PayloadReference& payload = open.Table.Payloads[static_cast<std::size_t>(brick)];
  if (node.Uniform)
  {
    return;
  }
  const glm::ivec3 samples = open.Layout.SamplesOf(brick).Size();
  const Hash128 hash = IdentityOf(payload.Mode, open.Segment->Payload(payload), node.PayloadBytes,
    open.Lattice, open.Type, samples);
  this->BytesRead += node.PayloadBytes;
  if (!(PayloadIdentity{ hash.Low, hash.High } == node.Identity))
  {
    throw Error(
      "The payload of brick " + std::to_string(brick) + " is damaged: its checksum does not fit",
      { open.Segment->Path(), payload.Offset });
  }
}

SeriesFile::SeriesFile()
  : Self(std::make_unique<Internals>())
{
}

SeriesFile::~SeriesFile() = default;

std::shared_ptr<SeriesFile> SeriesFile::Open(const std::string& path)
{
  std::shared_ptr<SeriesFile> file(new SeriesFile);
  Internals& self = *file->Self;
  self.Path = path;
  self.Index = IndexFromText(ReadWholeFile(path, GreatestIndexBytes), path);
  for (int level = 0; level < self.Index.Levels; ++level)
  {
    self.Layouts.emplace_back(self.Index.Domain.Samples(), self.Index.BrickCells, level);
  }
  std::uint32_t components = 0;
  for (const ArrayIndex& array : self.Index.Arrays)
  {
    self.FirstComponents.push_back(components);
    components += static_cast<std::uint32_t>(array.Components.size());
  }
  self.TablesPerStep = components * static_cast<std::uint32_t>(self.Index.Levels);
  self.Segments.resize(self.Index.Segments.size());
  for (std::size_t i = 0; i < std::min(self.Segments.size(), MappedAtOnce); ++i)
  {
    (void)self.Segment(self.Index.Segments[i].FirstStep);
  }
  return file;
}

const std::string& SeriesFile::Path() const
{
  return this->Self->Path;
}

const SeriesIndex& SeriesFile::Index() const
{
  return this->Self->Index;
}

std::uint64_t SeriesFile::Id() const
{
  return this->Self->Id;
}

BrickLayout SeriesFile::Layout(int level) const
{
  if (level < 0 || level >= this->Self->Index.Levels)
  {
    throw Error("The series has no level " + std::to_string(level), { this->Self->Path });
  }
  return this->Self->Layouts[static_cast<std::size_t>(level)];
}

MaskRange SeriesFile::MaskRangeOf(int array, int component) const
{
  this->Self->Check({ 0, array, component, 0 });
  const ComponentIndex& index = this->Self->Index.Arrays[static_cast<std::size_t>(array)]
                                  .Components[static_cast<std::size_t>(component)];
  const ValueRange& range = index.PromisedRange.Empty() ? index.Range : index.PromisedRange;
  return range.Empty() ? MaskRange{ 0, 0 } : MaskRange{ range.Low, range.High };
}

std::shared_ptr<const std::vector<BrickNode>> SeriesFile::Nodes(const FieldKey& field) const
{
  const std::shared_ptr<const OpenField> open = this->Self->Open(field);
  return { open, &open->Table.Nodes };
}

void SeriesFile::DecodeBrick(const FieldKey& field, std::int64_t brick, void* values) const
{
  const std::shared_ptr<const OpenField> open = this->Self->Open(field);
  this->Self->CheckBrick(*open, brick);
  const BrickNode& node = open->Table.Nodes[static_cast<std::size_t>(brick)];
  const PayloadReference& payload = open->Table.Payloads[static_cast<std::size_t>(brick)];
  this->Self->CheckPayload(*open, brick);
  InFile(open->Segment->Path(), payload.Offset,
    [&]
    {
      banyan::DecodeBrick(payload.Mode, open->Segment->Payload(payload), node.PayloadBytes,
        open->Lattice, open->Type, open->Layout.SamplesOf(brick).Size(), node.Range.Low, values);
    });
  this->Self->BricksDecoded += node.Uniform ? 0 : 1;
}

void SeriesFile::VerifyBricks(const FieldKey& field, const std::vector<std::int64_t>& bricks) const
{
  const std::shared_ptr<const OpenField> open = this->Self->Open(field);
  for (const std::int64_t brick : bricks)
  {
    this->Self->CheckBrick(*open, brick);
    this->Self->CheckPayload(*open, brick);
  }
}

std::uint64_t SeriesFile::BytesRead() const
{
  return this->Self->BytesRead;
}

std::uint64_t SeriesFile::BricksDecoded() const
{
  return this->Self->BricksDecoded;
}

} // namespace banyan
