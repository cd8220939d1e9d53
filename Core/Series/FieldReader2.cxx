#include "Base/Error.h"
#include "Series/Exceptions.h"
#include "Series/FieldReader.h"
#include "Series/GroupNodes.h"
#include "Series/GroupReader.h"
#include "Series/Hash.h"
#include "Series/LatticeDecoder.h"
#include "Series/NodeTable.h"
#include "Series/Quantizer.h"
#include "Series/TransformJson.h"

#include <algorithm>
#include <list>
#include <map>

namespace banyan
{
namespace
{

/// A component in a segment, with what turns its lattice numbers into values.
struct OpenGroup
{
  std::unique_ptr<GroupField> Field;
  ScalarType Type = ScalarType::Float32;
  std::shared_ptr<const void> Decoder; ///< LatticeDecoder of the type
  std::uint64_t Meaning = 0; ///< hash of what turns lattice numbers into values, and orders them
  std::mutex NodeMutex;
  /// By step of the segment and level.
  std::map<std::pair<int, int>, std::shared_ptr<const std::vector<BrickNode>>> Nodes;
  std::atomic<std::uint64_t> NodeBytes{ 0 };

  std::uint64_t MemoryBytes() const { return this->Field->MemoryBytes() + this->NodeBytes; }
};

template <class T>
const LatticeDecoder<T>& DecoderOf(const OpenGroup& open)
{
  return *static_cast<const LatticeDecoder<T>*>(open.Decoder.get());
}

class Reader2 : public FieldReader
{
public:
  explicit Reader2(const OpenSeries& series);
  ~Reader2() override { LatticeCache::Process().Forget(this->Series.Id); }

  std::shared_ptr<const std::vector<BrickNode>> Nodes(const FieldKey& field) override;
  void DecodeBrick(const FieldKey& field, std::int64_t brick, void* values) override;
  bool DecodePart(const FieldKey& field, std::int64_t brick, const Box& part,
    const glm::i64vec3& stride, void* first) override;
  void VerifyBricks(const FieldKey& field, const std::vector<std::int64_t>& bricks) override;
  std::uint64_t BytesRead() const override { return this->Read; }
  std::uint64_t BricksDecoded() const override { return this->Decoded; }

private:
  using Kept = std::pair<std::uint64_t, std::shared_ptr<OpenGroup>>;

  std::shared_ptr<GroupReader> Segment(int step);
  void Touch(const std::shared_ptr<GroupReader>& segment);
  std::shared_ptr<OpenGroup> Open(const FieldKey& field);
  std::vector<BrickNode> MakeNodes(OpenGroup& open, const FieldKey& field);
  BrickNode MakeNode(OpenGroup& open, const FieldKey& field, std::int64_t brick);
  PlaneRegion RegionOf(const OpenGroup& open, const FieldKey& field, std::int64_t brick) const;
  template <class T>
  void Decode(OpenGroup& open, const FieldKey& field, std::int64_t brick, T* values);
  template <class T>
  void DecodeBox(OpenGroup& open, int step, const PlaneRegion& region, const glm::ivec3& skip,
    const glm::ivec3& size, const glm::i64vec3& strides, T* values);

