// SPDX-License-Identifier: BSD-3-Clause
// Which cubes an OctreeMesh is made of: division and balance.
#include "OctreeMeshKeys.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <iterator>

namespace banyan
{

namespace
{

using Keys = OctreeMeshKeys;

void SortUnique(std::vector<std::uint64_t>& keys)
{
  std::sort(keys.begin(), keys.end());
  keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
}

std::vector<std::uint64_t> RootKeys(const OctreeMeshShape& shape)
{
  std::vector<std::uint64_t> roots;
  for (int z = 0; z < shape.Roots[2]; ++z)
  {
    for (int y = 0; y < shape.Roots[1]; ++y)
    {
      for (int x = 0; x < shape.Roots[0]; ++x)
      {
        roots.push_back(Keys::Morton({ static_cast<std::uint32_t>(x) << shape.MaxLevel,
          static_cast<std::uint32_t>(y) << shape.MaxLevel,
          static_cast<std::uint32_t>(z) << shape.MaxLevel }));
      }
    }
  }
  std::sort(roots.begin(), roots.end());
  return roots;
}

/// The children of sorted cubes of one level, sorted.
std::vector<std::uint64_t> Children(
  const OctreeMeshShape& shape, const std::vector<std::uint64_t>& cubes, int level)
{
  std::vector<std::uint64_t> children;
  children.reserve(8 * cubes.size());
  const int shift = 3 * (shape.MaxLevel - level - 1);
  for (const std::uint64_t cube : cubes)
  {
    for (std::uint64_t child = 0; child < 8; ++child)
    {
      children.push_back(cube | child << shift);
    }
  }
  return children;
}

/// Calls visit(key) for the parent of a cube, and for the parents of its neighbours across faces
/// and edges: they all must have children where the cube has.
template <typename Visit>
void ForParents(const OctreeMeshShape& shape, std::uint64_t cube, int level, const Visit& visit)
{
  const auto place = Keys::Place(cube);
  const int shift = shape.MaxLevel - level;
  std::array<std::uint32_t, 3> parent, beside;
  std::array<bool, 3> inside;
  for (int axis = 0; axis < 3; ++axis)
  {
    const std::uint32_t size = 2u << shift;
    parent[axis] = place[axis] & ~(size - 1);
    // In a parent, a cube touches the neighbours on its own side only.
    const bool upper = place[axis] & size / 2;
    beside[axis] = upper ? parent[axis] + size : parent[axis] - size;
    inside[axis] = upper ? beside[axis] < static_cast<std::uint32_t>(shape.Roots[axis])
                                            << shape.MaxLevel
                         : parent[axis] > 0;
  }
  for (unsigned which = 0; which < 7; ++which)
  {
    auto other = parent;
    bool exists = true;
    for (int axis = 0; axis < 3; ++axis)
    {
      if (which >> axis & 1)
      {
        other[axis] = beside[axis];
        exists = exists && inside[axis];
      }
    }
    if (exists)
    {
      visit(Keys::Morton(other));
    }
  }
}

} // namespace

DividedCubes DivideCubes(
  const OctreeMeshShape& shape, const OctreeMesh::TooLarge& tooLarge, ThreadPool& pool)
{
  DividedCubes divided;
  std::vector<std::uint64_t> cubes = RootKeys(shape);
  for (int level = 0; level < shape.MaxLevel; ++level)
  {
    constexpr std::int64_t Batch = 1024;
    const auto count = static_cast<std::int64_t>(cubes.size());
    std::vector<char> large(cubes.size());
    pool.ParallelFor((count + Batch - 1) / Batch,
      [&](std::int64_t batch)
      {
        const std::int64_t end = std::min(count, (batch + 1) * Batch);
        for (std::int64_t i = batch * Batch; i < end; ++i)
        {
          large[i] = tooLarge({ Keys::Place(cubes[i]), level });
        }
      });
    std::vector<std::uint64_t> found;
    for (std::size_t i = 0; i < cubes.size(); ++i)
    {
      if (large[i])
      {
        found.push_back(cubes[i]);
      }
    }
    cubes = Children(shape, found, level);
    divided.push_back(std::move(found));
  }
  return divided;
}

void BalanceCubes(const OctreeMeshShape& shape, DividedCubes& divided)
{
  for (int level = shape.MaxLevel - 1; level > 0; --level)
  {
    std::vector<std::uint64_t> parents;
    for (const std::uint64_t cube : divided[level])
    {
      ForParents(shape, cube, level,
        [&](std::uint64_t parent)
        {
          // Neighbours on the curve have mostly the same parents.
          const std::size_t recent = std::min<std::size_t>(parents.size(), 7);
          if (std::find(parents.end() - recent, parents.end(), parent) == parents.end())
          {
            parents.push_back(parent);
          }
        });
    }
    auto& above = divided[level - 1];
    above.insert(above.end(), parents.begin(), parents.end());
    SortUnique(above);
  }
}

std::vector<std::uint64_t> LeavesOf(const OctreeMeshShape& shape, const DividedCubes& divided)
{
  std::vector<std::uint64_t> leaves, cubes = RootKeys(shape);
  leaves.reserve(CountLeaves(shape, divided));
  for (int level = 0; level <= shape.MaxLevel; ++level)
  {
    if (level == shape.MaxLevel)
    {
      for (const std::uint64_t cube : cubes)
      {
        leaves.push_back(Keys::Cell(cube, level));
      }
      break;
    }
    std::vector<std::uint64_t> whole;
    std::set_difference(cubes.begin(), cubes.end(), divided[level].begin(), divided[level].end(),
      std::back_inserter(whole));
    for (const std::uint64_t cube : whole)
    {
      leaves.push_back(Keys::Cell(cube, level));
    }
    cubes = Children(shape, divided[level], level);
  }
  std::sort(leaves.begin(), leaves.end());
  return leaves;
}

std::size_t CountLeaves(const OctreeMeshShape& shape, const DividedCubes& divided)
{
  std::size_t count = static_cast<std::size_t>(shape.Roots[0]) * shape.Roots[1] * shape.Roots[2];
  for (const auto& cubes : divided)
  {
    count += 7 * cubes.size();
  }
  return count;
}

} // namespace banyan
