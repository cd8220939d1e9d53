// SPDX-License-Identifier: BSD-3-Clause
#include "Cache/ChosenSamples.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"

#include <algorithm>
#include <string>

namespace banyan
{
namespace
{

/// The brick that a sample is taken from, and its place there. What several bricks hold is taken
/// from the last one, as ReadRegion() does.
struct Place
{
  std::int64_t Brick;
  std::uint32_t InBrick;
};

Place PlaceOf(const BrickLayout& layout, std::uint32_t sample)
{
  const glm::ivec3 size = layout.Samples();
  const std::uint32_t row = sample / static_cast<std::uint32_t>(size.x);
  const glm::ivec3 at(static_cast<int>(sample % static_cast<std::uint32_t>(size.x)),
    static_cast<int>(row % static_cast<std::uint32_t>(size.y)),
    static_cast<int>(row / static_cast<std::uint32_t>(size.y)));
  const glm::ivec3 brick = glm::min(at / layout.BrickCells(), layout.Bricks() - 1);
  const std::int64_t index = layout.IndexOf(brick);
  const Box held = layout.SamplesOf(index);
  const glm::ivec3 p = at - held.Lo;
  const glm::ivec3 n = held.Size();
  return { index, static_cast<std::uint32_t>((p.z * n.y + p.y) * n.x + p.x) };
}

} // namespace

ChosenSamples::ChosenSamples(const BrickLayout& layout, const std::vector<std::uint32_t>& samples)
  : Tuples(samples.size())
  , Places(samples.size())
{
  const glm::i64vec3 size = layout.Samples();
  std::vector<std::size_t> end(static_cast<std::size_t>(layout.BrickCount()) + 1, 0);
  for (const std::uint32_t sample : samples)
  {
    if (sample >= size.x * size.y * size.z)
    {
      throw Error("The image has no sample " + std::to_string(sample));
    }
    ++end[static_cast<std::size_t>(PlaceOf(layout, sample).Brick) + 1];
  }
  for (std::size_t brick = 0; brick + 1 < end.size(); ++brick)
  {
    if (end[brick + 1] > 0)
    {
      this->Holders.push_back(static_cast<std::int64_t>(brick));
      this->First.push_back(end[brick]);
    }
    end[brick + 1] += end[brick];
  }
  this->First.push_back(samples.size());
  // Where the next one of each brick goes.
  std::vector<std::size_t>& next = end;
  for (std::size_t tuple = 0; tuple < samples.size(); ++tuple)
  {
    const Place place = PlaceOf(layout, samples[tuple]);
    const std::size_t i = next[static_cast<std::size_t>(place.Brick)]++;
    this->Tuples[i] = static_cast<std::uint32_t>(tuple);
    this->Places[i] = place.InBrick;
  }
}

void ChosenSamples::Read(BrickCache& cache, const SeriesFile& series, const FieldKey& field,
  void* values, int stride, int component) const
{
  if (this->Count() == 0)
  {
    return; // `values` may be null
  }
  const BrickLayout layout = series.Layout(field.Level);
  const auto nodes = series.Nodes(field);
  Dispatch(series.Index().Arrays[static_cast<std::size_t>(field.Array)].Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      T* const to = static_cast<T*>(values) + component;
      const bool past = static_cast<std::uint64_t>(this->Count()) * sizeof(T) >= cache.Budget() / 6;
      const auto read = [&](std::size_t holder)
      {
        const std::int64_t brick = this->Holders[holder];
        const BrickNode& node = (*nodes)[static_cast<std::size_t>(brick)];
        const std::size_t end = this->First[holder + 1];
        const auto copy = [&](const auto& valueAt)
        {
          for (std::size_t i = this->First[holder]; i < end; ++i)
          {
            to[std::ptrdiff_t{ this->Tuples[i] } * stride] = valueAt(this->Places[i]);
          }
        };
        if (node.Uniform)
        {
          const T value = static_cast<T>(node.Range.Low);
          copy([&](std::uint32_t) { return value; });
        }
        else if (const auto held = past ? cache.GetIfHeld(series, field, node, brick)
                                        : cache.Get(series, field, brick))
        {
          const T* const from = held->template As<T>();
          copy([&](std::uint32_t place) { return from[place]; });
        }
        else
        {
          std::vector<T> decoded(static_cast<std::size_t>(layout.SamplesOf(brick).Count()));
          series.DecodeBrick(field, brick, decoded.data());
          copy([&](std::uint32_t place) { return decoded[place]; });
        }
      };
      const auto count = static_cast<std::int64_t>(this->Holders.size());
      // The last one first: a brick then finds the layers that it shares with others decoded.
      ThreadPool::Process().ParallelFor(
        count, [&](std::int64_t i) { read(static_cast<std::size_t>(count - 1 - i)); });
    });
}

} // namespace banyan