  const OpenSeries& Series;
  std::mutex SegmentMutex;
  std::vector<std::shared_ptr<GroupReader>> Segments;
  std::list<const GroupReader*> Recent; ///< most recently used first
  std::mutex OpenMutex;
  std::list<Kept> Opened; ///< most recently used first
  std::atomic<std::uint64_t> Read{ 0 };
  std::atomic<std::uint64_t> Decoded{ 0 };
};

Reader2::Reader2(const OpenSeries& series)
  : Series(series)
  , Segments(series.Index.Segments.size())
{
  for (std::size_t i = 0; i < std::min(this->Segments.size(), MappedAtOnce); ++i)
  {
    (void)this->Segment(series.Index.Segments[i].FirstStep);
  }
}

std::shared_ptr<GroupReader> Reader2::Segment(int step)
{
  const SegmentIndex& index = this->Series.Index.SegmentOf(step);
  const std::size_t number = static_cast<std::size_t>(&index - this->Series.Index.Segments.data());
  std::lock_guard<std::mutex> lock(this->SegmentMutex);
  std::shared_ptr<GroupReader>& segment = this->Segments[number];
  if (!segment)
  {
    segment =
      std::make_shared<GroupReader>(this->Series.Path + ".d", index, this->Series.Components);
  }
  return segment;
}

void Reader2::Touch(const std::shared_ptr<GroupReader>& segment)
{
  std::lock_guard<std::mutex> lock(this->SegmentMutex);
  if (!this->Recent.empty() && this->Recent.front() == segment.get())
  {
    return;
  }
  this->Recent.remove(segment.get());
  this->Recent.push_front(segment.get());
  if (this->Recent.size() > SegmentsInMemory)
  {
    this->Recent.back()->LetGo();
    this->Recent.pop_back();
  }
}

std::shared_ptr<OpenGroup> Reader2::Open(const FieldKey& field)
{
  const std::shared_ptr<GroupReader> segment = this->Segment(field.Step);
  this->Touch(segment);
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
  const ArrayIndex& array = this->Series.Index.Arrays[static_cast<std::size_t>(field.Array)];
  auto open = std::make_shared<OpenGroup>();
  open->Type = array.Type;
  const auto before = [this, key = FieldKey{ segment->FirstStep() - 1, field.Array,
                               field.Component, 0 }]
  {
    const std::shared_ptr<OpenGroup> opened = this->Open(key);
    return std::shared_ptr<GroupField>(opened, opened->Field.get());
  };
  InFile(segment->Path(), 0,
    [&]
    {
      open->Field = std::make_unique<GroupField>(*segment, this->Series.Id, component,
        this->Series.Index.Domain.Samples(), this->Series.Index.BrickCells, this->Series.Index.Levels,
        before);
    });
  const group::FieldHead& head = open->Field->Head();
  const Transform& map =
    array.Components[static_cast<std::size_t>(field.Component)].ValueTransform;
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      open->Decoder = std::make_shared<const LatticeDecoder<T>>(
        map, head.Origin, head.Step, head.Least, head.Greatest);
    });
  const std::string meaning = TransformToJson(map).dump() +
                              std::string(head.Axes.begin(), head.Axes.end());
  open->Meaning = ShortHashOf(meaning.data(), meaning.size());
  this->Opened.emplace_front(key, open);
  std::uint64_t bytes = 0;
  std::size_t count = 0;
  for (auto kept = this->Opened.begin(); kept != this->Opened.end();)
  {
    bytes += kept->second->MemoryBytes();
    ++count;
    // Of each component the segment at hand, the one before it, and one more; others as the budget
    // allows.
    const bool keep = count <= 3 * std::size_t{ this->Series.Components } ||
                      (count <= KeptTables * std::size_t{ this->Series.Components } &&
                        bytes <= std::min(KeptTableBytes, LatticeCache::Process().BudgetBytes() / 2));
    kept = keep ? std::next(kept) : this->Opened.erase(kept);
  }
  return open;
}

PlaneRegion Reader2::RegionOf(
  const OpenGroup& open, const FieldKey& field, std::int64_t brick) const
{
  return PlaneRegion(field.Level,
    this->Series.Layouts[static_cast<std::size_t>(field.Level)].SamplesOf(brick),
    open.Field->Head().Axes,
    open.Field->Planes()[static_cast<std::size_t>(field.Level / 2)], open.Field->Edge());
}

template <class Body>
void ForEachBlock(const PlaneRegion& region, Body&& body)
{
  for (int z = region.FirstBlock.z; z < region.EndBlock.z; ++z)
  {
    for (int y = region.FirstBlock.y; y < region.EndBlock.y; ++y)
    {
      for (int x = region.FirstBlock.x; x < region.EndBlock.x; ++x)
      {
        body(glm::ivec3{ x, y, z });
      }
    }
  }
}

