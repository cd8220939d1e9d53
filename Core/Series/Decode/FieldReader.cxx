// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/FieldReader.h"

#include "Base/Error.h"
#include "Base/Hash.h"
#include "Codec/DecodeStages.h"
#include "Series/Decode/BrickDecoding.h"
#include "Series/Format/TransformJson.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Segments that are looked at when a series is opened: the rest of a very long one waits.
constexpr std::size_t OpenedAtOnce = 16384;

constexpr std::size_t KeptTables = 64;
constexpr std::uint64_t KeptTableBytes = std::uint64_t{ 128 } << 20;

} // namespace

FieldReader::FieldReader(const OpenSeries& series)
  : Series(series)
  , Segments(series.Index.Segments.size())
{
  for (std::size_t i = 0; i < std::min(this->Segments.size(), OpenedAtOnce); ++i)
  {
    (void)this->Segment(series.Index.Segments[i].FirstStep);
  }
}

FieldReader::~FieldReader()
{
  this->Series.Caches->Blocks().Forget(this->Series.Id);
}

std::shared_ptr<GroupReader> FieldReader::Segment(int step)
{
  const SegmentIndex& index = this->Series.Index.SegmentOf(step);
  const std::size_t number = static_cast<std::size_t>(&index - this->Series.Index.Segments.data());
  std::lock_guard<std::mutex> lock(this->SegmentMutex);
  std::shared_ptr<GroupReader>& segment = this->Segments[number];
  if (!segment)
  {
    std::shared_ptr<const SegmentFile>& file = this->Files[index.File];
    if (!file)
    {
      file = std::make_shared<const SegmentFile>(this->Series.Folder, index);
    }
    segment =
      std::make_shared<GroupReader>(file, index, this->Series.Components, *this->Series.Caches);
  }
  return segment;
}

FieldKey FieldReader::Stored(FieldKey field)
{
  const std::uint32_t component = this->Series.ComponentOf(field);
  std::vector<std::uint64_t> passed;
  for (bool known = false; !known;)
  {
    const std::shared_ptr<GroupReader> segment = this->Segment(field.Step);
    const std::uint64_t key =
      static_cast<std::uint64_t>(segment->FirstStep()) * this->Series.Components + component;
    {
      std::lock_guard<std::mutex> lock(this->StaticMutex);
      const auto found = this->StaticFields.find(key);
      if (found != this->StaticFields.end())
      {
        field.Step = found->second < 0 ? field.Step : found->second;
        break;
      }
    }
    known = !WithErrorPlace(segment->Path(), 0,
      [&]
      {
        const bool rests = group::IsStatic(segment->Section(segment->HeadSection(component)));
        if (rests && segment->FirstStep() == 0)
        {
          throw Error("The first segment of a series says that a field is as in the one before it");
        }
        return rests;
      });
    if (known)
    {
      std::lock_guard<std::mutex> lock(this->StaticMutex);
      this->StaticFields.emplace(key, -1);
    }
    else
    {
      passed.push_back(key);
      field.Step = segment->FirstStep() - 1;
    }
  }
  std::lock_guard<std::mutex> lock(this->StaticMutex);
  for (const std::uint64_t key : passed)
  {
    this->StaticFields.emplace(key, field.Step);
  }
  return field;
}

Hash128 FieldReader::HashBefore(const FieldKey& last)
{
  try
  {
    return this->Segment(this->Stored(last).Step)->HeaderHash();
  }
  catch (const Error&)
  {
    // Whoever reads it will be told what is wrong with it; others do not need it.
    return this->Segment(last.Step)->HeaderHash();
  }
}

std::shared_ptr<OpenGroup> FieldReader::Open(const FieldKey& field)
{
  const std::shared_ptr<GroupReader> segment = this->Segment(field.Step);
  const std::uint32_t component = this->Series.ComponentOf(field);
  const std::uint64_t key =
    static_cast<std::uint64_t>(segment->FirstStep()) * this->Series.Components + component;
  std::lock_guard<std::mutex> lock(this->OpenMutex);
  const auto found = std::find_if(this->Opened.begin(), this->Opened.end(),
    [key](const Kept& kept) { return kept.first == key; });
  if (found != this->Opened.end())
  {
    this->Opened.splice(this->Opened.begin(), this->Opened, found);
    return this->Opened.front().second;
  }
  std::shared_ptr<OpenGroup> open = this->MakeGroup(field, segment, component);
  this->Opened.emplace_front(key, open);
  this->ForgetOldGroups();
  return open;
}

std::shared_ptr<OpenGroup> FieldReader::MakeGroup(
  const FieldKey& field, const std::shared_ptr<GroupReader>& segment, std::uint32_t component)
{
  const stages::In stage(stages::Tables);
  const ArrayIndex& array = this->Series.Index.Arrays[static_cast<std::size_t>(field.Array)];
  auto open = std::make_shared<OpenGroup>();
  open->Type = array.Type;
  const auto before =
    [this, key = FieldKey{ segment->FirstStep() - 1, field.Array, field.Component, 0 }]
  {
    const std::shared_ptr<OpenGroup> opened = this->Open(this->Stored(key));
    return std::shared_ptr<GroupField>(opened, opened->Field.get());
  };
  WithErrorPlace(segment->Path(), 0,
    [&]
    {
      open->Field = std::make_unique<GroupField>(*segment, this->Series.Id, component,
        this->Series.Index.Domain.Samples(), this->Series.Index.BrickCells,
        this->Series.Index.Levels, before);
    });
  const group::FieldHead& head = open->Field->Head();
  if (head.Open)
  {
    open->Before = this->HashBefore({ segment->FirstStep() - 1, field.Array, field.Component, 0 });
  }
  const Transform& map = array.Components[static_cast<std::size_t>(field.Component)].ValueTransform;
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      open->Decoder = std::make_shared<const LatticeDecoder<T>>(
        map, head.Origin, head.Step, head.Least, head.Greatest);
    });
  const std::string meaning =
    TransformToJson(map).dump() + std::string(head.Axes.begin(), head.Axes.end());
  open->DecodingHash = ShortHashOf(meaning.data(), meaning.size());
  return open;
}

