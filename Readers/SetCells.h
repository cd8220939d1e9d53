// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_SetCells_h
#define banyan_Readers_SetCells_h

#include "vtkCellArray.h"
#include "vtkCellType.h"
#include "vtkIdTypeArray.h"
#include "vtkNew.h"
#include "vtkUnsignedCharArray.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cstdint>
#include <vector>

namespace banyan
{

/// Faces of polyhedra, one polyhedron after the other: how many faces; per face how many points,
/// and these.
using FaceStreams = std::vector<std::int64_t>;

namespace set_cells
{

/// Since VTK 9.4: faces are cells, and polyhedra lists of them.
template <class Grid>
auto SetPolyhedra(Grid* grid, vtkUnsignedCharArray* types, vtkCellArray* cells,
  const FaceStreams& streams, int) -> decltype(grid->SetPolyhedralCells(types, cells, cells, cells))
{
  vtkNew<vtkCellArray> faces, facesOfCells;
  std::size_t at = 0;
  for (vtkIdType cell = 0; cell < types->GetNumberOfValues(); ++cell)
  {
    const bool polyhedron = types->GetValue(cell) == VTK_POLYHEDRON;
    const std::int64_t count = polyhedron ? streams[at++] : 0;
    facesOfCells->InsertNextCell(static_cast<int>(count));
    for (std::int64_t face = 0; face < count; ++face)
    {
      const std::int64_t corners = streams[at++];
      facesOfCells->InsertCellPoint(faces->InsertNextCell(static_cast<int>(corners)));
      for (std::int64_t i = 0; i < corners; ++i)
      {
        faces->InsertCellPoint(static_cast<vtkIdType>(streams[at++]));
      }
    }
  }
  grid->SetPolyhedralCells(types, cells, facesOfCells, faces);
}

/// To be dropped with VTK 9.3: faces are one array, and cells have places in it.
template <class Grid>
void SetPolyhedra(
  Grid* grid, vtkUnsignedCharArray* types, vtkCellArray* cells, const FaceStreams& streams, long)
{
  vtkNew<vtkIdTypeArray> faces, places;
  faces->SetNumberOfValues(static_cast<vtkIdType>(streams.size()));
  std::copy(streams.begin(), streams.end(), faces->GetPointer(0));
  places->SetNumberOfValues(types->GetNumberOfValues());
  std::size_t at = 0;
  for (vtkIdType cell = 0; cell < types->GetNumberOfValues(); ++cell)
  {
    const bool polyhedron = types->GetValue(cell) == VTK_POLYHEDRON;
    places->SetValue(cell, polyhedron ? static_cast<vtkIdType>(at) : -1);
    const std::int64_t count = polyhedron ? streams[at++] : 0;
    for (std::int64_t face = 0; face < count; ++face)
    {
      at += 1 + static_cast<std::size_t>(streams[at]);
    }
  }
  grid->SetCells(types, cells, places, faces);
}

} // namespace set_cells

/// Gives a grid its cells, polyhedra among them, with their points in the order that is given.
inline void SetCells(vtkUnstructuredGrid* grid, vtkUnsignedCharArray* types, vtkCellArray* cells,
  const FaceStreams& faces)
{
  if (faces.empty())
  {
    grid->SetCells(types, cells);
    return;
  }
  set_cells::SetPolyhedra(grid, types, cells, faces, 0);
}

} // namespace banyan

#endif
