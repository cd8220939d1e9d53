// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_CellMeshOfData_h
#define banyan_Inputs_CellMeshOfData_h

#include "BanyanInputsModule.h" // for export macro
#include "HexMeshOfGrid.h"

#include "Cells/CellMesh.h"
#include "Mesh/Octree/CellNodes.h"

#include "vtkSmartPointer.h"

#include <memory>

class vtkDataArray;
class vtkDataSet;

namespace banyan
{

struct LinearParts;

/// The cells of some data as Core draws them.
struct BANYANINPUTS_EXPORT MeshOfData
{
  CellMesh Mesh;     ///< no cells where the data have none in three dimensions
  OtherCells Others; ///< those left out: in fewer dimensions, or of a type that is not known
  /// Null where points and cells of the mesh are those of the data.
  std::shared_ptr<const LinearParts> Parts;

  /// Values of the mesh's points or cells, in their order: the array itself unless there are Parts.
  /// @param values of all points or cells of the data, of any time step; may be null
  /// Throws Error for another number of tuples.
  vtkSmartPointer<vtkDataArray> ValuesOf(vtkDataArray* values, ValuesOn where) const;
};

/// The cells of an unstructured, explicit structured, structured or rectilinear grid. Arrays are
/// taken where they are, in float or double, with ids of 32 or 64 bits, and are kept alive; others
/// are copied. Cells that are not linear take a copy of the grid (see LinearPartsOf). Numbers of
/// points are not looked at otherwise: see CheckMesh.
///
/// Hidden are cells that another piece has too, that are blanked, that finer ones replace, and all
/// that use a blanked point.
/// @param data may be null; other types of data give a mesh without cells
/// @param before of another step: its Parts are taken where points and cells are the same
/// Throws Error when arrays are missing or too short.
BANYANINPUTS_EXPORT MeshOfData CellMeshOf(vtkDataSet* data, const MeshOfData& before = {});

} // namespace banyan

#endif
