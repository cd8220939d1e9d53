// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/BrickDecoding.h"

#include "Codec/BlockScratch.h"
#include "Codec/DecodeStages.h"
#include "Series/Format/Exceptions.h"
#include "Series/Quantize/ValueArithmetic.h"

#include <algorithm>

namespace banyan
{
namespace
{

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

/// Where the numbers of a region lie in the box of its block.
struct BoxPlace
{
  std::ptrdiff_t First = 0; ///< of the region
  glm::i64vec3 Stride{ 0 }; ///< axes as the data has them

  /// @param skip samples of the region before the first one that is wanted, axes as the data has
  /// them
  BoxPlace(const GroupField& group, const PlaneRegion& region, const glm::ivec3& skip)
  {
    const std::ptrdiff_t n = group.Edge() + 1;
    const std::ptrdiff_t pitch[3] = { 1, n, n * n };
    for (int a = 0; a < 3; ++a)
    {
      const int real = group.Head().Axes[static_cast<std::size_t>(a)];
      this->Stride[real] = pitch[a];
      this->First += (region.Low[a] - region.FirstBlock[a] * group.Edge() + skip[real]) * pitch[a];
    }
  }
};

/// Numbers of a box in the data's order of axes: as they lie, or in memory that is given.
/// @param stride receives how they lie
template <class Number>
const Number* InOrder(
  const Number* numbers, glm::i64vec3& stride, const glm::ivec3& size, std::vector<Number>& memory)
{
  if (stride.x == 1)
  {
    return numbers;
  }
  const stages::In stage(stages::Order);
  memory.resize(static_cast<std::size_t>(size.x) * size.y * size.z);
  TransposeBox(numbers, stride, size, memory.data());
  stride = { 1, size.x, std::int64_t{ size.x } * size.y };
  return memory.data();
}

/// The usual case of Decode: one box, no exceptions.
/// @param skip samples of the brick before the first one that is wanted, and @param size how many
/// are, axes as the data has them
template <class T>
void DecodeBox(OpenGroup& open, int step, const PlaneRegion& region, const glm::ivec3& skip,
  const glm::ivec3& size, const glm::i64vec3& strides, T* values)
{
  GroupField& group = *open.Field;
  // The first rows to be written; they ask for those behind.
  for (int y = 0; y < size.y; ++y)
  {
    __builtin_prefetch(values + y * strides.y, 1);
    __builtin_prefetch(values + strides.z + y * strides.y, 1);
  }
  const QuantizedBlockCache::Box box = group.Box(step, region.Plane, region.FirstBlock);
  BoxPlace place(group, region, skip);
  box->Visit(
    [&](const auto* all)
    {
      using Number = std::remove_cv_t<std::remove_reference_t<decltype(*all)>>;
      thread_local std::vector<Number> ordered;
      const Number* const numbers = InOrder(all + place.First, place.Stride, size, ordered);
      const stages::In stage(stages::Values);
      DecoderOf<T>(open).Decode(numbers, place.Stride, size, values, strides);
    });
}

/// Bricks of a row whose numbers are kept until their values are written: they fit into a
/// second-level cache.
constexpr int LongestRow = 8;

/// Says what is wanted of a brick of a row.
struct RowBrick
{
  PlaneRegion Region;
  glm::ivec3 Skip; ///< samples of the brick before the first one that is wanted
  glm::ivec3 Size;
};

/// DecodeBox of some bricks that follow each other along x. Their values are written row by row of
/// all of them: long rows take less time than several short ones.
/// @param count 1 to LongestRow
template <class T, class Number>
void DecodeBoxes(OpenGroup& open, int step, const RowBrick* bricks, int count,
  const glm::i64vec3& strides, T* values)
{
  thread_local std::vector<Number> ordered[LongestRow];
  QuantizedBlockCache::Box boxes[LongestRow];
  LatticePart<Number> parts[LongestRow];
  // The last one first: a block then finds the layers that it shares with others decoded.
  for (int k = count - 1; k >= 0; --k)
  {
    const PlaneRegion& region = bricks[k].Region;
    if (k > 0)
    {
      open.Field->Prefetch(step, bricks[k - 1].Region.Plane, bricks[k - 1].Region.FirstBlock);
    }
    boxes[k] = open.Field->Box(step, region.Plane, region.FirstBlock, true);
    BoxPlace place(*open.Field, region, bricks[k].Skip);
    const Number* const numbers = InOrder(
      boxes[k]->template Numbers<Number>() + place.First, place.Stride, bricks[k].Size, ordered[k]);
    parts[k] = { numbers, place.Stride.y, place.Stride.z, bricks[k].Size.x };
  }
  const stages::In stage(stages::Values);
  DecoderOf<T>(open).DecodeParts(parts, count, bricks[0].Size.y, bricks[0].Size.z, values, strides);
}

/// The places of a region that the box of a block holds, and no earlier block's box does.
Box PlacesOf(const PlaneRegion& region, int edge, const glm::ivec3& block)
{
  Box places;
  for (int a = 0; a < 3; ++a)
  {
    const int low = block[a] * edge + (block[a] > region.FirstBlock[a] ? 1 : 0);
    places.Lo[a] = std::max(0, (low - region.Low[a] + region.Stride - 1) / region.Stride);
    places.Hi[a] = region.Count[a];
    while (
      places.Hi[a] > places.Lo[a] && region.SampleAt(a, places.Hi[a] - 1) > block[a] * edge + edge)
    {
      --places.Hi[a];
    }
  }
  return places;
}

/// Copies lattice numbers, less the least one, from the box of a block to the region.
/// @param offsets of the region
template <class Number>
void GatherBlock(const PlaneRegion& region, int edge, const glm::ivec3& block, const Box& places,
  const Number* numbers, std::uint32_t least, std::uint32_t* offsets)
{
  const int n = edge + 1;
  const glm::ivec3 origin = block * edge;
  int columns[2 * 32 + 1]; // places per row: at most a brick of the largest edge
  for (int x = places.Lo.x; x < places.Hi.x; ++x)
  {
    columns[x] = region.SampleAt(0, x) - origin.x;
  }
  for (int z = places.Lo.z; z < places.Hi.z; ++z)
  {
    for (int y = places.Lo.y; y < places.Hi.y; ++y)
    {
      const Number* row =
        numbers + ((region.SampleAt(2, z) - origin.z) * n + region.SampleAt(1, y) - origin.y) * n;
      std::uint32_t* out =
        offsets + (static_cast<std::size_t>(z) * region.Count.y + y) * region.Count.x;
      for (int x = places.Lo.x; x < places.Hi.x; ++x)
      {
        out[x] = static_cast<std::uint32_t>(row[columns[x]]) - least;
      }
    }
  }
}

/// Lattice numbers of a region, less the least one, in the codec's order.
void GatherRegion(GroupField& group, int step, const PlaneRegion& region, std::uint32_t* offsets)
{
  const int edge = group.Edge();
  const auto least = static_cast<std::uint32_t>(group.Head().Least);
  ForEachBlock(region,
    [&](const glm::ivec3& block)
    {
      const Box places = PlacesOf(region, edge, block);
      if (places.Empty())
      {
        return; // only the block after the last face: its samples are in the box before
      }
      group.Box(step, region.Plane, block)
        ->Visit([&](const auto* numbers)
          { GatherBlock(region, edge, block, places, numbers, least, offsets); });
    });
}

template <class T>
void ReplaceExceptions(GroupField& group, int step, const PlaneRegion& region, T* values)
{
  const int edge = group.Edge();
  const std::uint32_t whole = static_cast<std::uint32_t>(edge) * edge * edge;
  PayloadPages& payloads = group.Segment().Payloads();
  const PayloadPages::Hold hold = payloads.InMemory();
  ForEachBlock(region,
    [&](const glm::ivec3& block)
    {
      const group::Place& place = EntryOf(group, step, region, block).Exceptions;
      if (place.Bytes > 0)
      {
        PlaceExceptions(region, edge, block,
          UnpackExceptions<T>(payloads.At(hold, place.Offset, place.Bytes), place.Bytes, whole),
          values);
      }
    });
}

/// From the codec's order of axes to the data's; the values are written one after the other.
template <class T>
void CopyInDataOrder(
  const GroupField& group, const PlaneRegion& region, const T* ordered, T* values)
{
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
      const T* from = ordered + z * stride[2] + y * stride[1];
      for (int x = 0; x < size[0]; ++x)
      {
        values[x] = from[x * stride[0]];
      }
      values += size[0];
    }
  }
}

