// SPDX-License-Identifier: BSD-3-Clause
// The hanging nodes of an OctreeMesh.
#include "OctreeMeshKeys.h"

#include "Base/ThreadPool.h"

#include <algorithm>

namespace banyan
{

namespace
{

using Keys = OctreeMeshKeys;
using Place = std::array<std::uint32_t, 3>;

/// Finds where a divided cube touches undivided ones of its own size.
class HangingFinder
{
public:
  HangingFinder(const OctreeMeshShape& shape, const std::vector<std::uint64_t>& cells)
    : Shape(shape)
    , Cells(cells)
  {
  }

  /// Calls visit(middle, ends...) for the middles of the faces and edges that the cube shares with
  /// cells of its size; an edge may come more than once. Corners are those of `MeshHangingNode`.
  template <typename Visit>
  void ForCube(std::uint64_t cube, int level, const Visit& visit) const
  {
    const Place corner = Keys::Place(cube);
    const std::uint32_t half = 1u << (this->Shape.MaxLevel - level) >> 1;
    for (int axis = 0; axis < 3; ++axis)
    {
      const int a = (axis + 1) % 3, b = (axis + 2) % 3;
      for (int side = 0; side < 2; ++side)
      {
        Place direction{};
        direction[axis] = side ? 1u : ~0u;
        if (this->IsCell(corner, direction, level))
        {
          this->VisitFace(corner, axis, side, half, visit);
        }
      }
      for (int sides = 0; sides < 4; ++sides)
      {
        Place direction{};
        direction[a] = sides & 1 ? 1u : ~0u;
        direction[b] = sides & 2 ? 1u : ~0u;
        if (this->IsCell(corner, direction, level))
        {
          this->VisitEdge(corner, axis, sides, half, visit);
        }
      }
    }
  }

private:
  /// Whether the neighbour of a cube is a cell of the same size. Steps down are 2^32 - 1.
  bool IsCell(Place corner, const Place& direction, int level) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      corner[axis] += direction[axis] << (this->Shape.MaxLevel - level);
      if (corner[axis] >= static_cast<std::uint32_t>(this->Shape.Roots[axis])
                            << this->Shape.MaxLevel)
      {
        return false;
      }
    }
    return std::binary_search(
      this->Cells.begin(), this->Cells.end(), Keys::Cell(Keys::Morton(corner), level));
  }

  template <typename Visit>
  void VisitFace(
    const Place& corner, int axis, int side, std::uint32_t half, const Visit& visit) const
  {
    const int a = (axis + 1) % 3, b = (axis + 2) % 3;
    Place base = corner;
    base[axis] += side * 2 * half;
    std::array<Place, 4> corners;
    for (int i = 0; i < 4; ++i)
    {
      corners[i] = base;
      corners[i][a] += (i & 1) * 2 * half;
      corners[i][b] += (i >> 1) * 2 * half;
    }
    Place middle = base;
    middle[a] += half;
    middle[b] += half;
    visit(middle, corners);
    for (const auto [i, j] : { std::array{ 0, 1 }, { 2, 3 }, { 0, 2 }, { 1, 3 } })
    {
      VisitBetween(corners[i], corners[j], visit);
    }
  }

  template <typename Visit>
  void VisitEdge(
    const Place& corner, int axis, int sides, std::uint32_t half, const Visit& visit) const
  {
    Place low = corner;
    low[(axis + 1) % 3] += (sides & 1) * 2 * half;
    low[(axis + 2) % 3] += (sides >> 1) * 2 * half;
    Place high = low;
    high[axis] += 2 * half;
    VisitBetween(low, high, visit);
  }

  template <typename Visit>
  static void VisitBetween(const Place& low, const Place& high, const Visit& visit)
  {
    Place middle;
    for (int axis = 0; axis < 3; ++axis)
    {
      middle[axis] = low[axis] + (high[axis] - low[axis]) / 2;
    }
    visit(middle, std::array<Place, 4>{ low, high, low, high });
  }

  const OctreeMeshShape& Shape;
  const std::vector<std::uint64_t>& Cells;
};

} // namespace

void OctreeMesh::FindHangingNodes(
  const std::vector<std::vector<std::uint64_t>>& divided, ThreadPool& pool)
{
  constexpr std::int64_t Batch = 4096;
  const auto byNode = [](const MeshHangingNode& a, const MeshHangingNode& b)
  { return a.Node < b.Node; };
  const auto same = [](const MeshHangingNode& a, const MeshHangingNode& b)
  { return a.Node == b.Node; };
  const HangingFinder finder(this->Layout, this->CellKeys);
  std::vector<MeshHangingNode>& all = this->HangingNodes;
  for (int level = 0; level < static_cast<int>(divided.size()); ++level)
  {
    const auto count = static_cast<std::int64_t>(divided[level].size());
    std::vector<std::vector<MeshHangingNode>> parts((count + Batch - 1) / Batch);
    pool.ParallelFor(static_cast<std::int64_t>(parts.size()),
      [&](std::int64_t batch)
      {
        auto& part = parts[batch];
        const std::int64_t end = std::min(count, (batch + 1) * Batch);
        for (std::int64_t i = batch * Batch; i < end; ++i)
        {
          finder.ForCube(divided[level][i], level,
            [&](const Place& middle, const std::array<Place, 4>& corners)
            {
              MeshHangingNode node;
              node.Node = this->NodeAt(Keys::Morton(middle));
              for (int m = 0; m < 4; ++m)
              {
                node.Masters[m] = this->NodeAt(Keys::Morton(corners[m]));
              }
              part.push_back(node);
            });
        }
        std::sort(part.begin(), part.end(), byNode);
        part.erase(std::unique(part.begin(), part.end(), same), part.end());
      });
    for (auto& part : parts)
    {
      all.insert(all.end(), part.begin(), part.end());
      part = {};
    }
  }
  std::sort(all.begin(), all.end(), byNode);
  all.erase(std::unique(all.begin(), all.end(), same), all.end());
  all.shrink_to_fit();
}

} // namespace banyan