const group::BlockEntry& EntryOf(
  GroupField& field, int step, const PlaneRegion& region, const glm::ivec3& block)
{
  const glm::ivec3 blocks = field.BlocksOf(region.Plane);
  return field.Step(step).Planes[static_cast<std::size_t>(region.Plane)]
    [(static_cast<std::size_t>(block.z) * static_cast<std::size_t>(blocks.y) +
       static_cast<std::size_t>(block.y)) *
        static_cast<std::size_t>(blocks.x) +
      static_cast<std::size_t>(block.x)];
}

BrickNode Reader2::MakeNode(OpenGroup& open, const FieldKey& field, std::int64_t brick)
{
  GroupField& group = *open.Field;
  const int step = field.Step - group.Segment().FirstStep();
  const auto entryAt = [&](int at) -> const group::NodeEntry&
  {
    return group.Step(at)
      .Levels[static_cast<std::size_t>(field.Level)][static_cast<std::size_t>(brick)];
  };
  const group::NodeEntry& entry = entryAt(step);
  BrickNode node;
  node.HasNonFinite = entry.HasNonFinite;
  node.Uniform = entry.Uniform;
  if (entry.Explicit)
  {
    node.Range = { entry.LowValue, entry.HighValue };
  }
  else if (!entry.NothingFinite)
  {
    Dispatch(open.Type,
      [&](auto tag)
      {
        using T = typename decltype(tag)::Type;
        const LatticeDecoder<T>& decoder = DecoderOf<T>(open);
        node.Range = { DoubleNotAbove(decoder.ValueOf(entry.Low)),
          DoubleNotBelow(decoder.ValueOf(entry.High)) };
      });
  }
  if (!node.Range.Empty())
  {
    const MaskRange masks = this->Series.MaskRangeOf(field.Array, field.Component);
    // Interpolants of samples that share faces lie in all bins between the extremes.
    node.Mask = MaskOfBins(masks.BinOf(node.Range.Low), masks.BinOf(node.Range.High));
  }
  const BrickLayout& layout = this->Series.Layouts[static_cast<std::size_t>(field.Level)];
  if (node.Uniform)
  {
    node.Identity =
      MacroVoxelIdentity(open.Type, layout.SamplesOf(brick).Size(), node.Range.Low);
    return node;
  }
  const int changed = step - static_cast<int>(entry.Age);
  const int last = group.Segment().Steps() - 1;
  // By its content where bricks of other segments may be the same.
  std::uint64_t shared = changed == 0 ? entryAt(0).Content : 0;
  if (shared == 0 && last - static_cast<int>(entryAt(last).Age) == changed)
  {
    shared = entryAt(last).Content;
  }
  const std::uint64_t seed[] = { std::uint64_t(field.Level), std::uint64_t(brick),
    std::uint64_t(changed), this->Series.ComponentOf(field), group.Segment().HeaderHash().Low,
    group.Segment().HeaderHash().High };
  const std::uint64_t content[] = { std::uint64_t(open.Type), open.Meaning, shared,
    BitCast<std::uint64_t>(node.Range.Low), BitCast<std::uint64_t>(node.Range.High),
    std::uint64_t(layout.SamplesOf(brick).Size().x), std::uint64_t(layout.SamplesOf(brick).Size().y),
    std::uint64_t(layout.SamplesOf(brick).Size().z) };
  const Hash128 hash = shared != 0 ? HashOf(content, sizeof(content)) : HashOf(seed, sizeof(seed));
  node.Identity = { hash.Low, hash.High };
  const PlaneRegion region = this->RegionOf(open, field, brick);
  if (region.Stride != 1)
  {
    return node; // part of the payloads of the level below
  }
  // The last bricks have what lies behind them as well.
  const glm::ivec3 position = layout.PositionOf(brick);
  glm::ivec3 own(1);
  for (int a = 0; a < 3; ++a)
  {
    const int real = group.Head().Axes[static_cast<std::size_t>(a)];
    own[a] = position[real] + 1 == layout.Bricks()[real] ? 2 : 1;
  }
  ForEachBlock(region,
    [&](const glm::ivec3& block)
    {
      const glm::ivec3 offset = block - region.FirstBlock;
      if (offset.x < own.x && offset.y < own.y && offset.z < own.z)
      {
        const group::BlockEntry& payload = EntryOf(group, step, region, block);
        node.PayloadBytes += payload.Payload.Bytes + payload.Exceptions.Bytes;
      }
    });
  return node;
}

