// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/SummaryTree.h"

#include "Base/ThreadPool.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Boxes with fewer cells per axis have no nodes: few bricks are in them, which are groups
/// (BrickGroups) as a rule.
constexpr int LeastCells = 64;

glm::ivec3 BoxesAt(const glm::ivec3& bricks, int height)
{
  return (bricks + (1 << height) - 1) / (1 << height);
}

SummaryNode NodeOf(const BrickSource& source, std::int64_t brick)
{
  SummaryNode node;
  node.Range = source.RangeOf(brick);
  node.Mask = source.MaskOf(brick);
  node.Full = !node.Range.Empty() && node.Mask != 0;
  return node;
}

} // namespace

void SummaryNode::Include(const SummaryNode& other)
{
  this->Range.Include(other.Range);
  this->Mask |= other.Mask;
  this->Full = this->Full && other.Full;
}

SummaryTree::SummaryTree(const BrickSource& source)
  : Counts(source.Bricks())
{
  if (Box{ glm::ivec3(0), this->Counts }.Empty())
  {
    return;
  }
  this->CutAxes(source);
  // The first and the last ones may be cut off.
  const glm::ivec3 size =
    source.CellsOf(BrickSource::NumberOf(this->Counts / 2, this->Counts)).Size();
  const int cells = std::max({ size.x, size.y, size.z, 1 });
  for (int height = 0; height == 0 || this->Heights.back().Counts != glm::ivec3(1); ++height)
  {
    this->Heights.push_back({ BoxesAt(this->Counts, height), {} });
    if (this->LowestNodes > 0)
    {
      this->SumNodes(height);
    }
    else if (height > 0 && cells << height >= LeastCells)
    {
      this->SumBricks(source, height);
      this->LowestNodes = height;
    }
  }
}

void SummaryTree::CutAxes(const BrickSource& source)
{
  for (int axis = 0; axis < 3; ++axis)
  {
    for (int i = 0; i < this->Counts[axis]; ++i)
    {
      glm::ivec3 at(0);
      at[axis] = i;
      const Box cells = source.CellsOf(BrickSource::NumberOf(at, this->Counts));
      this->Begins[static_cast<std::size_t>(axis)].push_back(cells.Lo[axis]);
      this->Ends[static_cast<std::size_t>(axis)].push_back(cells.Hi[axis]);
    }
  }
}

void SummaryTree::SumBricks(const BrickSource& source, int height)
{
  Level& level = this->Heights[static_cast<std::size_t>(height)];
  level.Nodes.resize(static_cast<std::size_t>(Box{ glm::ivec3(0), level.Counts }.Count()));
  ThreadPool::Process().ParallelFor(level.Counts.z,
    [&](std::int64_t slab)
    {
      const int begin = static_cast<int>(slab) << height;
      const int end = std::min(begin + (1 << height), this->Counts.z);
      ForPositions({ { 0, 0, begin }, { this->Counts.x, this->Counts.y, end } },
        [&](const glm::ivec3& at)
        {
          level.Nodes[level.NumberOf(at >> height)].Include(
            NodeOf(source, BrickSource::NumberOf(at, this->Counts)));
        });
    });
}

void SummaryTree::SumNodes(int height)
{
  const Level& below = this->Heights[static_cast<std::size_t>(height) - 1];
  Level& level = this->Heights[static_cast<std::size_t>(height)];
  level.Nodes.resize(static_cast<std::size_t>(Box{ glm::ivec3(0), level.Counts }.Count()));
  ForPositions({ glm::ivec3(0), below.Counts }, [&](const glm::ivec3& at)
    { level.Nodes[level.NumberOf(at >> 1)].Include(below.Nodes[below.NumberOf(at)]); });
}

Box SummaryTree::CellsOf(const Box& bricks) const
{
  Box cells;
  for (int axis = 0; axis < 3; ++axis)
  {
    const auto a = static_cast<std::size_t>(axis);
    cells.Lo[axis] = this->Begins[a][static_cast<std::size_t>(bricks.Lo[axis])];
    cells.Hi[axis] = this->Ends[a][static_cast<std::size_t>(bricks.Hi[axis]) - 1];
  }
  return cells;
}

Box SummaryTree::BricksIn(const Box& cells) const
{
  Box bricks;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::vector<int>& begins = this->Begins[static_cast<std::size_t>(axis)];
    const std::vector<int>& ends = this->Ends[static_cast<std::size_t>(axis)];
    bricks.Lo[axis] =
      static_cast<int>(std::upper_bound(ends.begin(), ends.end(), cells.Lo[axis]) - ends.begin());
    bricks.Hi[axis] = static_cast<int>(
      std::lower_bound(begins.begin(), begins.end(), cells.Hi[axis]) - begins.begin());
  }
  return cells.Empty() || bricks.Empty() ? Box{} : bricks;
}

} // namespace banyan
