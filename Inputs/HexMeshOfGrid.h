// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_HexMeshOfGrid_h
#define banyan_Inputs_HexMeshOfGrid_h

#include "BanyanInputsModule.h" // for export macro
#include "Mesh/Octree/HexMesh.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <string>

class vtkDataArray;
class vtkUnstructuredGrid;

namespace banyan
{

/// Cells of a grid that are neither hexahedra nor voxels.
struct OtherCells
{
  vtkIdType Count = 0;
  vtkIdType First = 0;
  std::string Type; ///< of the first one

  /// "12 cells, cell 3 of the type vtkTetra the first of them"
  std::string Text() const;
};

/// Throws Error when cells have no points at all, or not each cell has a type and a flag.
void CheckWhole(vtkUnstructuredGrid* grid);

/// The cells of an unstructured grid for ElementOctree: hexahedra and voxels. Ghost cells (those
/// that another piece has too, and hidden ones) are left out, which takes a copy of the
/// connectivity; otherwise nothing is copied, and the grid is kept alive.
/// @param others null: throws Error with the first cell of another type, which says what it is and
/// what to do. Otherwise such cells are left out, and this says which
BANYANINPUTS_EXPORT HexMesh HexMeshOf(vtkUnstructuredGrid* grid, OtherCells* others = nullptr);

/// Whether there is something that boxes can be sampled of (see SampledGrid): hexahedra or voxels
/// whose points exist, are finite, and lie apart along x, y and z.
bool CanBeSampled(vtkUnstructuredGrid* grid);

/// Whether all cells that have a volume are hexahedra and voxels, and some that are looked at have
/// edges along x, y and z: the mesh may be an octree then.
BANYANINPUTS_EXPORT bool HasBoxesAlone(vtkUnstructuredGrid* grid);

/// Values of the cells that HexMeshOf takes when it may leave out others, in its order: the array
/// itself unless cells are left out.
/// @param values of all cells of the grid; may be null
BANYANINPUTS_EXPORT vtkSmartPointer<vtkDataArray> ValuesOfCells(
  vtkUnstructuredGrid* grid, vtkDataArray* values);

} // namespace banyan

#endif
