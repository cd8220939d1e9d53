// SPDX-License-Identifier: BSD-3-Clause
#include "Series/OpenGroup.h"

#include "Series/Hash.h"
#include "Series/ValueArithmetic.h"

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

BrickNode MakeNode(
  const OpenSeries& series, OpenGroup& open, const FieldKey& field, std::int64_t brick)
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
    const MaskRange masks = series.MaskRangeOf(field.Array, field.Component);
    // Interpolants of samples that share faces lie in all bins between the extremes.
    node.Mask = MaskOfBins(masks.BinOf(node.Range.Low), masks.BinOf(node.Range.High));
  }
  const BrickLayout& layout = series.Layouts[static_cast<std::size_t>(field.Level)];
  if (node.Uniform)
  {
    node.Identity = MacroVoxelIdentity(open.Type, layout.SamplesOf(brick).Size(), node.Range.Low);
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
  // A segment may be named for several groups: what it decodes to depends on what lies before.
  const std::uint64_t seed[] = { std::uint64_t(field.Level), std::uint64_t(brick),
    std::uint64_t(changed), series.ComponentOf(field), group.Segment().HeaderHash().Low,
    group.Segment().HeaderHash().High, open.Before.Low, open.Before.High };
  const std::uint64_t content[] = { std::uint64_t(open.Type), open.Meaning, shared,
    BitCast<std::uint64_t>(node.Range.Low), BitCast<std::uint64_t>(node.Range.High),
    std::uint64_t(layout.SamplesOf(brick).Size().x),
    std::uint64_t(layout.SamplesOf(brick).Size().y),
    std::uint64_t(layout.SamplesOf(brick).Size().z) };
  const Hash128 hash = shared != 0 ? HashOf(content, sizeof(content)) : HashOf(seed, sizeof(seed));
  node.Identity = { hash.Low, hash.High };
  const PlaneRegion region = RegionOf(series, open, field, brick);
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
