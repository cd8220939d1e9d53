// SPDX-License-Identifier: BSD-3-Clause
#include "VerifiedBricks.h"

#include "Base/ThreadPool.h"
#include "Series/Decode/PieceRange.h"

#include <algorithm>

namespace banyan
{

void VerifiedBricks::Verify(const SeriesFile& series, const FieldKey& field, const Box& samples)
{
  if (this->Series != series.Id())
  {
    this->Checked.clear();
    this->Series = series.Id();
  }
  const auto nodes = series.Nodes(field);
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
  for (const std::int64_t brick : unchecked)
  {
    checked[brick] = (*nodes)[brick].Identity;
  }
}

} // namespace banyan
