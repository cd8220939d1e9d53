// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Cells/GatheredCells.h"

#include "Parallel/Communicate/Collective.h"

#include <cstring>
#include <string>
#include <utility>

namespace banyan
{
namespace
{

/// A mesh of Kind::Cells with its arrays.
struct OwnedCells
{
  std::vector<double> Points;
  std::vector<std::int64_t> Ids;
  std::vector<std::int64_t> Offsets{ 0 };
  std::vector<std::uint8_t> Types;
};

/// A type of VTK whose corners stand as those of MeshCell.
std::uint8_t TypeOf(CellShape shape)
{
  switch (shape)
  {
    case CellShape::Tetrahedron:
      return 10;
    case CellShape::Hexahedron:
      return 11; // a voxel, x fastest
    case CellShape::Wedge:
      return 13;
    case CellShape::Pyramid:
      return 14;
    default:
      return 0;
  }
}

/// All cells and points: cells that are not drawn keep their number, and have no points.
OwnedCells CopyOf(const CellMesh& mesh)
{
  OwnedCells copy;
  copy.Points.reserve(3 * static_cast<std::size_t>(mesh.PointCount));
  for (std::int64_t point = 0; point < mesh.PointCount; ++point)
  {
    const glm::dvec3 at = mesh.Point(point);
    copy.Points.insert(copy.Points.end(), { at.x, at.y, at.z });
  }
  for (std::int64_t number = 0; number < mesh.CellCount; ++number)
  {
    const MeshCell cell = mesh.Cell(number);
    const auto corners = static_cast<std::ptrdiff_t>(CornersOf(cell.Shape));
    copy.Ids.insert(copy.Ids.end(), cell.Points.begin(), cell.Points.begin() + corners);
    copy.Offsets.push_back(static_cast<std::int64_t>(copy.Ids.size()));
    copy.Types.push_back(TypeOf(cell.Shape));
  }
  return copy;
}

template <class T>
std::vector<std::vector<T>> FromAll(Communicator& communicator, const std::vector<T>& mine)
{
  std::vector<std::vector<T>> all;
  for (const std::string& bytes : AllGatherStrings(communicator,
         std::string(reinterpret_cast<const char*>(mine.data()), mine.size() * sizeof(T))))
  {
    all.emplace_back(bytes.size() / sizeof(T));
    std::memcpy(all.back().data(), bytes.data(), bytes.size());
  }
  return all;
}

} // namespace

CellMesh GatherCells(Communicator& communicator, const CellMesh& piece)
{
  if (communicator.Size() == 1)
  {
    return piece;
  }
  OwnedCells mine;
  Collective(communicator, [&] { mine = CopyOf(piece); });
  auto all = std::make_shared<OwnedCells>();
  const auto points = FromAll(communicator, mine.Points);
  const auto ids = FromAll(communicator, mine.Ids);
  const auto offsets = FromAll(communicator, mine.Offsets);
  const auto types = FromAll(communicator, mine.Types);
  Collective(communicator,
    [&]
    {
      for (std::size_t rank = 0; rank < points.size(); ++rank)
      {
        const auto firstPoint = static_cast<std::int64_t>(all->Points.size() / 3);
        const auto firstId = static_cast<std::int64_t>(all->Ids.size());
        all->Points.insert(all->Points.end(), points[rank].begin(), points[rank].end());
        all->Types.insert(all->Types.end(), types[rank].begin(), types[rank].end());
        for (const std::int64_t id : ids[rank])
        {
          all->Ids.push_back(firstPoint + id);
        }
        for (std::size_t i = 1; i < offsets[rank].size(); ++i)
        {
          all->Offsets.push_back(firstId + offsets[rank][i]);
        }
      }
    });
  CellMesh mesh;
  mesh.Points = all->Points.data();
  mesh.PointType = ScalarType::Float64;
  mesh.PointCount = static_cast<std::int64_t>(all->Points.size() / 3);
  mesh.Connectivity = all->Ids.data();
  mesh.ConnectivityCount = static_cast<std::int64_t>(all->Ids.size());
  mesh.Offsets = all->Offsets.data();
  mesh.Types = all->Types.data();
  mesh.CellCount = static_cast<std::int64_t>(all->Types.size());
  mesh.Owner = all;
  return mesh;
}

std::vector<float> GatherFloats(Communicator& communicator, std::vector<float> mine)
{
  if (communicator.Size() == 1)
  {
    return mine;
  }
  std::vector<float> all;
  for (const std::vector<float>& part : FromAll(communicator, mine))
  {
    all.insert(all.end(), part.begin(), part.end());
  }
  return all;
}

} // namespace banyan
