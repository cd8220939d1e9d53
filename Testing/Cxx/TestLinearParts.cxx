// SPDX-License-Identifier: BSD-3-Clause
// Cells that are not linear, divided into linear ones: nothing of the volume is lost, and new
// points have the values that the cells' own shape functions give.
#include "MeshVolume.h"

#include "AnyMesh/CellMeshOfData.h"
#include "AnyMesh/LinearParts.h"

#include "Base/Error.h"

#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkDataArray.h"
#include "vtkDoubleArray.h"
#include "vtkFloatArray.h"
#include "vtkGenericCell.h"
#include "vtkIdList.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkShortArray.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>
#include <numeric>
#include <random>
#include <set>

namespace
{

using banyan::CellMeshOf;
using banyan::LinearParts;
using banyan::LinearPartsOf;
using banyan::MeshOfData;
using banyan::ValuesOn;
using banyan::testing::VolumeByVtk;
using banyan::testing::Volumes;
using banyan::testing::VolumesOf;

using Place = glm::dvec3;
using Places = std::vector<Place>;
using Map = std::function<Place(const Place&)>;

const Map Sheared = [](const Place& at)
{
  return Place(
    2.0 * at.x + 0.3 * at.y - 5.0, 1.1 * at.y + 0.2 * at.z + 7.0, 0.7 * at.z + 0.1 * at.x + 100.0);
};

const Map Bent = [](const Place& at)
{ return Sheared(at) + 0.1 * Place(at.y * at.z, at.x * at.x - at.z * at.z, at.y * at.y); };

/// Corners of hexahedra, tetrahedra, wedges and pyramids, as VTK has them.
Places CornersOf(int count)
{
  switch (count)
  {
    case 4:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 }, { 0, 0, 1 } };
    case 5:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0.5, 0.5, 1 } };
    case 6:
      return { { 0, 0, 0 }, { 0, 1, 0 }, { 1, 0, 0 }, { 0, 0, 1 }, { 0, 1, 1 }, { 1, 0, 1 } };
    default:
      return { { 0, 0, 0 }, { 1, 0, 0 }, { 1, 1, 0 }, { 0, 1, 0 }, { 0, 0, 1 }, { 1, 0, 1 },
        { 1, 1, 1 }, { 0, 1, 1 } };
  }
}

Place Mean(const Places& places)
{
  return std::accumulate(places.begin(), places.end(), Place(0.0)) /
         static_cast<double>(places.size());
}

/// Points of a cell with straight edges: corners, middles of VTK's edges and faces, and the middle
/// of all.
Places PlacesOf(int type, const Places& corners)
{
  const auto cell = vtkSmartPointer<vtkCell>::Take(vtkGenericCell::InstantiateCell(type));
  const auto count = static_cast<std::size_t>(cell->GetNumberOfPoints());
  Places places(count, Mean(corners));
  std::copy(corners.begin(), corners.end(), places.begin());
  for (std::size_t point = 0; point < count; ++point)
  {
    cell->GetPointIds()->SetId(static_cast<vtkIdType>(point), static_cast<vtkIdType>(point));
  }
  const auto placeMiddle = [&](vtkCell* part, vtkIdType ends)
  {
    if (part->GetNumberOfPoints() > ends)
    {
      Places around;
      for (vtkIdType i = 0; i < part->GetNumberOfPoints(); ++i)
      {
        const auto point = static_cast<std::size_t>(part->GetPointId(i));
        if (point < corners.size())
        {
          around.push_back(corners[point]);
        }
      }
      const vtkIdType last = part->GetNumberOfPoints() - 1;
      places[static_cast<std::size_t>(part->GetPointId(last))] = Mean(around);
    }
  };
  for (int face = 0; face < cell->GetNumberOfFaces(); ++face)
  {
    vtkCell* const part = cell->GetFace(face);
    placeMiddle(part, part->GetNumberOfEdges() == 3 ? 6 : 8);
  }
  for (int edge = 0; edge < cell->GetNumberOfEdges(); ++edge)
  {
    placeMiddle(cell->GetEdge(edge), 2);
  }
  return places;
}

vtkSmartPointer<vtkUnstructuredGrid> Empty(int pointType = VTK_DOUBLE)
{
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(pointType);
  grid->SetPoints(points);
  grid->Allocate(1);
  return grid;
}

