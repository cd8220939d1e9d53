// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_CellsOfGrid_h
#define banyan_Inputs_CellsOfGrid_h

#include "Mesh/CellSeries/StoredCells.h"

#include <string>
#include <vector>

class vtkUnstructuredGrid;

namespace banyan
{

/// A grid of cells of any type in the form of Core: a copy, without the image, not checked.
/// Coordinates of other types than float become double. Throws Error as CheckWhole
/// does.
StoredCells CellsOfGrid(vtkUnstructuredGrid* grid);

/// The coordinates of all points, as numbers of `type`.
Bytes PointsOfGrid(vtkUnstructuredGrid* grid, ScalarType type);

/// The type that a series keeps the points of a grid in.
ScalarType TypeOfPoints(vtkUnstructuredGrid* grid);

/// Faces of polyhedra, as StoredCells has them.
std::vector<std::int64_t> FacesOfGrid(vtkUnstructuredGrid* grid);

/// Says how the cells of two steps differ, as the second half of a sentence; nothing where they
/// agree.
std::string ChangeOfCells(vtkUnstructuredGrid* before, vtkUnstructuredGrid* now);

} // namespace banyan

#endif
