#ifndef banyan_Filters_HexMeshOfGrid_h
#define banyan_Filters_HexMeshOfGrid_h

#include "BanyanFiltersModule.h" // for export macro
#include "HexOctree/HexMesh.h"

#include "vtkSmartPointer.h"

class vtkDataArray;
class vtkUnstructuredGrid;

namespace banyan
{

/// The cells of an unstructured grid for ElementOctree: hexahedra and voxels. Ghost cells (those
/// that another piece has too, and hidden ones) are left out, which takes a copy of the
/// connectivity; otherwise nothing is copied, and the grid is kept alive. Throws Error with the
/// first cell of another type, which says what it is and what to do.
BANYANFILTERS_EXPORT HexMesh HexMeshOf(vtkUnstructuredGrid* grid);

/// Values of the cells that HexMeshOf takes, in its order: the array itself unless cells are left
/// out.
/// @param values of all cells of the grid; may be null
BANYANFILTERS_EXPORT vtkSmartPointer<vtkDataArray> ValuesOfCells(
  vtkUnstructuredGrid* grid, vtkDataArray* values);

} // namespace banyan

#endif