void FieldReader::ForgetOldGroups()
{
  std::uint64_t bytes = 0;
  std::size_t count = 0;
  for (auto kept = this->Opened.begin(); kept != this->Opened.end();)
  {
    bytes += kept->second->MemoryBytes();
    ++count;
    // Each component keeps the segment at hand and the one before it; others stay as the budget
    // allows: the tables of a segment take more than a megabyte.
    const bool keep =
      count <= 2 * std::size_t{ this->Series.Components } ||
      (count <= KeptTables * std::size_t{ this->Series.Components } &&
        bytes <= std::min(KeptTableBytes, this->Series.Caches->Blocks().BudgetBytes() / 2));
    kept = keep ? std::next(kept) : this->Opened.erase(kept);
  }
}

std::shared_ptr<const std::vector<BrickNode>> FieldReader::Nodes(const FieldKey& asked)
{
  const FieldKey field = this->Stored(asked);
  const std::shared_ptr<OpenGroup> open = this->Open(field);
  std::lock_guard<std::mutex> lock(open->NodeMutex);
  // Where a field rests, nodes are what they were, but nothing is stored for them.
  const bool rests = field.Step != asked.Step;
  const stages::In stage(stages::Tables);
  auto& nodes = open->Nodes[{ rests ? -1 - field.Step : field.Step, field.Level }];
  if (!nodes)
  {
    WithErrorPlace(open->Field->Segment().Path(), 0,
      [&]
      {
        std::vector<BrickNode> made = NodesOf(this->Series, *open, field);
        for (BrickNode& node : made)
        {
          node.PayloadBytes = rests ? 0 : node.PayloadBytes;
        }
        nodes = std::make_shared<const std::vector<BrickNode>>(std::move(made));
      });
    open->NodeBytes += nodes->size() * sizeof(BrickNode);
    this->Read += open->Field->TakeBytesRead();
  }
  return nodes;
}

void FieldReader::DecodeBrick(const FieldKey& asked, std::int64_t brick, void* values)
{
  const FieldKey field = this->Stored(asked);
  const std::shared_ptr<OpenGroup> open = this->Open(field);
  WithErrorPlace(open->Field->Segment().Path(), 0,
    [&] { this->Decoded += DecodeWhole(this->Series, *open, field, brick, values) ? 1 : 0; });
  this->Read += open->Field->TakeBytesRead();
}

bool FieldReader::DecodePart(const FieldKey& asked, std::int64_t brick, const Box& part,
  const glm::i64vec3& stride, void* first)
{
  const FieldKey field = this->Stored(asked);
  const std::shared_ptr<OpenGroup> open = this->Open(field);
  const bool done = WithErrorPlace(open->Field->Segment().Path(), 0,
    [&] { return banyan::DecodePart(this->Series, *open, field, brick, part, stride, first); });
  this->Decoded += done ? 1 : 0;
  this->Read += open->Field->TakeBytesRead();
  return done;
}

bool FieldReader::DecodeRow(const FieldKey& asked, std::int64_t brick, int count, const Box& part,
  const glm::i64vec3& stride, void* first)
{
  const FieldKey field = this->Stored(asked);
  const std::shared_ptr<OpenGroup> open = this->Open(field);
  const bool done = WithErrorPlace(open->Field->Segment().Path(), 0,
    [&] {
      return DecodeSomeRow(this->Series, *open, field, { brick, count }, part, stride, first);
    });
  this->Decoded += done ? static_cast<std::uint64_t>(count) : 0;
  this->Read += open->Field->TakeBytesRead();
  return done;
}

double FieldReader::StepOfValues(const FieldKey& field)
{
  const ArrayIndex& array = this->Series.Index.Arrays[static_cast<std::size_t>(field.Array)];
  const group::FieldHead& head = this->Open(this->Stored(field))->Field->Head();
  const bool plain =
    array.Components[static_cast<std::size_t>(field.Component)].ValueTransform.IsIdentity();
  return plain && !head.Exact ? head.Step : 0.0;
}

void FieldReader::VerifyBricks(const FieldKey& asked, const std::vector<std::int64_t>& bricks)
{
  const FieldKey field = this->Stored(asked);
  const std::shared_ptr<OpenGroup> open = this->Open(field);
  GroupField& group = *open->Field;
  const int step = field.Step - group.Segment().FirstStep();
  WithErrorPlace(group.Segment().Path(), 0,
    [&]
    {
      for (const std::int64_t brick : bricks)
      {
        const PlaneRegion region = RegionOf(this->Series, *open, field, brick);
        ForEachBlock(
          region, [&](const glm::ivec3& block) { group.Verify(step, region.Plane, block); });
        const BrickLayout& layout = this->Series.Layouts[static_cast<std::size_t>(field.Level)];
        const glm::ivec3 behind = layout.Bricks() - layout.PositionOf(brick) - 1;
        if (behind.x * behind.y * behind.z == 0 && open->EndsToCheck > 0 && open->EndsToCheck-- > 0)
        {
          (void)group.Box(step, region.Plane, region.FirstBlock, true);
        }
      }
    });
}

} // namespace banyan
