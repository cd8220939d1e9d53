// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_LinearParts_h
#define banyan_Inputs_LinearParts_h

#include "AnyMesh/WeightedPoints.h"
#include "BanyanInputsModule.h" // for export macro
#include "HexMeshOfGrid.h"

#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <memory>
#include <vector>

class vtkDataArray;
class vtkUnstructuredGrid;

namespace banyan
{

/// A grid whose cells are divided into linear ones.
struct BANYANINPUTS_EXPORT LinearParts
{
  vtkSmartPointer<vtkUnstructuredGrid> Grid; ///< points of the old one, then new ones; no arrays
  vtkIdType OldPoints = 0;                   ///< how many of its points are the old ones
  vtkIdType OldCells = 0;                    ///< of the old grid
  WeightedPoints NewPoints;                  ///< the others, made of old ones
  std::vector<vtkIdType> CellOf;             ///< the old cell of each cell
  OtherCells Folded;                         ///< polyhedra that are not right, see LinearPartsOf
  Hash128 Key;                               ///< of the old points and cells

  /// Values or coordinates of the points, made of those of the old ones: float32 for types that it
  /// holds, float64 for others. The sum for a new point is made in double.
  /// @param old one tuple for each old point, of any time step
  /// Throws Error for another number of tuples, and when the type is none of numbers.
  vtkSmartPointer<vtkDataArray> PointValues(vtkDataArray* old) const;

  /// Values of the cells: those of the old ones.
  /// @param old one tuple for each old cell, of any time step
  /// Throws Error for another number of tuples.
  vtkSmartPointer<vtkDataArray> CellValues(vtkDataArray* old) const;
};

/// Whether cells of a type are divided by LinearPartsOf: quadratic ones, prisms over pentagons and
/// hexagons, polyhedra, and convex sets of points.
/// @param type as VTK numbers them
BANYANINPUTS_EXPORT bool HasLinearParts(int type);

/// Divides cells into linear ones (see SplitRuleOf). A polyhedron becomes a tetrahedron for each
/// triangle of its faces, from the mean of its points; faces of more than three points are fans
/// around their own mean. That is right where this mean sees all faces from inside; others are
/// counted as Folded. A convex set of points becomes VTK's own tetrahedra. Linear cells stay as
/// they are; points, lines, faces, and types that nothing is known of are left out.
///
/// Neighbours share new points. A new point is a sum in the order of the places of its sources,
/// rounded to the type of the points: in whatever order cells name them, in whatever piece, it is
/// at the same place to the bit.
/// @param grid float or double points
/// @param before what was made for another step; may be null
/// @return `before` itself where it was made of the same points and cells
/// Throws Error when a cell has another number of points than its type says, or names one that does
/// not exist.
BANYANINPUTS_EXPORT std::shared_ptr<const LinearParts> LinearPartsOf(
  vtkUnstructuredGrid* grid, const std::shared_ptr<const LinearParts>& before = nullptr);

} // namespace banyan

#endif
