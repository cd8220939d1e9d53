// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/BlockJob.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Codec/BlockScratch.h"

#include <glm/vector_relational.hpp>

#include <algorithm>
#include <type_traits>

namespace banyan
{
namespace
{

template <class Number>
void PlaceCoarser(const PlaneNumbers& coarser, PlaneNumbers& decoded)
{
  const glm::ivec3 last = coarser.Samples - 1;
  const Number* const numbers = coarser.Data<Number>();
  for (int z = 0; z < decoded.Padded.z; z += 4)
  {
    for (int y = 0; y < decoded.Padded.y; y += 4)
    {
      const Number* from =
        numbers + coarser.IndexOf({ 0, std::min(y / 4, last.y), std::min(z / 4, last.z) });
      Number* row = decoded.Data<Number>() + decoded.IndexOf({ 0, y, z });
      for (int x = 0; x < decoded.Padded.x; x += 4)
      {
        row[x] = from[std::min(x / 4, last.x)];
      }
    }
  }
}

glm::ivec3 PositionIn(const glm::ivec3& size, std::int64_t index)
{
  return { static_cast<int>(index % size.x), static_cast<int>(index / size.x % size.y),
    static_cast<int>(index / size.x / size.y) };
}

} // namespace

PlaneNumbers::PlaneNumbers(const glm::ivec3& samples, int edge, bool narrow)
  : Edge(edge)
  , Samples(samples)
  , Blocks((samples + edge - 1) / edge)
  , Padded(Blocks * edge + 1)
  , Narrow(narrow)
{
  const std::size_t count =
    static_cast<std::size_t>(std::int64_t{ this->Padded.x } * this->Padded.y * this->Padded.z);
  narrow ? this->Short.resize(count) : this->Long.resize(count);
}

glm::ivec3 CoarserSamples(const glm::ivec3& samples)
{
  return (samples - 1 + 3) / 4 + 1;
}

void EncodePlane(const PlaneToEncode& plane, PlaneNumbers& decoded,
  std::vector<BlockTokens>& blocks, ThreadPool& pool, const std::function<void(std::int64_t)>& done,
  const std::function<void(std::int64_t)>& begin)
{
  const PlaneNumbers& target = *plane.Target;
  if (target.Narrow != block::Narrow(plane.Least, plane.Greatest) ||
      decoded.Narrow != target.Narrow || decoded.Padded != target.Padded)
  {
    throw Error("The numbers of a plane are not kept in as many bits as its lattice asks for");
  }
  blocks.clear();
  blocks.resize(static_cast<std::size_t>(target.BlockCount()));
  std::vector<BlockUnderway> underway(blocks.size());
  const PlaneJob job{ &plane, &decoded, &blocks, &underway };
  const glm::ivec3 extended = target.Blocks + 1;
  const std::int64_t count = std::int64_t{ extended.x } * extended.y * extended.z;
  const auto indexOf = [&](const glm::ivec3& position)
  {
    return glm::all(glm::lessThan(position, target.Blocks))
             ? (std::int64_t{ position.z } * target.Blocks.y + position.y) * target.Blocks.x +
                 position.x
             : -1;
  };
  target.With(
    [&](auto* numbers)
    {
      PlaceCoarser<std::remove_const_t<std::remove_pointer_t<decltype(numbers)>>>(
        *plane.Coarser, decoded);
    });
  constexpr BlockPhase phases[] = { BlockPhase::Edges, BlockPhase::Faces, BlockPhase::Interior };
  if (pool.Width() == 1)
  {
    // Units begin at what the neighbours behind own: from the last block to the first, each can be
    // done as a whole, while its numbers are at hand.
    for (std::int64_t i = count; i-- > 0;)
    {
      const glm::ivec3 position = PositionIn(extended, i);
      const std::int64_t index = indexOf(position);
      if (index >= 0)
      {
        if (begin)
        {
          begin(index);
        }
        EncodeBlock(job, position, BlockPhase::Choose);
      }
      for (const BlockPhase phase : phases)
      {
        EncodeBlock(job, position, phase);
      }
      if (index >= 0)
      {
        done(index);
      }
    }
    return;
  }
  if (begin)
  {
    pool.ParallelFor(
      target.BlockCount(), [&](std::int64_t i) { begin(target.BlockCount() - 1 - i); });
  }
  pool.ParallelFor(target.BlockCount(),
    [&](std::int64_t i) { EncodeBlock(job, PositionIn(target.Blocks, i), BlockPhase::Choose); });
  for (const BlockPhase phase : phases)
  {
    pool.ParallelFor(count,
      [&](std::int64_t i)
      {
        const glm::ivec3 position = PositionIn(extended, i);
        EncodeBlock(job, position, phase);
        const std::int64_t index = phase == BlockPhase::Interior ? indexOf(position) : -1;
        if (index >= 0)
        {
          done(index);
        }
      });
  }
}

} // namespace banyan
