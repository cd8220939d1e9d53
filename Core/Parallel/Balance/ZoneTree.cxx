// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/ZoneTree.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <tuple>

namespace banyan
{
namespace
{

int LongestAxis(const glm::ivec3& size)
{
  // The last one of equally long axes is taken: values of a zone then lie closer together in files
  // and memory.
  int axis = 2;
  for (int other = 1; other >= 0; --other)
  {
    axis = size[other] > size[axis] ? other : axis;
  }
  return axis;
}

std::int64_t CeilDivide(std::int64_t a, std::int64_t b)
{
  return (a + b - 1) / b;
}

/// Gives `zone` to the ranks from `first` on. @return the number of the node
int Split(ZoneTree& tree, const Box& zone, int first, int ranks)
{
  const int number = static_cast<int>(tree.Nodes.size());
  tree.Nodes.emplace_back();
  tree.Nodes.back().FirstRank = first;
  tree.Nodes.back().Ranks = ranks;
  if (ranks == 1)
  {
    return number;
  }
  const int axis = LongestAxis(zone.Size());
  const std::int64_t length = zone.Size()[axis];
  const std::int64_t slab = length > 0 ? zone.Count() / length : 0;

  // The plane stands where the positions divide in the ratio of the ranks; of all ways to divide
  // the ranks the one whose fullest rank has the fewest positions, then the most even one.
  using Quality = std::tuple<std::int64_t, int, int>;
  Quality best{ INT64_MAX, 0, 0 };
  int bestLeft = 1;
  std::int64_t bestPosition = 0;
  for (int left = 1; left < ranks; ++left)
  {
    const std::int64_t position = (2 * length * left + ranks) / (2 * ranks);
    const std::int64_t fullest = std::max(
      CeilDivide(position * slab, left), CeilDivide((length - position) * slab, ranks - left));
    const Quality quality{ fullest, std::abs(2 * left - ranks), left };
    if (quality < best)
    {
      best = quality;
      bestLeft = left;
      bestPosition = position;
    }
  }
  Box low = zone;
  Box high = zone;
  low.Hi[axis] = high.Lo[axis] = zone.Lo[axis] + static_cast<int>(bestPosition);
  const int below = Split(tree, low, first, bestLeft);
  const int above = Split(tree, high, first + bestLeft, ranks - bestLeft);
  ZoneTree::Node& node = tree.Nodes[static_cast<std::size_t>(number)];
  node.Axis = axis;
  node.Plane = low.Hi[axis];
  node.Below = below;
  node.Above = above;
  return number;
}

bool Finite(const glm::dvec3& v)
{
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

void Walk(const Viewpoint& view, const ZoneTree& tree, int number, std::vector<int>& order)
{
  const ZoneTree::Node& node = tree.Nodes[static_cast<std::size_t>(number)];
  if (node.IsLeaf())
  {
    order.push_back(node.FirstRank);
    return;
  }
  const bool belowFirst =
    view.Parallel ? view.Direction[node.Axis] >= 0.0 : view.Eye[node.Axis] <= node.Plane;
  Walk(view, tree, belowFirst ? node.Below : node.Above, order);
  Walk(view, tree, belowFirst ? node.Above : node.Below, order);
}

} // namespace

bool operator==(const ZoneTree& a, const ZoneTree& b)
{
  return a.Positions == b.Positions &&
         std::equal(a.Nodes.begin(), a.Nodes.end(), b.Nodes.begin(), b.Nodes.end(),
           [](const ZoneTree::Node& x, const ZoneTree::Node& y)
           {
             return x.Axis == y.Axis && x.Plane == y.Plane && x.Below == y.Below &&
                    x.Above == y.Above && x.FirstRank == y.FirstRank && x.Ranks == y.Ranks;
           });
}

ZoneTree EqualZoneTree(const glm::ivec3& positions, int ranks)
{
  if (ranks < 1)
  {
    throw Error("Zones need at least one rank, not " + std::to_string(ranks) + ".");
  }
  ZoneTree tree;
  tree.Positions = glm::max(positions, glm::ivec3(0));
  tree.Nodes.reserve(2 * static_cast<std::size_t>(ranks));
  Split(tree, tree.Whole(), 0, ranks);
  return tree;
}

std::vector<Box> NodeZones(const ZoneTree& tree)
{
  std::vector<Box> zones(tree.Nodes.size());
  if (!zones.empty())
  {
    zones.front() = tree.Whole();
  }
  for (std::size_t number = 0; number < zones.size(); ++number)
  {
    const ZoneTree::Node& node = tree.Nodes[number];
    if (!node.IsLeaf())
    {
      Box low = zones[number];
      Box high = zones[number];
      low.Hi[node.Axis] = high.Lo[node.Axis] = node.Plane;
      zones[static_cast<std::size_t>(node.Below)] = low;
      zones[static_cast<std::size_t>(node.Above)] = high;
    }
  }
  return zones;
}

std::vector<Box> ZonesOf(const ZoneTree& tree)
{
  const std::vector<Box> all = NodeZones(tree);
  std::vector<Box> zones(static_cast<std::size_t>(tree.Ranks()));
  for (std::size_t number = 0; number < all.size(); ++number)
  {
    if (tree.Nodes[number].IsLeaf())
    {
      zones[static_cast<std::size_t>(tree.Nodes[number].FirstRank)] = all[number];
    }
  }
  return zones;
}

ZoneTree Refined(const ZoneTree& tree, int edge, const glm::ivec3& positions)
{
  ZoneTree fine = tree;
  fine.Positions = positions;
  for (ZoneTree::Node& node : fine.Nodes)
  {
    node.Plane = std::min(node.Plane * edge, positions[node.Axis]);
  }
  return fine;
}

std::vector<int> FrontToBack(const Viewpoint& view, const ZoneTree& tree)
{
  const glm::dvec3& used = view.Parallel ? view.Direction : view.Eye;
  if (!Finite(used) || (view.Parallel && used == glm::dvec3(0.0)))
  {
    throw Error("The camera has no position or direction that could order the data.");
  }
  std::vector<int> order;
  if (!tree.Nodes.empty())
  {
    Walk(view, tree, 0, order);
  }
  const std::vector<Box> zones = ZonesOf(tree);
  std::stable_partition(order.begin(), order.end(),
    [&](int rank) { return !zones[static_cast<std::size_t>(rank)].Empty(); });
  return order;
}

} // namespace banyan
