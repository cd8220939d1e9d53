// SPDX-License-Identifier: BSD-3-Clause
// Cells of all types that become linear ones, and what tests ask of them.
#ifndef banyan_Testing_LinearPartsTesting_h
#define banyan_Testing_LinearPartsTesting_h

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

namespace linear_parts
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

inline const Map Sheared = [](const Place& at)
{
  return Place(
    2.0 * at.x + 0.3 * at.y - 5.0, 1.1 * at.y + 0.2 * at.z + 7.0, 0.7 * at.z + 0.1 * at.x + 100.0);
};

inline const Map Bent = [](const Place& at)
{ return Sheared(at) + 0.1 * Place(at.y * at.z, at.x * at.x - at.z * at.z, at.y * at.y); };

/// Corners of hexahedra, tetrahedra, wedges and pyramids, as VTK has them.
inline Places CornersOf(int count)
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

inline Place Mean(const Places& places)
{
  return std::accumulate(places.begin(), places.end(), Place(0.0)) /
         static_cast<double>(places.size());
}

/// Points of a cell with straight edges: corners, middles of VTK's edges and faces, and the middle
/// of all.
inline Places PlacesOf(int type, const Places& corners)
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

inline vtkSmartPointer<vtkUnstructuredGrid> Empty(int pointType = VTK_DOUBLE)
{
  const auto grid = vtkSmartPointer<vtkUnstructuredGrid>::New();
  vtkNew<vtkPoints> points;
  points->SetDataType(pointType);
  grid->SetPoints(points);
  grid->Allocate(1);
  return grid;
}

/// Adds a cell with points of its own.
inline void AddCell(vtkUnstructuredGrid* grid, int type, const Places& places)
{
  vtkNew<vtkIdList> ids;
  for (const Place& at : places)
  {
    ids->InsertNextId(grid->GetPoints()->InsertNextPoint(at.x, at.y, at.z));
  }
  grid->InsertNextCell(type, ids);
}

inline Places Mapped(Places places, const Map& map)
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

inline const std::vector<Case> Quadratic{ { VTK_QUADRATIC_HEXAHEDRON, 8, 8, 7 },
  { VTK_BIQUADRATIC_QUADRATIC_HEXAHEDRON, 8, 8, 3 }, { VTK_TRIQUADRATIC_HEXAHEDRON, 8, 8, 0 },
  { VTK_QUADRATIC_TETRA, 4, 8, 0 }, { VTK_QUADRATIC_WEDGE, 6, 8, 3 },
  { VTK_BIQUADRATIC_QUADRATIC_WEDGE, 6, 8, 0 }, { VTK_QUADRATIC_LINEAR_WEDGE, 6, 8, 6 },
  { VTK_QUADRATIC_PYRAMID, 5, 10, 1 }, { VTK_TRIQUADRATIC_PYRAMID, 5, 10, 0 } };

inline const std::map<std::size_t, int> LinearType{ { 8, VTK_HEXAHEDRON }, { 4, VTK_TETRA },
  { 6, VTK_WEDGE }, { 5, VTK_PYRAMID } };

/// Numbers of faces' points that a polyhedron is made of.
using Faces = std::vector<std::vector<vtkIdType>>;

inline void AddPolyhedron(vtkUnstructuredGrid* grid, const Faces& faces)
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
inline Places PrismOf(int corners)
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

inline Faces FacesOfPrism(int corners)
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

inline double VolumeOfPrism(int corners)
{
  return 1.5 * corners * std::sin(2.0 * M_PI / corners) / 2.0;
}

inline void AddPoints(vtkUnstructuredGrid* grid, const Places& places)
{
  for (const Place& at : places)
  {
    grid->GetPoints()->InsertNextPoint(at.x, at.y, at.z);
  }
}

inline double VolumeOf(vtkUnstructuredGrid* grid)
{
  return VolumesOf(CellMeshOf(grid).Mesh).Sum;
}

} // namespace linear_parts

#endif