/// Adds a cell with points of its own.
void AddCell(vtkUnstructuredGrid* grid, int type, const Places& places)
{
  vtkNew<vtkIdList> ids;
  for (const Place& at : places)
  {
    ids->InsertNextId(grid->GetPoints()->InsertNextPoint(at.x, at.y, at.z));
  }
  grid->InsertNextCell(type, ids);
}

Places Mapped(Places places, const Map& map)
{
  std::transform(places.begin(), places.end(), places.begin(), map);
  return places;
}

/// A function of the place at all points of a grid.
template <class Array, class Function>
vtkSmartPointer<vtkDataArray> ValuesAt(vtkUnstructuredGrid* grid, const Function& function)
{
  const auto values = vtkSmartPointer<Array>::New();
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    double at[3];
    grid->GetPoint(point, at);
    values->InsertNextValue(
      static_cast<typename Array::ValueType>(function(Place(at[0], at[1], at[2]))));
  }
  return values;
}

template <class Function>
void ExpectValues(vtkUnstructuredGrid* grid, vtkDataArray* values, const Function& function)
{
  ASSERT_EQ(values->GetNumberOfTuples(), grid->GetNumberOfPoints());
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    double at[3];
    grid->GetPoint(point, at);
    const double expected = function(Place(at[0], at[1], at[2]));
    EXPECT_NEAR(values->GetTuple1(point), expected, 1e-12 * std::abs(expected)) << point;
  }
}

struct Case
{
  int Type;
  std::size_t Corners;
  vtkIdType Parts;
  std::size_t NewPoints;
};

const std::vector<Case> Quadratic{ { VTK_QUADRATIC_HEXAHEDRON, 8, 8, 7 },
  { VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, 8, 8, 3 }, { VTK_TRIQUADRATIC_HEXAHEDRON, 8, 8, 0 },
  { VTK_QUADRATIC_TETRA, 4, 8, 0 }, { VTK_QUADRATIC_WEDGE, 6, 8, 3 },
  { VTK_BIQUADRATIC_QUADRATIC_WEDGE, 6, 8, 0 }, { VTK_QUADRATIC_LINEAR_WEDGE, 6, 8, 6 },
  { VTK_QUADRATIC_PYRAMID, 5, 10, 1 }, { VTK_TRIQUADRATIC_PYRAMID, 5, 10, 0 } };

const std::map<std::size_t, int> LinearType{ { 8, VTK_HEXAHEDRON }, { 4, VTK_TETRA },
  { 6, VTK_WEDGE }, { 5, VTK_PYRAMID } };

/// Numbers of faces' points that a polyhedron is made of.
using Faces = std::vector<std::vector<vtkIdType>>;

void AddPolyhedron(vtkUnstructuredGrid* grid, const Faces& faces)
{
  vtkNew<vtkIdList> stream;
  stream->InsertNextId(static_cast<vtkIdType>(faces.size()));
  for (const auto& face : faces)
  {
    stream->InsertNextId(static_cast<vtkIdType>(face.size()));
    for (const vtkIdType point : face)
    {
      stream->InsertNextId(point);
    }
  }
  grid->InsertNextCell(VTK_POLYHEDRON, stream);
}

/// A prism over a regular polygon: first the lower points, then the upper ones.
Places PrismOf(int corners)
{
  Places places;
  for (const double z : { 0.0, 1.5 })
  {
    for (int i = 0; i < corners; ++i)
    {
      const double angle = 2.0 * M_PI * i / corners;
      places.emplace_back(std::cos(angle), std::sin(angle), z);
    }
  }
  return places;
}

Faces FacesOfPrism(int corners)
{
  Faces faces(2);
  for (int i = 0; i < corners; ++i)
  {
    const int next = (i + 1) % corners;
    faces[0].push_back(corners - 1 - i);
    faces[1].push_back(corners + i);
    faces.push_back({ i, next, corners + next, corners + i });
  }
  return faces;
}

double VolumeOfPrism(int corners)
{
  return 1.5 * corners * std::sin(2.0 * M_PI / corners) / 2.0;
}

void AddPoints(vtkUnstructuredGrid* grid, const Places& places)
{
  for (const Place& at : places)
  {
    grid->GetPoints()->InsertNextPoint(at.x, at.y, at.z);
  }
}

double VolumeOf(vtkUnstructuredGrid* grid)
{
  return VolumesOf(CellMeshOf(grid).Mesh).Sum;
}

} // namespace

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

