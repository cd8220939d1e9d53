// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/HexBricks.h"

#include <algorithm>

namespace banyan
{

HexBricks::HexBricks(std::shared_ptr<const ElementOctree> tree, int edge)
  : Octree(std::move(tree))
  , EdgeLevel(0)
{
  if (edge < 1 || (edge & (edge - 1)) != 0)
  {
    throw Error("The cells per axis of a brick must be a power of two");
  }
  while (1 << this->EdgeLevel < edge)
  {
    ++this->EdgeLevel;
  }
  const glm::ivec3 end = this->Octree->Domain().Hi;
  while (1 << this->RootLevel < std::max({ end.x, end.y, end.z }))
  {
    ++this->RootLevel;
  }
  this->Cut({ 0, this->RootLevel, 0, this->Octree->LeafCount() });
  for (HexBrick& brick : this->Bricks)
  {
    this->Coarsest = std::max(this->Coarsest, brick.Level);
    brick.Leaves = this->Octree->HashOfLeaves(brick.FirstLeaf, brick.EndLeaf);
  }
}

const HexBricks::Level& HexBricks::AtLevel(int level, ThreadPool& pool) const
{
  if (level < 1)
  {
    throw Error("Coarser levels of a mesh begin at 1");
  }
  const std::lock_guard<std::mutex> lock(this->LevelsMutex);
  while (static_cast<int>(this->Levels.size()) < level)
  {
    Level made = this->MakeNext(pool);
    const ElementOctree& tree = made.Bricks->Tree();
    const std::size_t bytes =
      tree.Bytes() + tree.Mesh().ConnectivityBytes() + made.NodeOfPoint.Bytes();
    this->Keep(std::move(made), bytes);
  }
  return *this->Levels[static_cast<std::size_t>(level) - 1];
}

/// From the coarsest one that there is.
HexBricks::Level HexBricks::MakeNext(ThreadPool& pool) const
{
  const Level* const finer = this->Levels.empty() ? nullptr : this->Levels.back().get();
  CoarserOctree coarser = CoarserOctreeOf(
    finer ? finer->Bricks->Tree() : this->Tree(), static_cast<int>(this->Levels.size()) + 1, pool);
  for (std::uint32_t& node : coarser.NodeOfPoint)
  {
    node = finer ? finer->NodeOfPoint[node] : node;
  }
  return { std::make_shared<const HexBricks>(coarser.Tree, 1 << this->EdgeLevel),
    std::move(coarser.NodeOfPoint) };
}

void HexBricks::Keep(Level level, std::size_t bytes) const
{
  this->BytesOfLevels += bytes + level.Bricks->Bytes();
  this->Levels.push_back(std::make_unique<const Level>(std::move(level)));
}

int HexBricks::LevelCount() const
{
  const std::lock_guard<std::mutex> lock(this->LevelsMutex);
  return static_cast<int>(this->Levels.size());
}

HexBricks::Level HexBricks::NextLevel(ThreadPool& pool) const
{
  const std::lock_guard<std::mutex> lock(this->LevelsMutex);
  return this->MakeNext(pool);
}

void HexBricks::AddLevel(std::shared_ptr<const ElementOctree> tree,
  HeldArray<std::uint32_t> nodeOfPoint, std::size_t bytes)
{
  Level level{ std::make_shared<const HexBricks>(std::move(tree), 1 << this->EdgeLevel),
    std::move(nodeOfPoint) };
  const std::lock_guard<std::mutex> lock(this->LevelsMutex);
  this->Keep(std::move(level), bytes);
}

std::size_t HexBricks::Bytes() const
{
  const std::lock_guard<std::mutex> lock(this->LevelsMutex);
  return this->Bricks.size() * sizeof(HexBrick) + this->BytesOfLevels;
}

void HexBricks::Cut(const Cube& cube)
{
  if (cube.FirstLeaf == cube.EndLeaf || this->TakeWhole(cube))
  {
    return;
  }
  const int level = cube.Level - 1;
  Cube part{ cube.Key, level, cube.FirstLeaf, cube.FirstLeaf };
  for (int child = 0; child < 8; ++child)
  {
    part.FirstLeaf = part.EndLeaf;
    part.EndLeaf = child == 7 ? cube.EndLeaf : this->Octree->LeafFrom(part.Key + CubeKeys(level));
    this->Cut(part);
    part.Key += CubeKeys(level);
  }
}

/// @return false when the cube has to be cut
bool HexBricks::TakeWhole(const Cube& cube)
{
  HexBrick brick;
  brick.Level = cube.Level;
  brick.FirstLeaf = cube.FirstLeaf;
  brick.EndLeaf = cube.EndLeaf;
  const int lowest = cube.Level - this->EdgeLevel;
  CubeExtent extent;
  std::int64_t filled = 0;
  for (std::int64_t leaf = cube.FirstLeaf; leaf < cube.EndLeaf; ++leaf)
  {
    const int level = this->Octree->LevelOfLeaf(leaf);
    if (level < lowest)
    {
      return false;
    }
    extent.Include(this->Octree->KeyOfLeaf(leaf), level);
    filled += static_cast<std::int64_t>(CubeKeys(level));
    brick.Level = std::min(brick.Level, level);
  }
  const Box box = extent.Around();
  if (filled != box.Count())
  {
    return false;
  }
  const int size = 1 << brick.Level;
  brick.Cells = { box.Lo / size, box.Hi / size };
  this->Bricks.push_back(brick);
  return true;
}

std::vector<std::int64_t> HexBricks::RanksFrontToBack(const Viewpoint& view) const
{
  std::vector<std::int64_t> ranks(this->Bricks.size());
  std::int64_t next = 0;
  this->Rank(view, 0, this->RootLevel, 0, this->Bricks.size(), next, ranks);
  return ranks;
}

/// @param first, end bricks inside the cube
void HexBricks::Rank(const Viewpoint& view, MortonKey key, int level, std::size_t first,
  std::size_t end, std::int64_t& next, std::vector<std::int64_t>& ranks) const
{
  if (end - first <= 1)
  {
    for (; first < end; ++first)
    {
      ranks[first] = next++;
    }
    return;
  }
  // The octant that the viewer looks from, and from there on as many steps away as bits differ.
  const auto nearest =
    static_cast<unsigned>(NearestOctant(view, glm::dvec3(PositionOfKey(key) + (1 << (level - 1)))));
  const MortonKey keys = CubeKeys(level - 1);
  std::size_t begins[9] = { first, 0, 0, 0, 0, 0, 0, 0, end };
  for (unsigned child = 1; child < 8; ++child)
  {
    const MortonKey from = key + child * keys;
    begins[child] = static_cast<std::size_t>(
      std::partition_point(this->Bricks.begin() + static_cast<std::ptrdiff_t>(first),
        this->Bricks.begin() + static_cast<std::ptrdiff_t>(end),
        [&](const HexBrick& brick) { return this->Octree->KeyOfLeaf(brick.FirstLeaf) < from; }) -
      this->Bricks.begin());
  }
  for (unsigned steps = 0; steps < 8; ++steps)
  {
    const unsigned child = nearest ^ steps;
    this->Rank(view, key + child * keys, level - 1, begins[child], begins[child + 1], next, ranks);
  }
}

} // namespace banyan
