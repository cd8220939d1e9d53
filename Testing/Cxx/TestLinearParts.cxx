// SPDX-License-Identifier: BSD-3-Clause
// Quadratic cells become linear ones, and lose nothing.
#include "LinearPartsTesting.h"

namespace
{

using namespace linear_parts;

TEST(LinearParts, QuadraticCellsLoseNothing)
{
  for (const Case& each : Quadratic)
  {
    SCOPED_TRACE(each.Type);
    const Places corners = CornersOf(static_cast<int>(each.Corners));
    const auto grid = Empty();
    AddCell(grid, each.Type, Mapped(PlacesOf(each.Type, corners), Sheared));
    const LinearParts parts = *LinearPartsOf(grid);
    EXPECT_EQ(parts.Grid->GetNumberOfCells(), each.Parts);
    EXPECT_EQ(parts.NewPoints.Ends.size(), each.NewPoints);
    const Volumes volumes = VolumesOf(CellMeshOf(parts.Grid).Mesh);
    EXPECT_EQ(volumes.Count, each.Parts);
    // The edges are straight, so it is the volume of the linear cell; VTK's own filter has none of
    // some quadratic cells.
    const auto linear = Empty();
    AddCell(linear, LinearType.at(each.Corners), Mapped(corners, Sheared));
    const double whole = VolumeByVtk(linear);
    EXPECT_NEAR(volumes.Sum, whole, 1e-9);
    EXPECT_NEAR(VolumeByVtk(parts.Grid), whole, 1e-9);
    // None is mirrored, flat, or covers others. Those of a cell are equal; a pyramid's tetrahedra
    // are half as large.
    EXPECT_NEAR(volumes.Least, whole / (each.Corners == 5 ? 16.0 : 8.0), 1e-9);
  }
}

TEST(LinearParts, FieldsAtNewPointsAreThoseOfTheCell)
{
  const auto linear = [](const Place& at) { return 3.0 + 2.0 * at.x - at.y + 0.25 * at.z; };
  const auto quadratic = [](const Place& at)
  { return at.x * at.x - 2.0 * at.x * at.y + at.z * at.x + 3.0 * at.z * at.z; };
  for (const Case& each : Quadratic)
  {
    SCOPED_TRACE(each.Type);
    const Places straight = PlacesOf(each.Type, CornersOf(static_cast<int>(each.Corners)));
    const auto bent = Empty();
    AddCell(bent, each.Type, Mapped(straight, Bent));
    const LinearParts parts = *LinearPartsOf(bent);
    ExpectValues(parts.Grid, parts.PointValues(ValuesAt<vtkDoubleArray>(bent, linear)), linear);
    if (each.Type != VTK_QUADRATIC_LINEAR_WEDGE)
    {
      // Straight cells have all quadratic fields.
      const auto sheared = Empty();
      AddCell(sheared, each.Type, Mapped(straight, Sheared));
      const LinearParts others = *LinearPartsOf(sheared);
      ExpectValues(
        others.Grid, others.PointValues(ValuesAt<vtkDoubleArray>(sheared, quadratic)), quadratic);
    }
  }
}

TEST(LinearParts, NewPointsLieOnTheBentCell)
{
  // The cell's own place in the middle of each face and of the whole.
  const auto grid = Empty();
  AddCell(
    grid, VTK_QUADRATIC_HEXAHEDRON, Mapped(PlacesOf(VTK_QUADRATIC_HEXAHEDRON, CornersOf(8)), Bent));
  const LinearParts parts = *LinearPartsOf(grid);
  ASSERT_EQ(parts.Grid->GetNumberOfPoints(), 27);
  std::vector<std::array<double, 3>> expected;
  for (const auto& at :
    { std::array<double, 3>{ 0.5, 0.5, 0.0 }, { 0.5, 0.0, 0.5 }, { 0.0, 0.5, 0.5 },
      { 0.5, 0.5, 0.5 }, { 1.0, 0.5, 0.5 }, { 0.5, 1.0, 0.5 }, { 0.5, 0.5, 1.0 } })
  {
    int part = 0;
    double weights[20];
    double place[3];
    grid->GetCell(0)->EvaluateLocation(part, at.data(), place, weights);
    bool found = false;
    for (vtkIdType point = 20; point < 27; ++point)
    {
      double there[3];
      parts.Grid->GetPoint(point, there);
      found = found || (std::abs(there[0] - place[0]) + std::abs(there[1] - place[1]) +
                           std::abs(there[2] - place[2]) <
                         1e-12);
    }
    EXPECT_TRUE(found) << at[0] << " " << at[1] << " " << at[2];
  }
}

TEST(LinearParts, NeighboursShareNewPoints)
{
  // A quadratic wedge and a quadratic pyramid on two faces of a quadratic hexahedron, whose points
  // they name from other corners.
  const auto grid = Empty();
  AddCell(grid, VTK_QUADRATIC_HEXAHEDRON, PlacesOf(VTK_QUADRATIC_HEXAHEDRON, CornersOf(8)));
  const auto numbers = [&](const Places& places)
  {
    vtkNew<vtkIdList> ids;
    for (const Place& at : places)
    {
      vtkIdType same = -1;
      for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
      {
        double there[3];
        grid->GetPoint(point, there);
        same = at == Place(there[0], there[1], there[2]) ? point : same;
      }
      ids->InsertNextId(same >= 0 ? same : grid->GetPoints()->InsertNextPoint(at.x, at.y, at.z));
    }
    return std::vector<vtkIdType>(ids->begin(), ids->end());
  };
  const auto add = [&](int type, const Places& corners)
  {
    const std::vector<vtkIdType> ids = numbers(PlacesOf(type, corners));
    grid->InsertNextCell(type, static_cast<vtkIdType>(ids.size()), ids.data());
  };
  add(
    VTK_QUADRATIC_PYRAMID, { { 1, 1, 1 }, { 0, 1, 1 }, { 0, 0, 1 }, { 1, 0, 1 }, { 0.5, 0.5, 2 } });
  add(VTK_QUADRATIC_WEDGE,
    { { 1, 1, 1 }, { 1, 0, 1 }, { 2, 0, 1 }, { 1, 1, 0 }, { 1, 0, 0 }, { 2, 0, 0 } });
  const LinearParts parts = *LinearPartsOf(grid);
  // Seven of the hexahedron, two of the wedge, whose third one it shares, none of the pyramid.
  EXPECT_EQ(parts.NewPoints.Ends.size(), 9u);
  EXPECT_EQ(parts.Grid->GetNumberOfCells(), 8 + 10 + 8);
  EXPECT_NEAR(VolumesOf(CellMeshOf(parts.Grid).Mesh).Sum, 1.0 + 1.0 / 3.0 + 0.5, 1e-12);
}

TEST(LinearParts, PlacesDependOnNoOrder)
{
  // The same cell with its points numbered at random, and named from another corner.
  std::mt19937 random(7);
  std::uniform_real_distribution<double> off(-0.03, 0.03);
  for (const int pointType : { VTK_FLOAT, VTK_DOUBLE })
  {
    Places places = PlacesOf(VTK_QUADRATIC_HEXAHEDRON, CornersOf(8));
    for (Place& at : places)
    {
      at += Place(off(random), off(random), off(random));
    }
    const auto made = [&](const std::vector<int>& order)
    {
      std::vector<std::size_t> shuffled(20);
      std::iota(shuffled.begin(), shuffled.end(), std::size_t{ 0 });
      std::shuffle(shuffled.begin(), shuffled.end(), random);
      const auto grid = Empty(pointType);
      std::vector<vtkIdType> number(20);
      for (const std::size_t point : shuffled)
      {
        const Place& at = places[point];
        number[point] = grid->GetPoints()->InsertNextPoint(at.x, at.y, at.z);
      }
      std::vector<vtkIdType> ids;
      for (const int point : order)
      {
        ids.push_back(number[static_cast<std::size_t>(point)]);
      }
      grid->InsertNextCell(VTK_QUADRATIC_HEXAHEDRON, 20, ids.data());
      const LinearParts parts = *LinearPartsOf(grid);
      std::set<std::array<double, 3>> result;
      for (vtkIdType point = 20; point < parts.Grid->GetNumberOfPoints(); ++point)
      {
        std::array<double, 3> at{};
        parts.Grid->GetPoint(point, at.data());
        result.insert(at);
      }
      return result;
    };
    std::vector<int> order(20);
    std::iota(order.begin(), order.end(), 0);
    const auto first = made(order);
    EXPECT_EQ(first.size(), 7u);
    EXPECT_EQ(made(order), first);
    EXPECT_EQ(
      made({ 1, 2, 3, 0, 5, 6, 7, 4, 9, 10, 11, 8, 13, 14, 15, 12, 17, 18, 19, 16 }), first);
  }
}

} // namespace