/// @return false when there was nothing to decode: all samples are one value
template <class T>
bool Decode(
  const OpenSeries& series, OpenGroup& open, const FieldKey& field, std::int64_t brick, T* values)
{
  GroupField& group = *open.Field;
  const int step = field.Step - group.Segment().FirstStep();
  const LatticeDecoder<T>& decoder = DecoderOf<T>(open);
  const PlaneRegion region = RegionOf(series, open, field, brick);
  const group::NodeEntry& entry =
    group.Step(step).Levels[static_cast<std::size_t>(field.Level)][static_cast<std::size_t>(brick)];
  const std::size_t count = static_cast<std::size_t>(region.Count.x) *
                            static_cast<std::size_t>(region.Count.y) *
                            static_cast<std::size_t>(region.Count.z);
  if (entry.Uniform)
  {
    std::fill(values, values + count,
      entry.Explicit ? ValueFromReal<T>(entry.LowValue) : decoder.ValueOf(entry.Low));
    return false;
  }
  const bool exceptional = Exceptional(group, step, region);
  if (!exceptional && InOneBox(region, group.Edge()))
  {
    const glm::ivec3 size =
      series.Layouts[static_cast<std::size_t>(field.Level)].SamplesOf(brick).Size();
    DecodeBox(open, step, region, glm::ivec3(0), size,
      { 1, size.x, std::int64_t{ size.x } * size.y }, values);
    return true;
  }
  thread_local std::vector<std::uint32_t> offsets;
  thread_local std::vector<T> ordered;
  offsets.resize(count);
  ordered.resize(count);
  GatherRegion(group, step, region, offsets.data());
  decoder.Decode(group.Head().Least, offsets.data(), count, ordered.data());
  if (exceptional)
  {
    ReplaceExceptions(group, step, region, ordered.data());
  }
  CopyInDataOrder(group, region, ordered.data(), values);
  return true;
}

} // namespace