std::vector<BrickNode> Reader2::MakeNodes(OpenGroup& open, const FieldKey& field)
{
  std::vector<BrickNode> nodes;
  const std::int64_t count =
    this->Series.Layouts[static_cast<std::size_t>(field.Level)].BrickCount();
  nodes.reserve(static_cast<std::size_t>(count));
  for (std::int64_t brick = 0; brick < count; ++brick)
  {
    nodes.push_back(this->MakeNode(open, field, brick));
  }
  return nodes;
}

std::shared_ptr<const std::vector<BrickNode>> Reader2::Nodes(const FieldKey& field)
{
  const std::shared_ptr<OpenGroup> open = this->Open(field);
  std::lock_guard<std::mutex> lock(open->NodeMutex);
  auto& nodes = open->Nodes[{ field.Step, field.Level }];
  if (!nodes)
  {
    InFile(open->Field->Segment().Path(), 0,
      [&]
      {
        nodes = std::make_shared<const std::vector<BrickNode>>(this->MakeNodes(*open, field));
      });
    open->NodeBytes += nodes->size() * sizeof(BrickNode);
    this->Read += open->Field->TakeBytesRead();
  }
  return nodes;
}

bool Exceptional(GroupField& group, int step, const PlaneRegion& region)
{
  bool exceptional = false;
  ForEachBlock(region, [&](const glm::ivec3& block)
    { exceptional = exceptional || EntryOf(group, step, region, block).Exceptions.Bytes > 0; });
  return exceptional;
}

/// Whether all samples of a region lie next to each other in the box of its first block.
bool InOneBox(const PlaneRegion& region, int edge)
{
  bool inside = region.Stride == 1;
  for (int a = 0; a < 3; ++a)
  {
    const int low = region.FirstBlock[a] * edge;
    inside = inside && region.Low[a] >= low &&
             region.Low[a] + region.Count[a] - 1 <= std::min(low + edge, region.Last[a]);
  }
  return inside;
}

/// The usual case of Decode: one box, no exceptions.
/// @param skip samples of the brick before the first one that is wanted, and @param size how many
/// are, axes as the data has them
template <class T>
void Reader2::DecodeBox(OpenGroup& open, int step, const PlaneRegion& region,
  const glm::ivec3& skip, const glm::ivec3& size, const glm::i64vec3& strides, T* values)
{
  GroupField& group = *open.Field;
  const LatticeDecoder<T>& decoder = DecoderOf<T>(open);
  const LatticeCache::Box box = group.Box(step, region.Plane, region.FirstBlock);
  const std::ptrdiff_t n = group.Edge() + 1;
  const std::ptrdiff_t pitch[3] = { 1, n, n * n };
  std::ptrdiff_t first = 0;
  std::ptrdiff_t stride[3] = {};
  for (int a = 0; a < 3; ++a)
  {
    const int real = group.Head().Axes[static_cast<std::size_t>(a)];
    stride[real] = pitch[a];
    first += (region.Low[a] - region.FirstBlock[a] * group.Edge() + skip[real]) * pitch[a];
  }
  box->Visit(
    [&](const auto* numbers, std::int32_t base)
    {
      for (int z = 0; z < size.z; ++z)
      {
        for (int y = 0; y < size.y; ++y)
        {
          decoder.Decode(numbers + first + z * stride[2] + y * stride[1], base, stride[0],
            static_cast<std::size_t>(size.x), values + z * strides.z + y * strides.y, strides.x);
        }
      }
    });
}

