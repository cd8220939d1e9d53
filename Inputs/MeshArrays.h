// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_MeshArrays_h
#define banyan_Inputs_MeshArrays_h

#include "BanyanInputsModule.h"

#include "MeshPieces.h"

#include <string>
#include <vector>

class vtkAbstractArray;
class vtkDataArray;
class vtkDataArraySelection;
class vtkDataSetAttributes;
class vtkUnstructuredGrid;

namespace banyan
{

/// An array of a mesh that is to be written.
struct MeshArray
{
  vtkDataArray* Values = nullptr;
  std::string Name;      ///< in the series, where names are unique
  std::string CellArray; ///< its name as a cell array; empty: it is a point array
};

/// Which arrays of meshes are to be written: all when none is chosen, otherwise those that are.
class BANYANINPUTS_EXPORT MeshArrays
{
public:
  MeshArrays(vtkDataArraySelection* points, vtkDataArraySelection* cells)
    : Points(points)
    , Cells(cells)
  {
  }

  /// @param leaves whether these are hyper trees or AMR, whose arrays all become point arrays: it
  /// does not matter then in which list a name stands
  WantedArrays WantedPoints(bool leaves) const;

  /// Arrays of numbers of a grid that are not written, as others were chosen: "point array p".
  /// @param leaves see WantedPoints
  std::vector<std::string> NotChosen(vtkUnstructuredGrid* grid, bool leaves) const;

  /// The arrays of numbers that are to be written. Numbers of points and cells, and flags of
  /// ghosts, are left out. A cell array with the name of a point array that is written gets another
  /// one in the series. Throws Error when there is none, or one that was chosen is not there.
  /// @param warning receives a sentence about what is left out, or nothing
  std::vector<MeshArray> Of(vtkUnstructuredGrid* grid, bool leaves, std::string& warning) const;

private:
  bool Chosen() const;

  vtkDataArraySelection* Points;
  vtkDataArraySelection* Cells;
};

/// Whether an array holds no values of a simulation: global or pedigree ids, or flags of ghosts.
BANYANINPUTS_EXPORT bool IsNoValue(vtkDataSetAttributes* attributes, vtkAbstractArray* array);

/// The name of a field array, which says that an array is left out of a grid that was merged of
/// pieces, as not all of them have it.
/// @param where vtkDataObject::POINT or CELL
BANYANINPUTS_EXPORT std::string LeftOutName(int where, const std::string& array);

/// Takes such field arrays out of a grid, which may be null.
/// @return a sentence that names the arrays, or nothing
BANYANINPUTS_EXPORT std::string TakeLeftOut(vtkUnstructuredGrid* grid);

} // namespace banyan

#endif