bool DecodeWhole(const OpenSeries& series, OpenGroup& open, const FieldKey& field,
  std::int64_t brick, void* values)
{
  bool decoded = false;
  Dispatch(open.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      decoded = Decode<T>(series, open, field, brick, static_cast<T*>(values));
    });
  return decoded;
}

bool DecodePart(const OpenSeries& series, OpenGroup& open, const FieldKey& field,
  std::int64_t brick, const Box& part, const glm::i64vec3& stride, void* first)
{
  GroupField& group = *open.Field;
  const int step = field.Step - group.Segment().FirstStep();
  const PlaneRegion region = RegionOf(series, open, field, brick);
  const std::size_t level = static_cast<std::size_t>(field.Level);
  const group::NodeEntry& entry = group.Step(step).Levels[level][static_cast<std::size_t>(brick)];
  if (entry.Uniform || !InOneBox(region, group.Edge()) || Exceptional(group, step, region))
  {
    return false;
  }
  const glm::ivec3 skip = part.Lo - series.Layouts[level].SamplesOf(brick).Lo;
  Dispatch(open.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      DecodeBox<T>(open, step, region, skip, part.Size(), stride, static_cast<T*>(first));
    });
  return true;
}

bool DecodeSomeRow(const OpenSeries& series, OpenGroup& open, const FieldKey& field,
  const BrickRow& row, const Box& part, const glm::i64vec3& stride, void* first)
{
  GroupField& group = *open.Field;
  const int step = field.Step - group.Segment().FirstStep();
  const std::size_t level = static_cast<std::size_t>(field.Level);
  const std::vector<group::NodeEntry>& entries = group.Step(step).Levels[level];
  thread_local std::vector<RowBrick> bricks;
  bricks.clear();
  for (int k = 0; k < row.Count; ++k)
  {
    const std::int64_t brick = row.First + k;
    const PlaneRegion region = RegionOf(series, open, field, brick);
    if (entries[static_cast<std::size_t>(brick)].Uniform || !InOneBox(region, group.Edge()) ||
        Exceptional(group, step, region))
    {
      return false;
    }
    const Box own = RowPart(series.Layouts[level], row.First, row.Count, k, part);
    bricks.push_back({ region, own.Lo - series.Layouts[level].SamplesOf(brick).Lo, own.Size() });
  }
  Dispatch(open.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      T* values = static_cast<T*>(first) + (part.Size().x) * stride.x;
      for (int end = row.Count; end > 0; end -= LongestRow)
      {
        const int begin = std::max(0, end - LongestRow);
        for (int k = begin; k < end; ++k)
        {
          values -= bricks[static_cast<std::size_t>(k)].Size.x * stride.x;
        }
        const RowBrick* const some = bricks.data() + begin;
        if (block::Narrow(group.Head().Least, group.Head().Greatest))
        {
          DecodeBoxes<T, std::int16_t>(open, step, some, end - begin, stride, values);
        }
        else
        {
          DecodeBoxes<T, std::int32_t>(open, step, some, end - begin, stride, values);
        }
      }
    });
  return true;
}

} // namespace banyan