template <class T>
void Reader2::Decode(OpenGroup& open, const FieldKey& field, std::int64_t brick, T* values)
{
  GroupField& group = *open.Field;
  const int step = field.Step - group.Segment().FirstStep();
  const LatticeDecoder<T>& decoder = DecoderOf<T>(open);
  const PlaneRegion region = this->RegionOf(open, field, brick);
  const group::NodeEntry& entry = group.Step(step).Levels[static_cast<std::size_t>(
    field.Level)][static_cast<std::size_t>(brick)];
  const std::size_t count = static_cast<std::size_t>(region.Count.x) *
                            static_cast<std::size_t>(region.Count.y) *
                            static_cast<std::size_t>(region.Count.z);
  if (entry.Uniform)
  {
    std::fill(values, values + count,
      entry.Explicit ? ValueFromReal<T>(entry.LowValue) : decoder.ValueOf(entry.Low));
    return;
  }
  ++this->Decoded;
  const bool exceptional = Exceptional(group, step, region);
  if (!exceptional && InOneBox(region, group.Edge()))
  {
    const glm::ivec3 size = this->Series.Layouts[static_cast<std::size_t>(field.Level)]
                              .SamplesOf(brick).Size();
    return this->DecodeBox(
      open, step, region, glm::ivec3(0), size, { 1, size.x, std::int64_t{ size.x } * size.y }, values);
  }
  thread_local std::vector<std::int32_t> numbers;
  thread_local std::vector<std::uint32_t> offsets;
  thread_local std::vector<T> ordered;
  offsets.resize(count);
  ordered.resize(count);
  const int edge = group.Edge();
  const int n = edge + 1;
  const std::uint32_t least = static_cast<std::uint32_t>(group.Head().Least);
  ForEachBlock(region,
    [&](const glm::ivec3& block)
    {
      // Places of the region that this block's box holds and no earlier block's does.
      glm::ivec3 from(0), to(0);
      for (int a = 0; a < 3; ++a)
      {
        const int low = block[a] * edge + (block[a] > region.FirstBlock[a] ? 1 : 0);
        from[a] = std::max(0, (low - region.Low[a] + region.Stride - 1) / region.Stride);
        to[a] = region.Count[a] - 1;
        while (to[a] >= from[a] && region.SampleAt(a, to[a]) > block[a] * edge + edge)
        {
          --to[a];
        }
      }
      if (from.x > to.x || from.y > to.y || from.z > to.z)
      {
        return; // only the block after the last face: its samples are in the box before
      }
      numbers.resize(static_cast<std::size_t>(n) * n * n);
      group.Box(step, region.Plane, block)->CopyTo(numbers.data());
      const glm::ivec3 origin = block * edge;
      int columns[2 * 64 + 1]; // places per row: at most a brick of the largest edge
      for (int x = from.x; x <= to.x; ++x)
      {
        columns[x] = region.SampleAt(0, x) - origin.x;
      }
      for (int z = from.z; z <= to.z; ++z)
      {
        for (int y = from.y; y <= to.y; ++y)
        {
          const std::int32_t* row =
            numbers.data() +
            ((region.SampleAt(2, z) - origin.z) * n + region.SampleAt(1, y) - origin.y) * n;
          std::uint32_t* out =
            offsets.data() + (static_cast<std::size_t>(z) * region.Count.y + y) * region.Count.x;
          for (int x = from.x; x <= to.x; ++x)
          {
            out[x] = static_cast<std::uint32_t>(row[columns[x]]) - least;
          }
        }
      }
    });
  decoder.Decode(group.Head().Least, offsets.data(), count, ordered.data());
  if (exceptional)
  {
    const std::uint32_t whole = static_cast<std::uint32_t>(edge) * edge * edge;
    ForEachBlock(region,
      [&](const glm::ivec3& block)
      {
        const group::BlockEntry& payload = EntryOf(group, step, region, block);
        if (payload.Exceptions.Bytes > 0)
        {
          PlaceExceptions(region, edge, block,
            UnpackExceptions<T>(group.Segment().Payload(payload.Exceptions),
              payload.Exceptions.Bytes, whole),
            ordered.data());
        }
      });
  }
  // From the codec's order of axes to the data's; the values are written one after the other.
  const std::int64_t strides[3] = { 1, region.Count.x,
    std::int64_t{ region.Count.x } * region.Count.y };
  std::int64_t stride[3] = {};
  int size[3] = {};
  for (int a = 0; a < 3; ++a)
  {
    const std::size_t real = group.Head().Axes[static_cast<std::size_t>(a)];
    stride[real] = strides[a];
    size[real] = region.Count[a];
  }
  for (int z = 0; z < size[2]; ++z)
  {
    for (int y = 0; y < size[1]; ++y)
    {
      const T* from = ordered.data() + z * stride[2] + y * stride[1];
      for (int x = 0; x < size[0]; ++x)
      {
        values[x] = from[x * stride[0]];
      }
      values += size[0];
    }
  }
}