TEST(LinearParts, CollapsedCellsCountTheirPointsOnce)
{
  // A hexahedron whose upper face is one edge: its middle face points are means of fewer.
  Places places = PlacesOf(VTK_QUADRATIC_HEXAHEDRON, CornersOf(8));
  const auto grid = Empty();
  AddPoints(grid, places);
  std::vector<vtkIdType> ids(20);
  std::iota(ids.begin(), ids.end(), vtkIdType{ 0 });
  ids[7] = 4; // corners 4 and 7, 5 and 6 are one, and so are the middles between
  ids[6] = 5;
  ids[15] = 4;
  ids[13] = 5;
  ids[14] = 12;
  grid->InsertNextCell(VTK_QUADRATIC_HEXAHEDRON, 20, ids.data());
  const LinearParts parts = *LinearPartsOf(grid);
  std::size_t source = 0;
  for (const std::size_t end : parts.NewPoints.Ends)
  {
    std::set<vtkIdType> seen;
    double sum = 0.0;
    for (; source < end; ++source)
    {
      EXPECT_TRUE(seen.insert(parts.NewPoints.Sources[source]).second);
      sum += parts.NewPoints.Weights[source];
    }
    EXPECT_NEAR(sum, 1.0, 1e-15);
  }
}

TEST(LinearParts, PointsWhoseWeightsCancelDoNotCount)
{
  // Two corners and the middle between them are one point. In faces along this edge its weights are
  // twice -1/4, and 1/2.
  const auto grid = Empty();
  AddPoints(grid, PlacesOf(VTK_QUADRATIC_HEXAHEDRON, CornersOf(8)));
  std::vector<vtkIdType> ids(20);
  std::iota(ids.begin(), ids.end(), vtkIdType{ 0 });
  ids[1] = 0;
  ids[8] = 0;
  grid->InsertNextCell(VTK_QUADRATIC_HEXAHEDRON, 20, ids.data());
  const LinearParts parts = *LinearPartsOf(grid);
  EXPECT_TRUE(std::none_of(parts.NewPoints.Weights.begin(), parts.NewPoints.Weights.end(),
    [](double weight) { return weight == 0.0; }));
  const auto values = ValuesAt<vtkFloatArray>(grid, [](const Place&) { return 1.0; });
  values->SetTuple1(0, std::nan(""));
  const auto taken = parts.PointValues(values);
  int missing = 0;
  for (vtkIdType point = 20; point < taken->GetNumberOfTuples(); ++point)
  {
    missing += std::isnan(taken->GetTuple1(point)) ? 1 : 0;
  }
  // The faces at both ends of the edge, and the middle of all: there they are twice -1/4, and 1/4.
  EXPECT_EQ(missing, 3);
}

TEST(LinearParts, PlacesThatAreNoNumbersHarmNoOthers)
{
  const auto grid = Empty();
  Places places = PlacesOf(VTK_QUADRATIC_HEXAHEDRON, CornersOf(8));
  for (std::size_t point = 0; point < 20; point += 2)
  {
    places[point].x = std::nan("");
  }
  AddCell(grid, VTK_QUADRATIC_HEXAHEDRON, places);
  AddCell(grid, VTK_QUADRATIC_WEDGE, PlacesOf(VTK_QUADRATIC_WEDGE, CornersOf(6)));
  AddCell(grid, VTK_CONVEX_POINT_SET, { { 0, 0, 0 }, { 1, 0, 0 }, { 0, 1, 0 } });
  const MeshOfData taken = CellMeshOf(grid);
  ASSERT_EQ(taken.Mesh.CellCount, 16);
  double sum = 0.0;
  for (std::int64_t cell = 8; cell < 16; ++cell)
  {
    sum += banyan::testing::VolumeOf(taken.Mesh, taken.Mesh.Cell(cell));
  }
  EXPECT_NEAR(sum, 0.5, 1e-12);
}

