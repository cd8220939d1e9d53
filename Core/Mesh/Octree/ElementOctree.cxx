// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/ElementOctree.h"

#include <algorithm>

namespace banyan
{

glm::dmat4 ElementOctree::LatticeToWorld() const
{
  glm::dmat4 matrix(1.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    matrix[axis][axis] = this->FinestEdge[axis];
    matrix[3][axis] = this->LatticeOrigin[axis];
  }
  return matrix;
}

/// Starts of runs of keys, about as many as there are 16 leaves: searches are short then.
void ElementOctree::MakeStarts()
{
  int keyBits = 1;
  while (keyBits < 63 && this->Keys.back() >> keyBits != 0)
  {
    ++keyBits;
  }
  int bits = 0;
  while (bits < keyBits && bits < 24 && (this->LeafCount() >> 4) > std::int64_t{ 1 } << bits)
  {
    ++bits;
  }
  this->StartShift = keyBits - bits;
  std::vector<std::uint32_t> starts((std::size_t{ 1 } << bits) + 1, 0);
  std::size_t run = 0;
  for (std::size_t leaf = 0; leaf < this->Keys.size(); ++leaf)
  {
    const auto own = static_cast<std::size_t>(this->Keys[leaf] >> this->StartShift);
    for (; run <= own; ++run)
    {
      starts[run] = static_cast<std::uint32_t>(leaf);
    }
  }
  for (; run < starts.size(); ++run)
  {
    starts[run] = static_cast<std::uint32_t>(this->Keys.size());
  }
  this->Starts = std::move(starts);
}

std::size_t ElementOctree::Bytes() const
{
  return this->Keys.Bytes() + this->CellNumbers.Bytes() + this->Levels.Bytes() +
         this->CornerOrders.Bytes() + this->OrderOfCell.Bytes() + this->HangingNodes.Bytes() +
         this->TwinNodes.Bytes() + this->Starts.Bytes();
}

std::int64_t ElementOctree::LeafFrom(MortonKey key) const
{
  const MortonKey run = key >> this->StartShift;
  if (run + 1 >= this->Starts.size())
  {
    return this->LeafCount();
  }
  const auto begin = this->Keys.begin() + this->Starts[run];
  const auto end = this->Keys.begin() + this->Starts[run + 1];
  return std::lower_bound(begin, end, key) - this->Keys.begin();
}

Hash128 ElementOctree::HashOfLeaves(std::int64_t first, std::int64_t end) const
{
  const std::size_t count = Index(end - first);
  const Hash128 levels = HashOf(this->Levels.data() + first, count);
  return HashOf(this->Keys.data() + first, count * sizeof(MortonKey), levels.Low);
}

std::int64_t ElementOctree::LeafAt(const glm::ivec3& cell) const
{
  if (!this->DomainCells.Contains(cell))
  {
    return -1;
  }
  const MortonKey key = KeyOf(cell);
  std::int64_t leaf = this->LeafFrom(key);
  if (leaf == this->LeafCount() || this->KeyOfLeaf(leaf) != key)
  {
    --leaf;
  }
  return leaf >= 0 && key - this->KeyOfLeaf(leaf) < CubeKeys(this->LevelOfLeaf(leaf)) ? leaf : -1;
}

std::int64_t ElementOctree::LargestLeafAround(const glm::ivec3& point) const
{
  std::int64_t largest = -1;
  for (int octant = 0; octant < 8; ++octant)
  {
    const glm::ivec3 cell = point - glm::ivec3(octant & 1, octant >> 1 & 1, octant >> 2);
    const std::int64_t leaf = this->LeafAt(cell);
    if (leaf >= 0 && (largest < 0 || this->LevelOfLeaf(leaf) > this->LevelOfLeaf(largest)))
    {
      largest = leaf;
    }
  }
  return largest;
}

} // namespace banyan