void Reader2::DecodeBrick(const FieldKey& field, std::int64_t brick, void* values)
{
  const std::shared_ptr<OpenGroup> open = this->Open(field);
  InFile(open->Field->Segment().Path(), 0,
    [&]
    {
      Dispatch(open->Type,
        [&](auto tag)
        {
          using T = typename decltype(tag)::Type;
          this->Decode<T>(*open, field, brick, static_cast<T*>(values));
        });
    });
  this->Read += open->Field->TakeBytesRead();
}

bool Reader2::DecodePart(const FieldKey& field, std::int64_t brick, const Box& part,
  const glm::i64vec3& stride, void* first)
{
  const std::shared_ptr<OpenGroup> open = this->Open(field);
  GroupField& group = *open->Field;
  const int step = field.Step - group.Segment().FirstStep();
  const PlaneRegion region = this->RegionOf(*open, field, brick);
  return InFile(group.Segment().Path(), 0,
    [&]
    {
      const group::NodeEntry& entry = group.Step(step).Levels[static_cast<std::size_t>(
        field.Level)][static_cast<std::size_t>(brick)];
      if (entry.Uniform || !InOneBox(region, group.Edge()) || Exceptional(group, step, region))
      {
        return false;
      }
      ++this->Decoded;
      const glm::ivec3 skip =
        part.Lo - this->Series.Layouts[static_cast<std::size_t>(field.Level)].SamplesOf(brick).Lo;
      Dispatch(open->Type,
        [&](auto tag)
        {
          using T = typename decltype(tag)::Type;
          this->DecodeBox<T>(
            *open, step, region, skip, part.Size(), stride, static_cast<T*>(first));
        });
      this->Read += group.TakeBytesRead();
      return true;
    });
}

void Reader2::VerifyBricks(const FieldKey& field, const std::vector<std::int64_t>& bricks)
{
  const std::shared_ptr<OpenGroup> open = this->Open(field);
  GroupField& group = *open->Field;
  const int step = field.Step - group.Segment().FirstStep();
  InFile(group.Segment().Path(), 0,
    [&]
    {
      for (const std::int64_t brick : bricks)
      {
        const PlaneRegion region = this->RegionOf(*open, field, brick);
        ForEachBlock(region,
          [&](const glm::ivec3& block) { group.Verify(step, region.Plane, block); });
      }
    });
}

} // namespace

std::unique_ptr<FieldReader> MakeFieldReader2(const OpenSeries& series)
{
  return std::make_unique<Reader2>(series);
}

} // namespace banyan