TEST(LinearParts, ValuesAreFloatWhereTheirTypeFits)
{
  const auto grid = Empty(VTK_FLOAT);
  AddCell(grid, VTK_QUADRATIC_PYRAMID, PlacesOf(VTK_QUADRATIC_PYRAMID, CornersOf(5)));
  const LinearParts parts = *LinearPartsOf(grid);
  EXPECT_EQ(parts.Grid->GetPoints()->GetDataType(), VTK_FLOAT);
  const auto linear = [](const Place& at) { return 100.0 * at.x + 20.0 * at.y; };
  const auto shorts = ValuesAt<vtkShortArray>(grid, linear);
  EXPECT_EQ(parts.PointValues(shorts)->GetDataType(), VTK_FLOAT);
  ExpectValues(parts.Grid, parts.PointValues(shorts), linear);
  EXPECT_EQ(parts.PointValues(ValuesAt<vtkFloatArray>(grid, linear))->GetDataType(), VTK_FLOAT);
  EXPECT_EQ(parts.PointValues(ValuesAt<vtkIntArray>(grid, linear))->GetDataType(), VTK_DOUBLE);
  vtkNew<vtkFloatArray> vectors;
  vectors->SetName("velocity");
  vectors->SetNumberOfComponents(3);
  for (int point = 0; point < 13; ++point)
  {
    double at[3];
    grid->GetPoint(point, at);
    vectors->InsertNextTuple3(at[0], 2.0 * at[1], -at[2]);
  }
  const auto taken = parts.PointValues(vectors);
  ASSERT_EQ(taken->GetNumberOfTuples(), 14);
  EXPECT_STREQ(taken->GetName(), "velocity");
  EXPECT_EQ(taken->GetComponent(13, 0), 0.5);
  EXPECT_EQ(taken->GetComponent(13, 1), 1.0);
  EXPECT_EQ(taken->GetComponent(13, 2), 0.0);
  EXPECT_EQ(taken->GetComponent(4, 2), -1.0);
}

TEST(LinearParts, MissingValuesStayWhereTheyCount)
{
  const auto grid = Empty();
  AddCell(grid, VTK_QUADRATIC_HEXAHEDRON, PlacesOf(VTK_QUADRATIC_HEXAHEDRON, CornersOf(8)));
  const LinearParts parts = *LinearPartsOf(grid);
  const auto values = ValuesAt<vtkFloatArray>(grid, [](const Place&) { return 1.0; });
  values->SetTuple1(0, std::nan("")); // the corner of three faces
  const auto taken = parts.PointValues(values);
  int missing = 0;
  for (vtkIdType point = 20; point < 27; ++point)
  {
    missing += std::isnan(taken->GetTuple1(point)) ? 1 : 0;
  }
  EXPECT_EQ(missing, 4) << "three faces, and the middle";
  EXPECT_TRUE(std::isnan(taken->GetTuple1(0)));
  EXPECT_EQ(taken->GetTuple1(1), 1.0);
}

TEST(LinearParts, MixedGridsKeepTheOrderOfTheirCells)
{
  const auto grid = Empty();
  const auto moved = [](double x) { return [x](const Place& at) { return at + Place(x, 0, 0); }; };
  const Places cube = CornersOf(8);
  AddCell(grid, VTK_HEXAHEDRON, cube);
  AddCell(grid, VTK_QUAD, Mapped({ cube.begin(), cube.begin() + 4 }, moved(9)));
  AddCell(grid, VTK_QUADRATIC_TETRA, Mapped(PlacesOf(VTK_QUADRATIC_TETRA, CornersOf(4)), moved(2)));
  AddCell(grid, VTK_VERTEX, { { 3, 3, 3 } });
  AddCell(grid, VTK_WEDGE, Mapped(CornersOf(6), moved(5)));
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  for (const int flag : { 0, 0, 1, 0, 0 })
  {
    flags->InsertNextValue(static_cast<unsigned char>(flag));
  }
  const MeshOfData whole = CellMeshOf(grid);
  ASSERT_TRUE(whole.Parts);
  EXPECT_EQ(whole.Parts->CellOf, (std::vector<vtkIdType>{ 0, 2, 2, 2, 2, 2, 2, 2, 2, 4 }));
  EXPECT_EQ(whole.Others.Count, 2);
  EXPECT_EQ(whole.Others.First, 1);
  EXPECT_EQ(whole.Others.Type, "vtkQuad");
  EXPECT_NEAR(VolumesOf(whole.Mesh).Sum, 1.0 + 1.0 / 6.0 + 0.5, 1e-12);
  vtkNew<vtkIntArray> numbers;
  for (const int number : { 10, 11, 12, 13, 14 })
  {
    numbers->InsertNextValue(number);
  }
  const auto values = whole.ValuesOf(numbers, ValuesOn::Cells);
  ASSERT_EQ(values->GetNumberOfTuples(), whole.Mesh.CellCount);
  EXPECT_EQ(values->GetTuple1(0), 10.0);
  EXPECT_EQ(values->GetTuple1(8), 12.0);
  EXPECT_EQ(values->GetTuple1(9), 14.0);
  EXPECT_EQ(whole.ValuesOf(grid->GetPoints()->GetData(), ValuesOn::Points)->GetNumberOfTuples(),
    whole.Mesh.PointCount);
  grid->GetCellData()->AddArray(flags);
  EXPECT_NEAR(VolumeOf(grid), 1.5, 1e-12) << "the tetrahedron is another piece's";
}

