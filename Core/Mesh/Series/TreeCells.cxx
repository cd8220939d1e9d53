// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/TreeCells.h"

#include "Mesh/Series/MeshLevel.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// Where a point of the mesh lies, in finest cells.
glm::ivec3 PlaceOf(const StoredMesh& mesh, std::int64_t point)
{
  glm::ivec3 place;
  const auto read = [&](const auto* points)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      place[axis] = static_cast<int>(
        std::floor((points[3 * point + axis] - mesh.Origin[axis]) / mesh.Edge[axis] + 0.5));
    }
  };
  if (mesh.PointType == ScalarType::Float64)
  {
    read(reinterpret_cast<const double*>(mesh.Points.data()));
  }
  else
  {
    read(reinterpret_cast<const float*>(mesh.Points.data()));
  }
  return place;
}

void TakeMesh(const StoredMesh& mesh, TreeCells& cells)
{
  cells.Leaves = mesh.Leaves;
  cells.Corners.reserve(8 * static_cast<std::size_t>(mesh.CellCount()));
  for (std::size_t leaf = 0; leaf < static_cast<std::size_t>(mesh.CellCount()); ++leaf)
  {
    cells.FirstCell.push_back(static_cast<std::uint32_t>(leaf));
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
      cells.Corners.push_back(mesh.PointAt(leaf, corner));
    }
  }
}

void TakeCoarser(const StoredMesh& mesh, int level, TreeCells& cells)
{
  MeshCells coarser = CoarserCells(mesh, level);
  cells.Corners = std::move(coarser.Connectivity);
  cells.FirstCell = std::move(coarser.FirstLeaf);
  for (std::size_t i = 0; i < cells.Corners.size(); i += 8)
  {
    const glm::ivec3 low = PlaceOf(mesh, cells.Corners[i]);
    const int edge = PlaceOf(mesh, cells.Corners[i + 7]).x - low.x;
    cells.Leaves.Keys.push_back(KeyOf(low));
    cells.Leaves.Levels.push_back(static_cast<std::uint8_t>(std::lround(std::log2(edge))));
  }
}

} // namespace

TreeCells TreeCellsOf(const StoredMesh& mesh, int level)
{
  TreeCells cells;
  if (level == 0)
  {
    TakeMesh(mesh, cells);
  }
  else
  {
    TakeCoarser(mesh, level, cells);
  }
  cells.FirstCell.push_back(static_cast<std::uint32_t>(mesh.CellCount()));
  if (cells.Leaves.Keys.empty())
  {
    return cells;
  }
  glm::ivec3 low(std::numeric_limits<int>::max()), high(0);
  int coarsest = 0;
  for (std::size_t leaf = 0; leaf < cells.Leaves.Keys.size(); ++leaf)
  {
    const glm::ivec3 corner = PositionOfKey(cells.Leaves.Keys[leaf]);
    low = glm::min(low, corner);
    high = glm::max(high, corner + (1 << cells.Leaves.Levels[leaf]));
    coarsest = std::max(coarsest, int{ cells.Leaves.Levels[leaf] });
  }
  const auto roots = [&](int at, glm::ivec3& first)
  {
    first = low >> at;
    return ((high - 1) >> at) + 1 - first;
  };
  for (int at = coarsest; at <= MortonBits; ++at)
  {
    glm::ivec3 first;
    const glm::ivec3 count = roots(at, first);
    const bool ends = (first << at) == low && ((first + count) << at) == high;
    const bool enough = std::int64_t{ count.x } * count.y * count.z >= TreeCells::FewestTrees;
    if (at == coarsest || (ends && enough))
    {
      cells.RootLevel = at;
      cells.FirstRoot = first;
      cells.Roots = count;
    }
  }
  return cells;
}

} // namespace banyan
