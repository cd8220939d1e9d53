#ifndef banyan_Filters_MeshArrays_h
#define banyan_Filters_MeshArrays_h

#include "MeshPieces.h"

#include <string>
#include <vector>

class vtkDataArray;
class vtkDataArraySelection;
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
class MeshArrays
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

/// The name of a field array, which says that a cell array is only in some of the pieces
/// that a grid was merged of.
inline std::string InSomePiecesName(const std::string& array)
{
  return "in some pieces only: " + array;
}

} // namespace banyan

#endif
