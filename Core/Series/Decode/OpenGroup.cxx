// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Decode/OpenGroup.h"

#include "Base/Hash.h"
#include "Series/Quantize/ValueArithmetic.h"

namespace banyan
{
namespace
{

PayloadIdentity MacroVoxelIdentity(ScalarType type, const glm::ivec3& samples, double value)
{
  std::uint8_t context[32] = { 0, static_cast<std::uint8_t>(type) };
  StoreNumber(context + 4, std::int32_t{ samples.x });
  StoreNumber(context + 8, std::int32_t{ samples.y });
  StoreNumber(context + 12, std::int32_t{ samples.z });
  const Hash128 hash = HashOf(&value, sizeof(value), ShortHashOf(context, sizeof(context)));
  return { hash.Low, hash.High };
}

const group::NodeEntry& EntryAt(
  GroupField& group, const FieldKey& field, std::int64_t brick, int step)
{
  return group.Step(step)
    .Levels[static_cast<std::size_t>(field.Level)][static_cast<std::size_t>(brick)];
}

/// Returns the range of the finite samples; empty where there is none.
ValueRange RangeOf(const OpenGroup& open, const group::NodeEntry& entry)
{
  if (entry.Explicit)
  {
    return { entry.LowValue, entry.HighValue };
  }
  ValueRange range;
  if (!entry.NothingFinite)
  {
    Dispatch(open.Type,
      [&](auto tag)
      {
        using T = typename decltype(tag)::Type;
        const LatticeDecoder<T>& decoder = DecoderOf<T>(open);
        range = { DoubleNotAbove(decoder.ValueOf(entry.Low)),
          DoubleNotBelow(decoder.ValueOf(entry.High)) };
      });
  }
  return range;
}

/// Identifies a brick that is not uniform: by its content where bricks of other segments may be the
/// same.
PayloadIdentity IdentityOf(const OpenSeries& series, OpenGroup& open, const FieldKey& field,
  std::int64_t brick, const ValueRange& range)
{
  GroupField& group = *open.Field;
  const int step = field.Step - group.Segment().FirstStep();
  const int changed = step - static_cast<int>(EntryAt(group, field, brick, step).Age);
  const int last = group.Segment().Steps() - 1;
  std::uint64_t shared = changed == 0 ? EntryAt(group, field, brick, 0).Content : 0;
  const group::NodeEntry& atEnd = EntryAt(group, field, brick, last);
  if (shared == 0 && last - static_cast<int>(atEnd.Age) == changed)
  {
    shared = atEnd.Content;
  }
  Hash128 hash;
  if (shared != 0)
  {
    const glm::ivec3 size =
      series.Layouts[static_cast<std::size_t>(field.Level)].SamplesOf(brick).Size();
    const std::uint64_t content[] = { std::uint64_t(open.Type), open.DecodingHash, shared,
      BitCast<std::uint64_t>(range.Low), BitCast<std::uint64_t>(range.High), std::uint64_t(size.x),
      std::uint64_t(size.y), std::uint64_t(size.z) };
    hash = HashOf(content, sizeof(content));
  }
  else
  {
    // A segment may be named for several groups: what it decodes to depends on what lies before.
    const std::uint64_t seed[] = { std::uint64_t(field.Level), std::uint64_t(brick),
      std::uint64_t(changed), series.ComponentOf(field), group.Segment().HeaderHash().Low,
      group.Segment().HeaderHash().High, open.Before.Low, open.Before.High };
    hash = HashOf(seed, sizeof(seed));
  }
  return { hash.Low, hash.High };
}

/// 0 where the payloads are those of the level below.
std::uint32_t PayloadBytesOf(
  const OpenSeries& series, OpenGroup& open, const FieldKey& field, std::int64_t brick)
{
  const PlaneRegion region = RegionOf(series, open, field, brick);
  if (region.Stride != 1)
  {
    return 0;
  }
  // The last bricks have what lies behind them as well.
  GroupField& group = *open.Field;
  const BrickLayout& layout = series.Layouts[static_cast<std::size_t>(field.Level)];
  const glm::ivec3 position = layout.PositionOf(brick);
  glm::ivec3 own(1);
  for (int a = 0; a < 3; ++a)
  {
    const int real = group.Head().Axes[static_cast<std::size_t>(a)];
    own[a] = position[real] + 1 == layout.Bricks()[real] ? 2 : 1;
  }
  std::uint32_t bytes = 0;
  ForEachBlock(region,
    [&](const glm::ivec3& block)
    {
      const glm::ivec3 offset = block - region.FirstBlock;
      if (offset.x < own.x && offset.y < own.y && offset.z < own.z)
      {
        const group::BlockEntry& payload =
          EntryOf(group, field.Step - group.Segment().FirstStep(), region, block);
        bytes += payload.Payload.Bytes + payload.Exceptions.Bytes;
      }
    });
  return bytes;
}

BrickNode MakeNode(
  const OpenSeries& series, OpenGroup& open, const FieldKey& field, std::int64_t brick)
{
  GroupField& group = *open.Field;
  const group::NodeEntry& entry =
    EntryAt(group, field, brick, field.Step - group.Segment().FirstStep());
  BrickNode node;
  node.HasNonFinite = entry.HasNonFinite;
  node.Uniform = entry.Uniform;
  node.Range = RangeOf(open, entry);
  if (!node.Range.Empty())
  {
    const MaskRange masks = series.MaskRangeOf(field.Array, field.Component);
    // Interpolants of samples that share faces lie in all bins between the extremes.
    node.Mask = MaskOfBins(masks.BinOf(node.Range.Low), masks.BinOf(node.Range.High));
  }
  if (node.Uniform)
  {
    const BrickLayout& layout = series.Layouts[static_cast<std::size_t>(field.Level)];
    node.Identity = MacroVoxelIdentity(open.Type, layout.SamplesOf(brick).Size(), node.Range.Low);
    return node;
  }
  node.Identity = IdentityOf(series, open, field, brick, node.Range);
  node.PayloadBytes = PayloadBytesOf(series, open, field, brick);
  return node;
}

} // namespace

std::vector<BrickNode> NodesOf(const OpenSeries& series, OpenGroup& open, const FieldKey& field)
{
  std::vector<BrickNode> nodes;
  const std::int64_t count = series.Layouts[static_cast<std::size_t>(field.Level)].BrickCount();
  nodes.reserve(static_cast<std::size_t>(count));
  for (std::int64_t brick = 0; brick < count; ++brick)
  {
    nodes.push_back(MakeNode(series, open, field, brick));
  }
  return nodes;
}

} // namespace banyan
