// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Octree/OctreeFinder.h"

#include <cmath>
#include <cstdlib>
#include <new>

namespace banyan
{

/// Holds what is found about a run of points.
struct NodeFinder::Found
{
  std::vector<HangingNode> Hanging;
  std::vector<TwinNode> Twins;
  std::int64_t Unbalanced = 0;
};

NodeFinder::NodeFinder(ElementOctree& tree, ThreadPool& pool)
  : Tree(tree)
  , Pool(pool)
  // Zeros that take memory only where they are written to: pieces of meshes may use few of the
  // points.
  , Octants(static_cast<std::atomic<std::uint8_t>*>(
              std::calloc(static_cast<std::size_t>(tree.Cells.PointCount), 1)),
      std::free)
{
  static_assert(sizeof(std::atomic<std::uint8_t>) == 1, "one byte per point");
  if (!this->Octants)
  {
    throw std::bad_alloc();
  }
}

void NodeFinder::Find()
{
  this->MarkCorners();
  constexpr std::int64_t run = 1 << 16;
  const std::int64_t points = this->Tree.Cells.PointCount;
  std::vector<Found> parts(static_cast<std::size_t>((points + run - 1) / run));
  this->Pool.ParallelFor(static_cast<std::int64_t>(parts.size()),
    [&](std::int64_t part)
    {
      const std::int64_t end = std::min(points, (part + 1) * run);
      for (std::int64_t node = part * run; node < end; ++node)
      {
        const unsigned mask = this->Octants.get()[node].load(std::memory_order_relaxed);
        if (mask != 0 && mask != 0xff)
        {
          this->Look(node, mask, parts[static_cast<std::size_t>(part)]);
        }
      }
    });
  std::vector<HangingNode> hanging;
  std::vector<TwinNode> twins;
  for (const Found& part : parts)
  {
    hanging.insert(hanging.end(), part.Hanging.begin(), part.Hanging.end());
    twins.insert(twins.end(), part.Twins.begin(), part.Twins.end());
    this->Tree.Unbalanced += part.Unbalanced;
  }
  std::stable_sort(hanging.begin(), hanging.end(),
    [this](const HangingNode& a, const HangingNode& b)
    { return this->Tree.LevelOfLeaf(a.Leaf) > this->Tree.LevelOfLeaf(b.Leaf); });
  this->Tree.HangingNodes = std::move(hanging);
  this->Tree.TwinNodes = std::move(twins);
}

void NodeFinder::MarkCorners()
{
  constexpr std::int64_t run = 1 << 14;
  const std::int64_t cells = this->Tree.LeafCount(); // each is a leaf
  std::atomic<std::uint8_t>* const octants = this->Octants.get();
  this->Pool.ParallelFor((cells + run - 1) / run,
    [&](std::int64_t part)
    {
      std::int64_t nodes[8];
      for (std::int64_t cell = part * run; cell < std::min(cells, (part + 1) * run); ++cell)
      {
        this->Tree.NodesOfCell(cell, nodes);
        for (unsigned corner = 0; corner < 8; ++corner)
        {
          // A leaf lies on the other side of its corner. Octants are numbered as those of
          // LargestLeafAround: a bit is set below the point.
          octants[nodes[corner]].fetch_or(
            static_cast<std::uint8_t>(1u << corner), std::memory_order_relaxed);
        }
      }
    });
}

glm::ivec3 NodeFinder::PositionOf(std::int64_t node) const
{
  glm::ivec3 position;
  DispatchMesh(this->Tree.Cells,
    [&](const auto* points, const auto*)
    {
      for (int axis = 0; axis < 3; ++axis)
      {
        const double exact =
          (points[3 * node + axis] - this->Tree.LatticeOrigin[axis]) / this->Tree.FinestEdge[axis];
        position[axis] = static_cast<int>(std::floor(exact + 0.5));
      }
    });
  return position;
}

/// Looks at the octants around a point that no leaf with this point as a corner covers.
void NodeFinder::Look(std::int64_t node, unsigned mask, Found& found) const
{
  const ElementOctree& tree = this->Tree;
  const glm::ivec3 at = this->PositionOf(node);
  std::int64_t largest = -1;
  std::int64_t first = node;
  for (unsigned octant = 0; octant < 8; ++octant)
  {
    if ((mask >> octant & 1) != 0)
    {
      continue;
    }
    const std::int64_t leaf =
      tree.LeafAt(at - glm::ivec3(octant & 1, octant >> 1 & 1, octant >> 2));
    if (leaf < 0)
    {
      continue;
    }
    const glm::ivec3 in = at - tree.CornerOfLeaf(leaf);
    const int edge = 1 << tree.LevelOfLeaf(leaf);
    const bool corner =
      (in.x & (edge - 1)) == 0 && (in.y & (edge - 1)) == 0 && (in.z & (edge - 1)) == 0;
    if (corner)
    {
      std::int64_t nodes[8];
      tree.NodesOfLeaf(leaf, nodes);
      first = std::min(first, nodes[octant]);
    }
    else if (largest < 0 || tree.LevelOfLeaf(leaf) > tree.LevelOfLeaf(largest))
    {
      largest = leaf;
    }
  }
  if (largest >= 0)
  {
    const glm::vec3 in(at - tree.CornerOfLeaf(largest));
    const auto edge = static_cast<float>(1 << tree.LevelOfLeaf(largest));
    found.Hanging.push_back({ node, largest, in / edge });
    const glm::vec3 doubled = found.Hanging.back().Part * 2.0f;
    found.Unbalanced += doubled == glm::floor(doubled) ? 0 : 1;
  }
  else if (first != node)
  {
    found.Twins.push_back({ node, first });
  }
}

} // namespace banyan
