// SPDX-License-Identifier: BSD-3-Clause
#include "Codec/BlockJob.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Codec/BlockScratch.h"
#include "Codec/Simd/BlockKernels.h"

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

using BlockCallback = std::function<void(std::int64_t)>;

constexpr BlockPhase CodingPhases[] = { BlockPhase::Edges, BlockPhase::Faces,
  BlockPhase::Interior };

void EncodeBlock(const PlaneJob& job, const glm::ivec3& position, BlockPhase phase)
{
  if (job.Decoded->Narrow)
  {
    return job.Decoded->Edge == 16 ? EncodeBlockNarrow16(job, position, phase)
                                   : EncodeBlockNarrow32(job, position, phase);
  }
  job.Decoded->Edge == 16 ? EncodeBlockWide16(job, position, phase)
                          : EncodeBlockWide32(job, position, phase);
}

/// The blocks of a plane, and one more along each axis: what the last ones share with none.
struct ExtendedBlocks
{
  explicit ExtendedBlocks(const PlaneNumbers& plane)
    : Blocks(plane.Blocks)
    , Extended(plane.Blocks + 1)
    , Count(std::int64_t{ this->Extended.x } * this->Extended.y * this->Extended.z)
  {
  }

  glm::ivec3 PositionOf(std::int64_t i) const { return PositionIn(this->Extended, i); }

  /// The number of a block; -1 for those beyond.
  std::int64_t IndexOf(const glm::ivec3& position) const
  {
    return glm::all(glm::lessThan(position, this->Blocks))
             ? (std::int64_t{ position.z } * this->Blocks.y + position.y) * this->Blocks.x +
                 position.x
             : -1;
  }

  glm::ivec3 Blocks, Extended;
  std::int64_t Count;
};

/// Units begin at what the neighbours behind own: from the last block to the first, each can be
/// done as a whole, while its numbers are at hand.
void EncodeOneByOne(const PlaneJob& job, const BlockCallback& done, const BlockCallback& begin)
{
  const ExtendedBlocks blocks(*job.Plane->Target);
  for (std::int64_t i = blocks.Count; i-- > 0;)
  {
    const glm::ivec3 position = blocks.PositionOf(i);
    const std::int64_t index = blocks.IndexOf(position);
    if (index >= 0)
    {
      if (begin)
      {
        begin(index);
      }
      EncodeBlock(job, position, BlockPhase::Choose);
    }
    for (const BlockPhase phase : CodingPhases)
    {
      EncodeBlock(job, position, phase);
    }
    if (index >= 0)
    {
      done(index);
    }
  }
}

/// Each phase of all blocks after the one before.
void EncodeInPhases(
  const PlaneJob& job, ThreadPool& pool, const BlockCallback& done, const BlockCallback& begin)
{
  const PlaneNumbers& target = *job.Plane->Target;
  const ExtendedBlocks blocks(target);
  if (begin)
  {
    pool.ParallelFor(
      target.BlockCount(), [&](std::int64_t i) { begin(target.BlockCount() - 1 - i); });
  }
  pool.ParallelFor(target.BlockCount(),
    [&](std::int64_t i) { EncodeBlock(job, PositionIn(target.Blocks, i), BlockPhase::Choose); });
  for (const BlockPhase phase : CodingPhases)
  {
    pool.ParallelFor(blocks.Count,
      [&](std::int64_t i)
      {
        const glm::ivec3 position = blocks.PositionOf(i);
        EncodeBlock(job, position, phase);
        const std::int64_t index = phase == BlockPhase::Interior ? blocks.IndexOf(position) : -1;
        if (index >= 0)
        {
          done(index);
        }
      });
  }
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
  std::vector<BlockTokens>& blocks, ThreadPool& pool, const BlockCallback& done,
  const BlockCallback& begin)
{
  const PlaneNumbers& target = *plane.Target;
  if (target.Edge != 16 && target.Edge != 32)
  {
    throw Error("A block must have an edge of 16 or 32 samples");
  }
  if (target.Narrow != block::Narrow(plane.Least, plane.Greatest) ||
      decoded.Narrow != target.Narrow || decoded.Padded != target.Padded)
  {
    throw Error("The numbers of a plane are not kept in as many bits as its lattice asks for");
  }
  blocks.clear();
  blocks.resize(static_cast<std::size_t>(target.BlockCount()));
  std::vector<BlockUnderway> underway(blocks.size());
  const PlaneJob job{ &plane, &decoded, &blocks, &underway };
  target.With(
    [&](auto* numbers)
    {
      PlaceCoarser<std::remove_const_t<std::remove_pointer_t<decltype(numbers)>>>(
        *plane.Coarser, decoded);
    });
  pool.Width() == 1 ? EncodeOneByOne(job, done, begin) : EncodeInPhases(job, pool, done, begin);
}

} // namespace banyan
