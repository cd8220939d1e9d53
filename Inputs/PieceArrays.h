// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_PieceArrays_h
#define banyan_Inputs_PieceArrays_h

#include "MeshPieces.h"
#include "PieceItems.h"

#include <string>
#include <utility>
#include <vector>

class vtkDataSetAttributes;

namespace banyan
{

/// The arrays of a grid that is made of points and cells of several pieces.
class PieceArrays
{
public:
  /// Two points of different pieces that are one.
  using Twins = std::vector<std::pair<PieceItem, PieceItem>>;

  PieceArrays(const std::vector<vtkUnstructuredGrid*>& pieces, const WantedArrays& wanted,
    UnevenArrays uneven)
    : Pieces(pieces)
    , Wanted(wanted)
    , Uneven(uneven)
  {
  }

  /// Arrays of points that all pieces have. Others are left out where `uneven` says so, or where
  /// they are numbers of points, and named in the field data (see LeftOutName). Throws Error for
  /// those that are wanted, and for points that are one and have different values.
  void AddPoints(
    const std::vector<PieceItem>& points, const Twins& twins, vtkUnstructuredGrid* grid) const;

  /// Arrays of cells that all pieces have; others are named in the field data. Field arrays of the
  /// pieces.
  void AddCells(const std::vector<PieceItem>& cells, vtkUnstructuredGrid* grid) const;

private:
  std::vector<vtkDataArray*> PartsOf(int where, vtkDataArray* like) const;
  vtkSmartPointer<vtkDataArray> Joined(vtkDataArray* like, const std::vector<vtkDataArray*>& parts,
    const std::vector<PieceItem>& points, const Twins& twins) const;

  const std::vector<vtkUnstructuredGrid*>& Pieces;
  const WantedArrays& Wanted;
  UnevenArrays Uneven;
};

} // namespace banyan

#endif
