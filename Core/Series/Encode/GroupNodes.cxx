// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/GroupNodes.h"

#include "Base/ForEachScalarType.h"
#include "Base/Hash.h"
#include "Base/ThreadPool.h"
#include "Series/Decode/LatticeDecoder.h"
#include "Series/Encode/BrickStatistics.h"
#include "Series/Encode/HiddenSamples.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace banyan
{

namespace
{

/// The nodes of one level over all steps.
template <class T>
class LevelNodes
{
public:
  LevelNodes(const FieldGroup& field, const group::FieldHead& head, int level,
    const std::vector<DecodedStep>& decoded, std::vector<EncodedStep>& steps)
    : Field(field)
    , Head(head)
    , Level(level)
    , Layout(field.Samples, field.BrickCells, level)
    , Decoded(decoded)
    , Steps(steps)
    , Decoder(field.Map, head.Origin, head.Step, head.Least, head.Greatest)
  {
    for (const EncodedStep& step : steps)
    {
      const auto& blocks = step.Planes[static_cast<std::size_t>(level / 2)];
      this->Excepted.push_back(std::any_of(blocks.begin(), blocks.end(),
        [](const EncodedBlock& block) { return !block.Exceptions.empty(); }));
    }
  }

  std::int64_t Count() const { return this->Layout.BrickCount(); }

  void Make(std::int64_t brick) const
  {
    const std::size_t plane = static_cast<std::size_t>(this->Level / 2);
    const PlaneRegion region(this->Level, this->Layout.SamplesOf(brick), this->Head.Axes,
      this->Decoded[0].Planes[plane].Samples, this->Field.BrickCells);
    std::vector<std::int32_t> numbers;
    const std::size_t last = this->Steps.size() - 1;
    NumberExtremes before;
    for (std::size_t t = 0; t <= last; ++t)
    {
      group::NodeEntry& node = this->NodeOf(t, brick);
      const DecodedStep& step = this->Decoded[t];
      const NumberExtremes extremes =
        ExtremesOfBlocks(step.Extremes[plane], step.Planes[plane], region);
      if (this->HasExceptions(t, region))
      {
        this->Gather(step.Planes[plane], region, numbers);
        this->Describe(t, region, numbers, node);
      }
      else
      {
        node.Low = extremes.Low;
        node.High = extremes.High;
        node.Uniform = node.Low == node.High;
      }
      const bool asBefore =
        t > 0 && extremes.MayBeThoseOf(before) && this->IsAsBefore(t, region, extremes);
      if (asBefore && this->SameExceptions(t, region) &&
          SameHidden(this->Field, this->Head.Axes, t, region))
      {
        node.Age = this->NodeOf(t - 1, brick).Age + 1;
      }
      before = extremes;
    }
    for (const std::size_t t : { std::size_t{ 0 }, last })
    {
      if (!this->NodeOf(t, brick).Uniform && this->NeedsContent(t, brick, region))
      {
        this->Gather(this->Decoded[t].Planes[plane], region, numbers);
        this->NodeOf(t, brick).Content = this->ContentOf(t, region, numbers);
      }
    }
  }

private:
  /// Whether all numbers of a brick are those of the step before. They are compared only where
  /// nothing else tells, as they have left the processor's caches by now.
  /// @param extremes of both steps
  bool IsAsBefore(std::size_t step, const PlaneRegion& region, const NumberExtremes& extremes) const
  {
    const std::size_t plane = static_cast<std::size_t>(region.Plane);
    const DecodedStep& now = this->Decoded[step];
    const DecodedStep& before = this->Decoded[step - 1];
    bool left = true;
    this->ForEachBlock(step, region,
      [&](std::size_t block, const glm::ivec3&)
      { left = left && now.Origins[plane][block] == before.Origins[plane][block]; });
    return left || extremes.Low == extremes.High ||
           SameInRegion(now.Planes[plane], before.Planes[plane],
             step + 1 < this->Decoded.size() ? &this->Decoded[step + 1].Planes[plane] : nullptr,
             region);
  }

  group::NodeEntry& NodeOf(std::size_t step, std::int64_t brick) const
  {
    return this->Steps[step]
      .Levels[static_cast<std::size_t>(this->Level)][static_cast<std::size_t>(brick)];
  }

  /// Whether a brick may well be the same as one of another segment: in the first step as the key
  /// frame before, in the last step as the first one after.
  bool NeedsContent(std::size_t step, std::int64_t brick, const PlaneRegion& region) const
  {
    const std::size_t last = this->Steps.size() - 1;
    if (step == 0 && this->Head.Open)
    {
      const std::size_t plane = static_cast<std::size_t>(region.Plane);
      return SameInRegion(
        this->Decoded[0].Planes[plane], this->Field.Before->Planes[plane], nullptr, region);
    }
    if (step == 0)
    {
      return last == 0 || this->NodeOf(1, brick).Age > 0;
    }
    const std::uint32_t age = this->NodeOf(last, brick).Age;
    const bool known = this->NodeOf(0, brick).Content != 0;
    if (age == last && known)
    {
      return false; // it has that content
    }
    // A payload that moved up to the key frame will move on: nothing is the same as this.
    return age > 0 || (last == 1 ? known : this->NodeOf(last - 1, brick).Age > 0);
  }

  void Gather(
    const PlaneNumbers& plane, const PlaneRegion& region, std::vector<std::int32_t>& numbers) const
  {
    numbers.resize(static_cast<std::size_t>(region.Count.x) *
                   static_cast<std::size_t>(region.Count.y) *
                   static_cast<std::size_t>(region.Count.z));
    std::int32_t* to = numbers.data();
    plane.With(
      [&](const auto* from)
      {
        for (int z = 0; z < region.Count.z; ++z)
        {
          for (int y = 0; y < region.Count.y; ++y, to += region.Count.x)
          {
            GatherRow(from + plane.IndexOf({ 0, region.SampleAt(1, y), region.SampleAt(2, z) }),
              region, to);
          }
        }
      });
  }

  /// @param row sample 0 of the row
  template <class Number>
  static void GatherRow(const Number* row, const PlaneRegion& region, std::int32_t* to)
  {
    const int last = region.Count.x - 1; // the only one that may lie beyond the plane's last sample
    const Number* const first = row + region.Low.x;
    if (region.Stride == 1)
    {
      std::copy(first, first + last, to);
    }
    else
    {
      for (int x = 0; x < last; ++x)
      {
        to[x] = first[2 * x];
      }
    }
    to[last] = row[region.SampleAt(0, last)];
  }

  template <class Body>
  void ForEachBlock(std::size_t step, const PlaneRegion& region, Body&& body) const
  {
    const std::size_t plane = static_cast<std::size_t>(region.Plane);
    const glm::ivec3 blocks = this->Decoded[step].Planes[plane].Blocks;
    for (int z = region.FirstBlock.z; z < region.EndBlock.z; ++z)
    {
      for (int y = region.FirstBlock.y; y < region.EndBlock.y; ++y)
      {
        for (int x = region.FirstBlock.x; x < region.EndBlock.x; ++x)
        {
          const std::size_t index =
            (static_cast<std::size_t>(z) * blocks.y + y) * blocks.x + static_cast<std::size_t>(x);
          body(index, glm::ivec3{ x, y, z });
        }
      }
    }
  }

  const Bytes& ExceptionsOf(std::size_t step, const PlaneRegion& region, std::size_t block) const
  {
    return this->Steps[step].Planes[static_cast<std::size_t>(region.Plane)][block].Exceptions;
  }

  bool HasExceptions(std::size_t step, const PlaneRegion& region) const
  {
    bool any = false;
    if (!this->Excepted[step])
    {
      return any;
    }
    this->ForEachBlock(step, region,
      [&](std::size_t block, const glm::ivec3&)
      { any = any || !this->ExceptionsOf(step, region, block).empty(); });
    return any;
  }

  bool SameExceptions(std::size_t step, const PlaneRegion& region) const
  {
    bool same = true;
    if (!this->Excepted[step] && !this->Excepted[step - 1])
    {
      return same;
    }
    this->ForEachBlock(step, region,
      [&](std::size_t block, const glm::ivec3&)
      {
        same = same && this->ExceptionsOf(step, region, block) ==
                         this->ExceptionsOf(step - 1, region, block);
      });
    return same;
  }

  std::uint64_t ContentOf(
    std::size_t step, const PlaneRegion& region, const std::vector<std::int32_t>& numbers) const
  {
    const double lattice[] = { this->Head.Origin, this->Head.Step };
    Bytes all(sizeof(lattice) + numbers.size() * sizeof(std::int32_t));
    std::memcpy(all.data(), lattice, sizeof(lattice));
    std::memcpy(
      all.data() + sizeof(lattice), numbers.data(), numbers.size() * sizeof(std::int32_t));
    this->ForEachBlock(step, region,
      [&](std::size_t block, const glm::ivec3&)
      {
        const Bytes& exceptions = this->ExceptionsOf(step, region, block);
        all.insert(all.end(), exceptions.begin(), exceptions.end());
      });
    constexpr std::uint64_t mask = (std::uint64_t{ 1 } << group::ContentBits) - 1;
    return ShortHashOf(all.data(), all.size()) & mask;
  }

  /// The node of a brick with exceptions, from its values.
  void Describe(std::size_t step, const PlaneRegion& region,
    const std::vector<std::int32_t>& numbers, group::NodeEntry& node) const
  {
    std::vector<T> values(numbers.size());
    for (std::size_t i = 0; i < numbers.size(); ++i)
    {
      values[i] = this->Decoder.ValueOf(numbers[i]);
    }
    const PlaneNumbers& plane = this->Decoded[step].Planes[static_cast<std::size_t>(region.Plane)];
    const std::uint32_t samples = static_cast<std::uint32_t>(plane.Edge * plane.Edge * plane.Edge);
    this->ForEachBlock(step, region,
      [&](std::size_t block, const glm::ivec3& position)
      {
        const Bytes& payload = this->ExceptionsOf(step, region, block);
        if (!payload.empty())
        {
          PlaceExceptions(region, plane.Edge, position,
            UnpackExceptions<T>(payload.data(), payload.size(), samples), values.data());
        }
      });
    const std::vector<std::size_t> hidden = HiddenIn(this->Field, this->Head.Axes, step, region);
    LeaveOut(hidden, values);
    const BrickSummary summary = Summarize(values.data(), values.size());
    node.HasNonFinite = summary.HasNonFinite || !hidden.empty();
    node.NothingFinite = summary.Range.Empty() || hidden.size() == values.size();
    node.Uniform = summary.Uniform && hidden.empty();
    node.Explicit = !node.NothingFinite;
    node.LowValue = node.NothingFinite ? 0 : summary.Range.Low;
    node.HighValue = node.NothingFinite ? 0 : summary.Range.High;
  }

  const FieldGroup& Field;
  const group::FieldHead& Head;
  int Level;
  BrickLayout Layout;
  const std::vector<DecodedStep>& Decoded;
  std::vector<EncodedStep>& Steps;
  LatticeDecoder<T> Decoder;
  std::vector<bool> Excepted; ///< steps with exceptions on the level's plane
};

} // namespace

template <class T>
void MakeNodes(const FieldGroup& field, const group::FieldHead& head,
  const std::vector<DecodedStep>& decoded, std::vector<EncodedStep>& steps, ThreadPool& pool)
{
  for (int level = 0; level < field.Levels; ++level)
  {
    const LevelNodes<T> nodes(field, head, level, decoded, steps);
    for (EncodedStep& step : steps)
    {
      step.Levels.emplace_back(static_cast<std::size_t>(nodes.Count()));
    }
    pool.ParallelFor(nodes.Count(), [&](std::int64_t brick) { nodes.Make(brick); });
  }
}

#define BANYAN_INSTANTIATE(T)                                                                      \
  template void MakeNodes<T>(const FieldGroup&, const group::FieldHead&,                           \
    const std::vector<DecodedStep>&, std::vector<EncodedStep>&, ThreadPool&)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
