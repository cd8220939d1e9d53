// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_CellSeries_CellsFileParts_h
#define banyan_Mesh_CellSeries_CellsFileParts_h

#include "Mesh/CellSeries/StoredCells.h"

#include <algorithm>
#include <map>
#include <utility>

// What writing and reading the files of a mesh of cells have in common.
namespace banyan::cells_file
{

constexpr char MeshMagic[8] = { 'B', 'a', 'n', 'y', 'a', 'n', 'C', 'e' };
constexpr char PointsMagic[8] = { 'B', 'a', 'n', 'y', 'a', 'n', 'M', 'p' };
constexpr std::uint32_t Version = 1;

enum Section
{
  Head,
  Runs,       ///< of cells with one type and number of points
  Distances,  ///< by group: to the cell that another is predicted from
  Ids,        ///< points of cells, by group and corner, in planes of bytes
  FaceCounts, ///< of polyhedra
  FaceIds,    ///< places of their points in the list of the cell
  Points,     ///< coordinates, in planes of bytes
  Sections
};

enum PointsSection
{
  PointsHead,
  Moved, ///< coordinates, in planes of bytes
  PointsSections
};

/// Cells are predicted from one of the up to so many of their group before them.
constexpr std::uint64_t MostDistance = 64;

/// Cells of one type and number of points.
struct Group
{
  std::size_t Corners = 0;
  std::vector<std::uint32_t> Cells; ///< in order
};

/// The groups of a mesh whose types and offsets are known, in the order of their first cells.
/// Cells without points are in none.
inline std::vector<Group> GroupsOf(const StoredCells& mesh)
{
  std::vector<Group> groups;
  std::map<std::pair<std::uint8_t, std::size_t>, std::size_t> known;
  for (std::size_t cell = 0; cell < mesh.Types.size(); ++cell)
  {
    const std::size_t corners = mesh.SizeOfCell(cell);
    if (corners > 0)
    {
      const auto found = known.emplace(std::pair(mesh.Types[cell], corners), groups.size());
      if (found.second)
      {
        groups.push_back({ corners, {} });
      }
      groups[found.first->second].Cells.push_back(static_cast<std::uint32_t>(cell));
    }
  }
  return groups;
}

/// The point that a corner of a cell of a group is predicted to be, from those before it in the
/// order of cells and corners.
inline std::uint32_t ExpectedId(const StoredCells& mesh, const Group& group, std::size_t place,
  std::size_t corner, std::size_t distance)
{
  const auto at = [&](std::size_t p, std::size_t c)
  {
    return static_cast<std::uint32_t>(
      mesh.Connectivity[static_cast<std::size_t>(mesh.Offsets[group.Cells[p]]) + c]);
  };
  return place >= distance ? at(place - distance, corner) : corner > 0 ? at(place, corner - 1) : 0;
}

} // namespace banyan::cells_file

#endif
