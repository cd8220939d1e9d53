#include "Codec/BlockJob.h"

#include "Base/ThreadPool.h"

#include <algorithm>

namespace banyan
{
namespace
{

void PlaceCoarser(const PlaneNumbers& coarser, PlaneNumbers& decoded)
{
  const glm::ivec3 last = coarser.Samples - 1;
  for (int z = 0; z < decoded.Padded.z; z += 4)
  {
    for (int y = 0; y < decoded.Padded.y; y += 4)
    {
      const std::int64_t from =
        coarser.IndexOf({ 0, std::min(y / 4, last.y), std::min(z / 4, last.z) });
      std::int32_t* row = decoded.Numbers.data() + decoded.IndexOf({ 0, y, z });
      for (int x = 0; x < decoded.Padded.x; x += 4)
      {
        row[x] = coarser.Numbers[static_cast<std::size_t>(from + std::min(x / 4, last.x))];
      }
    }
  }
}

/// Finds the blocks whose samples are all the same, and places them.
void PlaceUniform(const PlaneNumbers& target, const glm::ivec3& position, BlockTokens& block,
  PlaneNumbers& decoded)
{
  const glm::ivec3 low = position * target.Edge;
  const glm::ivec3 high = low + target.Edge;
  const std::int32_t value = target.Numbers[static_cast<std::size_t>(target.IndexOf(low))];
  for (int z = low.z; z < high.z; ++z)
  {
    for (int y = low.y; y < high.y; ++y)
    {
      const std::int32_t* row = target.Numbers.data() + target.IndexOf({ low.x, y, z });
      for (int x = 0; x < target.Edge; ++x)
      {
        if (row[x] != value)
        {
          return;
        }
      }
    }
  }
  block.Uniform = true;
  block.Value = value;
  for (int z = low.z; z < high.z; ++z)
  {
    for (int y = low.y; y < high.y; ++y)
    {
      std::int32_t* row = decoded.Numbers.data() + decoded.IndexOf({ low.x, y, z });
      std::fill(row, row + target.Edge, value);
    }
  }
}

/// Finds the blocks that may stay as they are in reference A, and places them.
void PlaceSame(const PlaneToEncode& plane, const glm::ivec3& position, BlockTokens& block,
  PlaneNumbers& decoded)
{
  const PlaneNumbers& target = *plane.Target;
  const glm::ivec3 low = position * target.Edge;
  const glm::ivec3 high = low + target.Edge;
  const glm::ivec3 limit = target.Samples;
  const std::int64_t most = plane.FineBin / 2;
  for (int z = low.z; z < std::min(high.z, limit.z); ++z)
  {
    for (int y = low.y; y < std::min(high.y, limit.y); ++y)
    {
      const std::int32_t* row = target.Numbers.data() + target.IndexOf({ 0, y, z });
      const std::int32_t* before = plane.A->Numbers.data() + plane.A->IndexOf({ 0, y, z });
      for (int x = low.x; x < std::min(high.x, limit.x); ++x)
      {
        const std::int64_t rest = std::int64_t{ row[x] } - before[x];
        if (rest > most || rest < -most)
        {
          return;
        }
      }
    }
  }
  block.Same = true;
  for (int z = low.z; z < high.z; ++z)
  {
    for (int y = low.y; y < high.y; ++y)
    {
      const std::int32_t* from = plane.A->Numbers.data() + plane.A->IndexOf({ low.x, y, z });
      std::copy(from, from + target.Edge, decoded.Numbers.data() + decoded.IndexOf({ low.x, y, z }));
    }
  }
}

glm::ivec3 PositionIn(const glm::ivec3& size, std::int64_t index)
{
  return { static_cast<int>(index % size.x), static_cast<int>(index / size.x % size.y),
    static_cast<int>(index / size.x / size.y) };
}

} // namespace

PlaneNumbers::PlaneNumbers(const glm::ivec3& samples, int edge)
  : Edge(edge)
  , Samples(samples)
  , Blocks((samples + edge - 1) / edge)
  , Padded(Blocks * edge + 1)
  , Numbers(static_cast<std::size_t>(std::int64_t{ Padded.x } * Padded.y * Padded.z))
{
}

glm::ivec3 CoarserSamples(const glm::ivec3& samples)
{
  return (samples - 1 + 3) / 4 + 1;
}

void EncodePlane(const PlaneToEncode& plane, PlaneNumbers& decoded,
  std::vector<BlockTokens>& blocks, ThreadPool& pool)
{
  const PlaneNumbers& target = *plane.Target;
  decoded = PlaneNumbers(target.Samples, target.Edge);
  blocks.clear();
  blocks.resize(static_cast<std::size_t>(target.BlockCount()));
  PlaceCoarser(*plane.Coarser, decoded);
  pool.ParallelFor(target.BlockCount(),
    [&](std::int64_t i)
    {
      const glm::ivec3 position = PositionIn(target.Blocks, i);
      BlockTokens& block = blocks[static_cast<std::size_t>(i)];
      PlaceUniform(target, position, block, decoded);
      if (!block.Uniform && plane.A != nullptr)
      {
        PlaceSame(plane, position, block, decoded);
      }
    });
  std::vector<BlockUnderway> underway(blocks.size());
  const PlaneJob job{ &plane, &decoded, &blocks, &underway };
  pool.ParallelFor(target.BlockCount(), [&](std::int64_t i)
    { EncodeBlock(job, PositionIn(target.Blocks, i), BlockPhase::Choose); });
  const glm::ivec3 extended = target.Blocks + 1;
  const std::int64_t count = std::int64_t{ extended.x } * extended.y * extended.z;
  for (const BlockPhase phase : { BlockPhase::Edges, BlockPhase::Faces, BlockPhase::Interior })
  {
    pool.ParallelFor(
      count, [&](std::int64_t i) { EncodeBlock(job, PositionIn(extended, i), phase); });
  }
}

} // namespace banyan
