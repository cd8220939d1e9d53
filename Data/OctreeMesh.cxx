// SPDX-License-Identifier: BSD-3-Clause
#include "OctreeMesh.h"

#include "OctreeMeshKeys.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>

namespace banyan
{

namespace
{

using Keys = OctreeMeshKeys;

void CheckShape(const OctreeMeshShape& shape)
{
  bool sound = shape.RootEdge > 0.0 && std::isfinite(shape.RootEdge) && shape.MaxLevel >= 0 &&
               shape.MaxLevel <= 15;
  for (const int roots : shape.Roots)
  {
    sound = sound && roots > 0 &&
            static_cast<std::int64_t>(roots) << shape.MaxLevel < 1 << Keys::CoordinateBits;
  }
  if (!sound)
  {
    throw Error("An octree mesh needs roots of positive size, at most 15 levels below them, and "
                "fewer than 2^20 of the smallest possible cells along each axis.");
  }
}

} // namespace

OctreeMesh::OctreeMesh(const OctreeMeshShape& shape, const TooLarge& tooLarge, ThreadPool& pool)
  : Layout(shape)
{
  CheckShape(shape);
  DividedCubes divided = DivideCubes(shape, tooLarge, pool);
  BalanceCubes(shape, divided);
  this->CellKeys = LeavesOf(shape, divided);
  this->FindNodes(pool);
  this->FindHangingNodes(divided, pool);
}

MeshOctant OctreeMesh::Cell(std::size_t cell) const
{
  const std::uint64_t key = this->CellKeys[cell];
  return { Keys::Place(key >> Keys::LevelBits), static_cast<int>(key & 15) };
}

double OctreeMesh::EdgeOfLevel(int level) const
{
  return std::ldexp(this->Layout.RootEdge, -level);
}

std::array<double, 3> OctreeMesh::CornerPoint(const MeshOctant& octant) const
{
  const double smallest = this->EdgeOfLevel(this->Layout.MaxLevel);
  std::array<double, 3> point;
  for (int axis = 0; axis < 3; ++axis)
  {
    point[axis] = this->Layout.Origin[axis] + smallest * octant.Corner[axis];
  }
  return point;
}

std::array<double, 3> OctreeMesh::Point(std::size_t node) const
{
  return this->CornerPoint({ Keys::Place(this->NodeKeys[node]), 0 });
}

std::size_t OctreeMesh::CellAt(const std::array<double, 3>& point) const
{
  const double smallest = this->EdgeOfLevel(this->Layout.MaxLevel);
  std::array<std::uint32_t, 3> place;
  for (int axis = 0; axis < 3; ++axis)
  {
    const double cells = std::ldexp(this->Layout.Roots[axis], this->Layout.MaxLevel);
    const double p = (point[axis] - this->Layout.Origin[axis]) / smallest;
    if (!(p >= 0.0 && p <= cells))
    {
      throw Error("A point that was looked for lies outside the mesh.");
    }
    place[axis] = static_cast<std::uint32_t>(std::min(p, cells - 1.0));
  }
  // Cubes are whole ranges of the curve: the last cell that does not begin behind the place.
  const auto after = std::upper_bound(
    this->CellKeys.begin(), this->CellKeys.end(), Keys::Cell(Keys::Morton(place), 15));
  return static_cast<std::size_t>(after - this->CellKeys.begin()) - 1;
}

void OctreeMesh::FindNodes(ThreadPool& pool)
{
  // Cells that are near on the curve share most of their corners: what is left of a batch when
  // duplicates are gone is little more than a node per cell.
  constexpr std::int64_t Batch = 1 << 15;
  const auto cells = static_cast<std::int64_t>(this->CellKeys.size());
  const std::int64_t batches = (cells + Batch - 1) / Batch;
  const auto corner = [this](std::int64_t cell, unsigned which)
  {
    MeshOctant octant = this->Cell(static_cast<std::size_t>(cell));
    for (int axis = 0; axis < 3; ++axis)
    {
      octant.Corner[axis] += (which >> axis & 1) << (this->Layout.MaxLevel - octant.Level);
    }
    return Keys::Morton(octant.Corner);
  };
  std::vector<std::vector<std::uint64_t>> parts(batches);
  pool.ParallelFor(batches,
    [&](std::int64_t batch)
    {
      auto& keys = parts[batch];
      for (std::int64_t cell = batch * Batch; cell < std::min(cells, (batch + 1) * Batch); ++cell)
      {
        for (unsigned which = 0; which < 8; ++which)
        {
          keys.push_back(corner(cell, which));
        }
      }
      std::sort(keys.begin(), keys.end());
      keys.erase(std::unique(keys.begin(), keys.end()), keys.end());
      keys.shrink_to_fit();
    });
  for (auto& part : parts)
  {
    this->NodeKeys.insert(this->NodeKeys.end(), part.begin(), part.end());
    part = {};
  }
  std::sort(this->NodeKeys.begin(), this->NodeKeys.end());
  this->NodeKeys.erase(
    std::unique(this->NodeKeys.begin(), this->NodeKeys.end()), this->NodeKeys.end());
  if (this->NodeKeys.size() > UINT32_MAX)
  {
    throw Error("An octree mesh can have at most 4294967295 nodes.");
  }
  this->CellCorners.resize(this->CellKeys.size());
  pool.ParallelFor(batches,
    [&](std::int64_t batch)
    {
      for (std::int64_t cell = batch * Batch; cell < std::min(cells, (batch + 1) * Batch); ++cell)
      {
        for (unsigned which = 0; which < 8; ++which)
        {
          this->CellCorners[cell][which] = this->NodeAt(corner(cell, which));
        }
      }
    });
}

std::uint32_t OctreeMesh::NodeAt(std::uint64_t morton) const
{
  const auto found = std::lower_bound(this->NodeKeys.begin(), this->NodeKeys.end(), morton);
  return static_cast<std::uint32_t>(found - this->NodeKeys.begin());
}

} // namespace banyan
