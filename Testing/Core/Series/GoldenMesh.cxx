// SPDX-License-Identifier: BSD-3-Clause
#include "Series/GoldenMesh.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>

namespace banyan::testing
{
namespace
{

constexpr std::uint8_t Voxel = 11, Hexahedron = 12; // VTK's numbers
constexpr int CornerOfHexahedron[] = { 0, 1, 3, 2, 4, 5, 7, 6 };

struct Cell
{
  glm::ivec3 Low;
  int Edge;
};

/// 3 x 2 x 2 cells, one of them divided into 8. Their order is none that the file sorts by.
std::vector<Cell> Cells()
{
  std::vector<Cell> cells;
  for (int i = 11; i >= 0; --i)
  {
    const glm::ivec3 low{ 2 * (i % 3), 2 * (i / 3 % 2), 2 * (i / 6) };
    for (int c = 0; i == 4 && c < 8; ++c)
    {
      cells.push_back({ low + glm::ivec3{ c >> 2, c >> 1 & 1, c & 1 }, 1 });
    }
    if (i != 4)
    {
      cells.push_back({ low, 2 });
    }
  }
  return cells;
}

} // namespace

GoldenMesh::GoldenMesh()
{
  std::vector<std::int64_t> ids;
  std::vector<std::uint8_t> types;
  for (const Cell& cell : banyan::testing::Cells())
  {
    this->Cells.push_back(cell.Low);
    types.push_back(types.size() % 5 == 3 ? Voxel : Hexahedron);
    for (int corner = 0; corner < 8; ++corner)
    {
      const int c = types.back() == Voxel ? corner : CornerOfHexahedron[corner];
      const glm::ivec3 place = cell.Low + cell.Edge * glm::ivec3{ c & 1, c >> 1 & 1, c >> 2 };
      const auto found = std::find(this->Points.begin(), this->Points.end(), place);
      ids.push_back(found - this->Points.begin());
      if (found == this->Points.end())
      {
        this->Points.push_back(place);
      }
    }
  }
  this->Points.push_back({ 9, 9, 9 });
  std::vector<float> points;
  for (const glm::ivec3& p : this->Points)
  {
    points.insert(points.end(),
      { 0.1f * static_cast<float>(p.x), static_cast<float>(p.y), 3.0f * static_cast<float>(p.z) });
  }
  HexMesh mesh;
  mesh.Points = points.data();
  mesh.PointCount = static_cast<std::int64_t>(this->Points.size());
  mesh.Connectivity = ids.data();
  mesh.CellCount = static_cast<std::int64_t>(types.size());
  ThreadPool pool(1);
  this->Mesh = StoreMesh(*ElementOctree::Find(mesh, pool), types.data());
}

} // namespace banyan::testing
