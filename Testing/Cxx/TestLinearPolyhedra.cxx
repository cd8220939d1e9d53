// SPDX-License-Identifier: BSD-3-Clause
// Prisms, sets of points and polyhedra become linear cells.
#include "LinearPartsTesting.h"

namespace
{

using namespace linear_parts;

TEST(LinearParts, PrismsBecomeWedges)
{
  for (const int corners : { 5, 6 })
  {
    SCOPED_TRACE(corners);
    const auto grid = Empty();
    AddCell(grid, corners == 5 ? VTK_PENTAGONAL_PRISM : VTK_HEXAGONAL_PRISM, PrismOf(corners));
    const LinearParts parts = *LinearPartsOf(grid);
    EXPECT_EQ(parts.Grid->GetNumberOfCells(), corners - 2);
    EXPECT_EQ(parts.Grid->GetCellType(0), VTK_WEDGE);
    const Volumes volumes = VolumesOf(CellMeshOf(parts.Grid).Mesh);
    EXPECT_NEAR(volumes.Sum, VolumeOfPrism(corners), 1e-12);
    EXPECT_NEAR(volumes.Sum, VolumeByVtk(grid), 1e-9);
    EXPECT_GT(volumes.Least, 0.0);
  }
}

TEST(LinearParts, ConvexSetsOfPoints)
{
  // Six corners of an octahedron, and the ten of a prism: the second cell has no points of the
  // first one.
  const auto grid = Empty();
  AddCell(grid, VTK_CONVEX_POINT_SET,
    { { -1, 0, 0 }, { 1, 0, 0 }, { 0, -1, 0 }, { 0, 1, 0 }, { 0, 0, -1 }, { 0, 0, 1 } });
  AddCell(grid, VTK_CONVEX_POINT_SET, Mapped(PrismOf(5), Sheared));
  const MeshOfData taken = CellMeshOf(grid);
  double sum = 0.0;
  for (std::int64_t cell = 0; cell < taken.Mesh.CellCount; ++cell)
  {
    sum += std::abs(banyan::testing::VolumeOf(taken.Mesh, taken.Mesh.Cell(cell)));
  }
  const auto prism = Empty();
  AddCell(prism, VTK_PENTAGONAL_PRISM, Mapped(PrismOf(5), Sheared));
  EXPECT_NEAR(sum, 4.0 / 3.0 + VolumeByVtk(prism), 1e-9);
  EXPECT_EQ(taken.Mesh.PointCount, 16);
}

TEST(LinearParts, PolyhedraAroundTheirMeans)
{
  for (const int corners : { 3, 4, 5, 7 })
  {
    SCOPED_TRACE(corners);
    const auto grid = Empty();
    AddPoints(grid, Mapped(PrismOf(corners), Sheared));
    AddPolyhedron(grid, FacesOfPrism(corners));
    const LinearParts parts = *LinearPartsOf(grid);
    // One for each edge of each face, or for a triangle.
    const int ends = corners == 3 ? 1 : corners;
    EXPECT_EQ(parts.Grid->GetNumberOfCells(), 2 * ends + 4 * corners);
    const Volumes volumes = VolumesOf(CellMeshOf(parts.Grid).Mesh);
    EXPECT_NEAR(volumes.Sum, VolumeByVtk(grid), 1e-9);
    EXPECT_GT(volumes.Least, 0.0);
    // The mean of all points, and of each face that is no triangle.
    EXPECT_EQ(parts.NewPoints.Ends.size(), 1u + (corners == 3 ? 0u : 2u) + unsigned(corners));
    const auto linear = [](const Place& at) { return 1.0 + at.x - 2.0 * at.y + at.z; };
    ExpectValues(parts.Grid, parts.PointValues(ValuesAt<vtkDoubleArray>(grid, linear)), linear);
    // No cell has a point that is not there, and values of cells are those of the polyhedron.
    EXPECT_TRUE(std::all_of(
      parts.CellOf.begin(), parts.CellOf.end(), [](vtkIdType cell) { return cell == 0; }));
  }
}

TEST(LinearParts, PolyhedraShareTheMeansOfTheirFaces)
{
  // Two prisms over hexagons, one on the other.
  const auto grid = Empty();
  Places places = PrismOf(6);
  for (int i = 0; i < 6; ++i)
  {
    const Place& above = places[static_cast<std::size_t>(6 + i)];
    places.push_back(above + Place(0, 0, 1));
  }
  AddPoints(grid, places);
  AddPolyhedron(grid, FacesOfPrism(6));
  Faces upper = FacesOfPrism(6);
  for (auto& face : upper)
  {
    std::for_each(face.begin(), face.end(), [](vtkIdType& point) { point += 6; });
  }
  AddPolyhedron(grid, upper);
  const LinearParts parts = *LinearPartsOf(grid);
  EXPECT_EQ(parts.NewPoints.Ends.size(), 2u + 2u * 8u - 1u);
  EXPECT_NEAR(
    VolumesOf(CellMeshOf(parts.Grid).Mesh).Sum, VolumeOfPrism(6) * (1.0 + 1.0 / 1.5), 1e-12);
}

TEST(LinearParts, PolyhedraThatHideTheirFacesAreCounted)
{
  // A prism over a star with four points. Where one of them is moved far out, the mean of all lies
  // in it, and no longer sees the others.
  const auto star = [](double moved, std::size_t turned)
  {
    Places places = PrismOf(8);
    for (std::size_t point = 1; point < 16; point += 2)
    {
      places[point].x *= 0.3;
      places[point].y *= 0.3;
    }
    for (const std::size_t point : { 0, 8 })
    {
      places[point].x += moved;
    }
    Faces faces = FacesOfPrism(8);
    for (std::size_t face = 0; face < turned; ++face)
    {
      std::reverse(faces[face].begin(), faces[face].end());
    }
    return std::make_pair(places, faces);
  };
  const auto folded = [](const std::vector<std::pair<Places, Faces>>& cells)
  {
    const auto grid = Empty();
    for (const auto& [places, faces] : cells)
    {
      Faces own = faces;
      for (auto& face : own)
      {
        std::for_each(face.begin(), face.end(),
          [&](vtkIdType& point) { point += grid->GetPoints()->GetNumberOfPoints(); });
      }
      AddPoints(grid, places);
      AddPolyhedron(grid, own);
    }
    return LinearPartsOf(grid)->Folded;
  };
  EXPECT_EQ(folded({ star(0.0, 0) }).Count, 0);
  // Faces may be listed in any direction.
  EXPECT_EQ(folded({ star(0.0, 3), { PrismOf(5), FacesOfPrism(5) } }).Count, 0);
  EXPECT_EQ(folded({ star(0.0, 10) }).Count, 0);
  const banyan::OtherCells some =
    folded({ { PrismOf(3), FacesOfPrism(3) }, star(9.0, 0), star(0.0, 0), star(9.0, 4) });
  EXPECT_EQ(some.Text(), "2 cells, cell 1 of the type vtkPolyhedron the first of them");
}

} // namespace