TEST(LinearParts, OtherStepsTakeThePartsOfTheSameMesh)
{
  const auto step = [](double moved, bool cut)
  {
    const auto grid = Empty();
    AddCell(grid, VTK_QUADRATIC_TETRA, PlacesOf(VTK_QUADRATIC_TETRA, CornersOf(4)));
    Places prism = PrismOf(4);
    prism.back().z += moved;
    AddPoints(grid, prism);
    Faces faces = FacesOfPrism(4);
    if (cut)
    {
      // The first side is two triangles.
      faces[2] = { 0, 1, 5 };
      faces.push_back({ 0, 5, 4 });
    }
    for (auto& face : faces)
    {
      std::for_each(face.begin(), face.end(), [](vtkIdType& point) { point += 10; });
    }
    AddPolyhedron(grid, faces);
    return grid;
  };
  const MeshOfData first = CellMeshOf(step(0.0, false));
  EXPECT_EQ(CellMeshOf(step(0.0, false), first).Parts, first.Parts);
  EXPECT_NE(CellMeshOf(step(0.1, false), first).Parts, first.Parts) << "a point has moved";
  EXPECT_NE(CellMeshOf(step(0.0, true), first).Parts, first.Parts) << "faces are others";
  const auto retyped = step(0.0, false);
  retyped->GetCells()->GetConnectivityArray()->SetComponent(0, 0, 1.0);
  EXPECT_NE(CellMeshOf(retyped, first).Parts, first.Parts) << "a cell has another point";
  // Flags are those of the step.
  const auto hidden = step(0.0, false);
  vtkNew<vtkUnsignedCharArray> flags;
  flags->SetName(vtkDataSetAttributes::GhostArrayName());
  flags->InsertNextValue(0);
  flags->InsertNextValue(1);
  hidden->GetCellData()->AddArray(flags);
  const MeshOfData later = CellMeshOf(hidden, first);
  EXPECT_EQ(later.Parts, first.Parts);
  EXPECT_EQ(VolumesOf(first.Mesh).Count, later.Mesh.CellCount);
  EXPECT_EQ(VolumesOf(later.Mesh).Count, 8);
}

TEST(LinearParts, WrongCellsAreNamed)
{
  const auto expect = [](vtkUnstructuredGrid* grid, const char* sentence)
  {
    try
    {
      (void)CellMeshOf(grid);
      ADD_FAILURE() << "nothing is thrown";
    }
    catch (const banyan::Error& error)
    {
      EXPECT_STREQ(error.what(), sentence);
    }
  };
  const auto grid = Empty();
  AddCell(grid, VTK_TETRA, CornersOf(4));
  AddCell(grid, VTK_QUADRATIC_TETRA, PlacesOf(VTK_QUADRATIC_TETRA, CornersOf(4)));
  grid->GetCells()->GetConnectivityArray()->SetComponent(7, 0, 14.0);
  expect(grid, "Cell 1 refers to point 14, and the mesh has 14 points.");
  const auto fewer = Empty();
  AddCell(fewer, VTK_QUADRATIC_TETRA, CornersOf(8));
  expect(fewer, "Cell 0 of the type vtkQuadraticTetra has 8 points in place of 10.");
  const auto good = Empty();
  AddCell(good, VTK_QUADRATIC_TETRA, PlacesOf(VTK_QUADRATIC_TETRA, CornersOf(4)));
  vtkNew<vtkFloatArray> one;
  one->InsertNextValue(1.0f);
  one->InsertNextValue(1.0f);
  EXPECT_THROW(LinearPartsOf(good)->PointValues(one), banyan::Error);
  EXPECT_THROW(LinearPartsOf(good)->CellValues(one), banyan::Error);
}
