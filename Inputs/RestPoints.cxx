// SPDX-License-Identifier: BSD-3-Clause
#include "RestPoints.h"

#include "ArrayLength.h"

#include "vtkDataArray.h"
#include "vtkMath.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkUnstructuredGrid.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <sstream>

namespace banyan
{
namespace
{

bool SameBits(vtkDataArray* a, vtkDataArray* b)
{
  return a == b ||
         (a->GetDataType() == b->GetDataType() &&
           a->GetNumberOfValues() == b->GetNumberOfValues() &&
           std::memcmp(a->GetVoidPointer(0), b->GetVoidPointer(0),
             static_cast<std::size_t>(a->GetNumberOfValues()) * a->GetDataTypeSize()) == 0);
}

/// Returns the largest error that comes from rounding points, displacements and their difference to
/// float32, once each.
double RoundingOf(vtkUnstructuredGrid* grid)
{
  double bounds[6];
  grid->GetPoints()->GetBounds(bounds);
  double largest = 0.0;
  for (const double bound : bounds)
  {
    largest = std::max(largest, std::abs(bound));
  }
  return 4.0 * std::numeric_limits<float>::epsilon() * largest;
}

/// The point that is farthest from where it was at first.
struct Farthest
{
  vtkIdType Point = 0;
  double Distance = 0.0; ///< infinite where one of the two is not finite
};

/// @param displacements that points are taken back by; may be null
Farthest FarthestOf(vtkPoints* first, vtkPoints* now, vtkDataArray* displacements)
{
  Farthest farthest;
  for (vtkIdType point = 0; point < now->GetNumberOfPoints(); ++point)
  {
    double a[3], b[3], moved[3] = { 0.0, 0.0, 0.0 };
    first->GetPoint(point, a);
    now->GetPoint(point, b);
    if (displacements)
    {
      displacements->GetTuple(point, moved);
    }
    vtkMath::Subtract(b, moved, b);
    const double distance = std::sqrt(vtkMath::Distance2BetweenPoints(a, b));
    // This finds points that are nowhere, too.
    if (!(distance <= farthest.Distance))
    {
      farthest = { point,
        std::isfinite(distance) ? distance : std::numeric_limits<double>::infinity() };
    }
  }
  return farthest;
}

/// The point array that says best how the points moved from where they were at first, or nothing
/// where none does to what rounding allows.
/// @param moved the largest distance, of which half must be explained even if it is small
std::string DisplacementsOf(vtkUnstructuredGrid* first, vtkUnstructuredGrid* now, double moved)
{
  std::string best;
  double least = std::min(RoundingOf(first), 0.5 * moved);
  vtkPointData* const arrays = now->GetPointData();
  for (int i = 0; i < arrays->GetNumberOfArrays(); ++i)
  {
    vtkDataArray* const array = arrays->GetArray(i);
    if (!array || !array->GetName() || array->GetNumberOfComponents() != 3 ||
        array->GetNumberOfTuples() != now->GetNumberOfPoints())
    {
      continue;
    }
    const double left = FarthestOf(first->GetPoints(), now->GetPoints(), array).Distance;
    if (left <= least)
    {
      best = array->GetName();
      least = left;
    }
  }
  return best;
}

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> AtRest(
  vtkUnstructuredGrid* grid, const std::string& displacements)
{
  if (displacements.empty() || grid->GetNumberOfPoints() == 0)
  {
    return grid;
  }
  vtkDataArray* const array = grid->GetPointData()->GetArray(displacements.c_str());
  if (!array || array->GetNumberOfComponents() != 3)
  {
    throw Error(
      !array ? "There is no point array " + displacements + ", which is to hold the displacements"
             : "The point array " + displacements + " holds no displacements: it has " +
                 std::to_string(array->GetNumberOfComponents()) + " components, not 3");
  }
  CheckLength(array, vtkDataObject::POINT, grid->GetNumberOfPoints());
  vtkNew<vtkPoints> points;
  points->SetDataType(grid->GetPoints()->GetDataType());
  points->SetNumberOfPoints(grid->GetNumberOfPoints());
  for (vtkIdType point = 0; point < grid->GetNumberOfPoints(); ++point)
  {
    double place[3], moved[3];
    grid->GetPoint(point, place);
    array->GetTuple(point, moved);
    vtkMath::Subtract(place, moved, place);
    points->SetPoint(point, place);
  }
  const auto rest = vtkSmartPointer<vtkUnstructuredGrid>::New();
  rest->ShallowCopy(grid);
  rest->SetPoints(points);
  return rest;
}

std::string HowPointsMoved(
  vtkUnstructuredGrid* first, vtkUnstructuredGrid* now, const std::string& displacements)
{
  if (SameBits(first->GetPoints()->GetData(), now->GetPoints()->GetData()))
  {
    return {};
  }
  const Farthest farthest = FarthestOf(first->GetPoints(), now->GetPoints(), nullptr);
  if (!displacements.empty() && farthest.Distance <= RoundingOf(first))
  {
    return {};
  }
  std::ostringstream text;
  text << "points have moved, point " << farthest.Point << " by " << farthest.Distance;
  if (!displacements.empty())
  {
    text << " apart from what the array " << displacements << " says";
    return text.str();
  }
  const std::string carrier = DisplacementsOf(first, now, farthest.Distance);
  if (!carrier.empty())
  {
    text << ", as the point array " << carrier << " says: with DisplacementArray = '" << carrier
         << "' the mesh is written as it is without these displacements";
  }
  else
  {
    text << ". If a point array holds these displacements, name it as 'Displacement Array' "
            "(DisplacementArray), or read the mesh without applying them";
  }
  return text.str();
}

} // namespace banyan
