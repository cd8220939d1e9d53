#include "VerifiedBricks.h"

#include "Base/ThreadPool.h"
#include "Series/PieceRange.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Checksums do not tell that an index and its segments do not belong together, such as an index with
/// another extent: bricks at the end of the grid are then not as long as their payloads.
void DecodeSomeAtTheEnd(
  const SeriesFile& series, const FieldKey& field, const std::vector<std::int64_t>& bricks)
{
  const BrickLayout layout = series.Layout(field.Level);
  std::vector<std::int64_t> last;
  for (const std::int64_t brick : bricks)
  {
    const glm::ivec3 behind = layout.PositionOf(brick) + 1;
    if (behind.x == layout.Bricks().x || behind.y == layout.Bricks().y || behind.z == layout.Bricks().z)
    {
      last.push_back(brick);
    }
  }
  constexpr std::size_t most = 16; // some milliseconds
  const std::size_t stride = (last.size() + most - 1) / most;
  for (std::size_t i = 0; i < last.size(); i += stride)
  {
    const std::int64_t brick = last[last.size() - 1 - i];
    const ScalarType type = series.Index().Arrays[static_cast<std::size_t>(field.Array)].Type;
    std::vector<char> values(
      static_cast<std::size_t>(layout.SamplesOf(brick).Count()) * SizeOf(type));
    series.DecodeBrick(field, brick, values.data());
  }
}

} // namespace

void VerifiedBricks::Verify(const SeriesFile& series, const FieldKey& field, const Box& samples)
{
  if (this->Series != series.Id())
  {
    this->Checked.clear();
    this->Series = series.Id();
  }
  const auto nodes = series.Nodes(field);
  const bool first = this->Checked.count({ field.Array, field.Component, field.Level }) == 0;
  std::vector<PayloadIdentity>& checked =
    this->Checked[{ field.Array, field.Component, field.Level }];
  checked.resize(nodes->size());
  std::vector<std::int64_t> unchecked;
  for (const std::int64_t brick : BricksTouching(series.Layout(field.Level), samples))
  {
    const BrickNode& node = (*nodes)[brick];
    if (!node.Uniform && !(node.Identity == checked[brick]))
    {
      unchecked.push_back(brick);
    }
  }
  // Enough bricks for a thread to be worth waking, few enough to share the work evenly.
  constexpr std::size_t BatchBricks = 64;
  const std::size_t batches = (unchecked.size() + BatchBricks - 1) / BatchBricks;
  ThreadPool::Process().ParallelFor(static_cast<std::int64_t>(batches),
    [&](std::int64_t batch)
    {
      const auto first = unchecked.begin() + batch * BatchBricks;
      const auto last =
        unchecked.begin() + std::min<std::size_t>((batch + 1) * BatchBricks, unchecked.size());
      series.VerifyBricks(field, { first, last });
    });
  if (first)
  {
    DecodeSomeAtTheEnd(series, field, unchecked);
  }
  for (const std::int64_t brick : unchecked)
  {
    checked[brick] = (*nodes)[brick].Identity;
  }
}

} // namespace banyan
