// SPDX-License-Identifier: BSD-3-Clause
// The meshes that cells are tested with: whole, without gaps, and as different as they say.
#include "Cells/CellMeshes.h"

#include <glm/geometric.hpp>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

namespace
{

using namespace banyan;
using cellmeshes::Cut;
using cellmeshes::OwnedCellMesh;

const std::vector<Cut> AllCuts{ Cut::Hexahedra, Cut::Voxels, Cut::Tetrahedra, Cut::FiveTetrahedra,
  Cut::Wedges, Cut::Pyramids, Cut::Mixed };

/// Of a cell whose faces are triangles around the means of their corners; below 0 when mirrored.
double VolumeOf(const CellMesh& mesh, std::int64_t number)
{
  const MeshCell cell = mesh.Cell(number);
  const CellFaces& faces = FacesOf(cell.Shape);
  // Near the cell, whose numbers may be large.
  const glm::dvec3 origin = mesh.Point(cell.Points[0]);
  double volume = 0.0;
  for (int face = 0; face < faces.Count; ++face)
  {
    const CellFace& f = faces.Faces[face];
    glm::dvec3 mean(0.0);
    for (int i = 0; i < f.Count; ++i)
    {
      mean += (mesh.Point(cell.Points[f.Corners[i]]) - origin) / double(f.Count);
    }
    for (int i = 0; i < f.Count; ++i)
    {
      const glm::dvec3 a = mesh.Point(cell.Points[f.Corners[i]]) - origin;
      const glm::dvec3 b = mesh.Point(cell.Points[f.Corners[(i + 1) % f.Count]]) - origin;
      volume += glm::dot(mean, glm::cross(a, b)) / 6.0;
    }
  }
  return volume;
}

/// How many faces one cell alone has; all others must have two.
int BorderFacesOf(const CellMesh& mesh)
{
  std::map<std::vector<std::int64_t>, int> owners;
  for (std::int64_t i = 0; i < mesh.CellCount; ++i)
  {
    const MeshCell cell = mesh.Cell(i);
    const CellFaces& faces = FacesOf(cell.Shape);
    for (int face = 0; face < faces.Count; ++face)
    {
      std::vector<std::int64_t> corners;
      for (int k = 0; k < faces.Faces[face].Count; ++k)
      {
        corners.push_back(cell.Points[faces.Faces[face].Corners[k]]);
      }
      std::sort(corners.begin(), corners.end());
      ++owners[corners];
    }
  }
  int border = 0;
  for (const auto& [corners, count] : owners)
  {
    EXPECT_LE(count, 2);
    border += count == 1 ? 1 : 0;
  }
  return border;
}

/// The smallest cell and the sum of all.
std::pair<double, double> VolumesOf(const CellMesh& mesh)
{
  double smallest = 1e300;
  double sum = 0.0;
  for (std::int64_t i = 0; i < mesh.CellCount; ++i)
  {
    smallest = std::min(smallest, VolumeOf(mesh, i));
    sum += VolumeOf(mesh, i);
  }
  return { smallest, sum };
}

TEST(CellMeshes, CubesAreFilledByCellsThatAreNotMirrored)
{
  for (const Cut cut : AllCuts)
  {
    const OwnedCellMesh mesh = cellmeshes::Cube(6, cut, { 0.03, 0.1, true });
    const auto [smallest, sum] = VolumesOf(mesh.View());
    EXPECT_GT(smallest, 0.002 / 216) << int(cut);
    EXPECT_NEAR(sum, 1.0, 1e-12) << int(cut);
    EXPECT_GT(VolumesOf(cellmeshes::Cube(6, cut, { 0.03, 0.1 }).View()).first, 0.0) << int(cut);
  }
}

TEST(CellMeshes, FacesOfNeighboursMatch)
{
  const std::map<Cut, int> expected{ { Cut::Hexahedra, 96 }, { Cut::Voxels, 96 },
    { Cut::Tetrahedra, 192 }, { Cut::FiveTetrahedra, 192 }, { Cut::Wedges, 64 + 64 },
    { Cut::Pyramids, 96 } };
  for (const auto& [cut, faces] : expected)
  {
    EXPECT_EQ(BorderFacesOf(cellmeshes::Cube(4, cut).View()), faces) << int(cut);
  }
  const int mixed = BorderFacesOf(cellmeshes::Cube(4, Cut::Mixed).View());
  EXPECT_GT(mixed, 96);
  EXPECT_LT(mixed, 192);
}

TEST(CellMeshes, MixedOnesHaveAllShapes)
{
  const OwnedCellMesh mesh = cellmeshes::Cube(6, Cut::Mixed);
  for (const int type : { 10, 12, 13, 14 })
  {
    EXPECT_GT(std::count(mesh.Types.begin(), mesh.Types.end(), type), 7) << type;
  }
}

TEST(CellMeshes, MirroredCellsHaveTheSameVolume)
{
  for (const Cut cut : { Cut::Hexahedra, Cut::Mixed })
  {
    OwnedCellMesh mesh = cellmeshes::Cube(4, cut, { 0.0, 0.1, true });
    const auto [smallest, sum] = VolumesOf(mesh.View());
    cellmeshes::MirrorCells(mesh);
    EXPECT_NEAR(VolumesOf(mesh.View()).second, -sum, 1e-12);
    cellmeshes::Place(mesh, { -2.0, 1.0, 1.0 }, glm::dvec3(3.0));
    EXPECT_NEAR(VolumesOf(mesh.View()).second, 2.0 * sum, 1e-12);
    EXPECT_NEAR(VolumesOf(mesh.View()).first, 2.0 * smallest, 1e-12);
  }
}

TEST(CellMeshes, OtherOrdersAndOwnPointsKeepCellsAndValues)
{
  OwnedCellMesh mesh = cellmeshes::Cube(4, Cut::Mixed, { 0.03, 0.1 });
  const auto field = cellmeshes::LinearField({ 1.0, 2.0, 3.0 }, 4.0);
  cellmeshes::SetValues(mesh, field);
  const double sum = VolumesOf(mesh.View()).second;
  const int border = BorderFacesOf(mesh.View());
  const std::vector<std::int64_t> ids = mesh.Ids;
  cellmeshes::Shuffle(mesh);
  EXPECT_NE(mesh.Ids, ids);
  EXPECT_EQ(BorderFacesOf(mesh.View()), border);
  EXPECT_NEAR(VolumesOf(mesh.View()).second, sum, 1e-12);
  cellmeshes::SeparatePoints(mesh);
  EXPECT_EQ(mesh.PointCount(), static_cast<std::int64_t>(ids.size()));
  EXPECT_NEAR(VolumesOf(mesh.View()).second, sum, 1e-12);
  cellmeshes::RoundPoints(mesh);
  EXPECT_NEAR(VolumesOf(mesh.View()).second, sum, 1e-6);
  for (std::int64_t i = 0; i < mesh.PointCount(); ++i)
  {
    EXPECT_NEAR(mesh.ValueOfPoint()(i), field(mesh.View().Point(i)), 1e-6);
  }
}

TEST(CellMeshes, GridsAreAsTheirCells)
{
  const OwnedCellMesh sector = cellmeshes::Sector({ 3, 20, 2 }, 0.4, 2.0);
  const auto [smallest, sum] = VolumesOf(sector.View());
  EXPECT_GT(smallest, 0.0);
  EXPECT_NEAR(sum, 0.5 * 2.0 * (1.0 - 0.16), 0.002);
  EXPECT_EQ(VolumesOf(cellmeshes::AsCells(sector).View()).second, sum);
  OwnedCellMesh grid = cellmeshes::Rectilinear({ 3, 5, 7 }, 4.0);
  EXPECT_NEAR(VolumesOf(grid.View()).second, 1.0, 1e-12);
  EXPECT_EQ(grid.CellCount(), 105);
  EXPECT_EQ(BorderFacesOf(grid.View()), 2 * (15 + 21 + 35));
  EXPECT_LT(VolumesOf(grid.View()).first, 0.5 / 105);
  cellmeshes::Place(grid, { 2.0, 3.0, 4.0 }, { 5.0, 6.0, 7.0 });
  EXPECT_NEAR(VolumesOf(grid.View()).second, 24.0, 1e-11);
  EXPECT_EQ(grid.View().Point(grid.PointCount() - 1), glm::dvec3(7.0, 9.0, 11.0));
}

} // namespace
