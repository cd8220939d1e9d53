// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_MeshPieces_h
#define banyan_Inputs_MeshPieces_h

#include "BanyanInputsModule.h"

#include "vtkSmartPointer.h"

#include <functional>
#include <string>
#include <vector>

class vtkDataObject;
class vtkUnstructuredGrid;

namespace banyan
{

/// The unstructured grids that data hold: themselves, or the blocks of a composite data set. False
/// when they hold anything else.
BANYANINPUTS_EXPORT bool CollectGrids(
  vtkDataObject* data, std::vector<vtkUnstructuredGrid*>& grids);

/// Which point arrays are wanted, by name.
using WantedArrays = std::function<bool(const std::string&)>;

/// Says what becomes of wanted point arrays that only some pieces have, or that differ there.
enum class UnevenArrays
{
  Refused, ///< with an Error that tells the user of a writer what to choose
  LeftOut  ///< and named in the field data: see LeftOutName
};

/// The pieces of ranks, or the blocks of a data set, as one grid without ghost cells. Points and
/// cells stand in the order of their global ids where all pieces have them, which the grid then has
/// as well; otherwise in the order of the pieces. Points of different pieces at the same place are
/// one; of several points at one place the first of one piece is the first of another, and so on.
/// Points that only ghost cells use are left out.
///
/// Cell arrays that only some pieces have are left out, and named in the field data; so are ids.
///
/// One piece without ghost cells is handed back as it is; none gives an empty grid.
/// Throws Error when points that are one have different values, or the pieces different arrays that
/// are to be refused, of those that are wanted.
BANYANINPUTS_EXPORT vtkSmartPointer<vtkUnstructuredGrid> MergePieces(
  const std::vector<vtkUnstructuredGrid*>& pieces, const WantedArrays& wanted,
  UnevenArrays uneven = UnevenArrays::Refused);

} // namespace banyan

#endif
