// SPDX-License-Identifier: BSD-3-Clause
#include "ArraysOfRanks.h"

#include "MeshArrays.h"
#include "RankMessages.h"

#include "vtkAbstractArray.h"
#include "vtkDataObject.h"
#include "vtkDataSetAttributes.h"
#include "vtkFieldData.h"
#include "vtkIntArray.h"
#include "vtkNew.h"
#include "vtkUnstructuredGrid.h"

#include <map>
#include <set>
#include <string>
#include <utility>

namespace banyan
{
namespace
{

/// An array of points or cells (vtkDataObject::POINT or CELL), by name.
using Place = std::pair<int, std::string>;
/// Type and components of an array.
using Shape = std::pair<int, int>;

std::map<Place, Shape> ArraysOf(vtkUnstructuredGrid* grid)
{
  std::map<Place, Shape> arrays;
  for (const int where : { vtkDataObject::POINT, vtkDataObject::CELL })
  {
    vtkDataSetAttributes* const all = grid->GetAttributes(where);
    for (int i = 0; i < all->GetNumberOfArrays(); ++i)
    {
      vtkAbstractArray* const array = all->GetAbstractArray(i);
      // A reader may put global ids and flags of ghosts on some pieces only: they are no values.
      if (array && array->GetName() && !IsNoValue(all, array))
      {
        arrays[{ where, array->GetName() }] = { array->GetDataType(),
          array->GetNumberOfComponents() };
      }
    }
  }
  return arrays;
}

/// Collective: what some ranks have, and others with cells have not, or not so.
std::set<Place> ArraysOfSome(Communicator& ranks, const std::map<Place, Shape>& mine, bool counts)
{
  vtkMultiProcessStream stream;
  stream << (counts ? 1 : 0) << static_cast<int>(counts ? mine.size() : 0);
  for (const auto& array : mine)
  {
    if (counts)
    {
      stream << array.first.first << array.first.second << array.second.first
             << array.second.second;
    }
  }
  int counting = 0;
  std::map<Place, std::map<Shape, int>> found; // and how many ranks have it so
  for (vtkMultiProcessStream& theirs : AllGatherStreams(ranks, stream))
  {
    int theyCount = 0, arrays = 0;
    theirs >> theyCount >> arrays;
    counting += theyCount;
    for (int i = 0; i < arrays; ++i)
    {
      Place place;
      Shape shape;
      theirs >> place.first >> place.second >> shape.first >> shape.second;
      ++found[place][shape];
    }
  }
  std::set<Place> uneven;
  for (const auto& array : found)
  {
    if (array.second.begin()->second < counting)
    {
      uneven.insert(array.first);
    }
  }
  return uneven;
}

} // namespace

vtkSmartPointer<vtkUnstructuredGrid> WithArraysOfAllRanks(
  Communicator& ranks, vtkUnstructuredGrid* grid)
{
  const bool counts = grid && grid->GetNumberOfCells() > 0;
  const std::set<Place> uneven =
    ArraysOfSome(ranks, grid ? ArraysOf(grid) : std::map<Place, Shape>{}, counts);
  if (uneven.empty() || !grid)
  {
    return grid;
  }
  vtkNew<vtkUnstructuredGrid> copy;
  copy->ShallowCopy(grid);
  for (const Place& array : uneven)
  {
    copy->GetAttributes(array.first)->RemoveArray(array.second.c_str());
    vtkNew<vtkIntArray> mark;
    mark->InsertNextValue(0);
    mark->SetName(LeftOutName(array.first, array.second).c_str());
    copy->GetFieldData()->AddArray(mark);
  }
  return copy;
}

} // namespace banyan
