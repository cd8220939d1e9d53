#ifndef banyan_Filters_MeshPieces_h
#define banyan_Filters_MeshPieces_h

#include "vtkSmartPointer.h"

#include <vector>

class vtkDataObject;
class vtkUnstructuredGrid;

namespace banyan
{

/// The unstructured grids that data hold: themselves, or the blocks of a composite data set. False
/// when they hold anything else.
bool CollectGrids(vtkDataObject* data, std::vector<vtkUnstructuredGrid*>& grids);

/// The only block that has cells; an empty grid when there is none. Throws Error when there are
/// several.
vtkSmartPointer<vtkUnstructuredGrid> OnlyBlock(const std::vector<vtkUnstructuredGrid*>& blocks);

/// The pieces of ranks as one grid without ghost cells. Points and cells stand in the order of
/// their global ids where all pieces have them; otherwise in the order of the ranks. Points of
/// different ranks at the same place are one; of several points at one place the first of one rank
/// is the first of another, and so on. Points that only ghost cells use are left out.
///
/// One piece without ghost cells is handed back as it is.
/// Throws Error when points that are one have different values, or the pieces different arrays.
vtkSmartPointer<vtkUnstructuredGrid> MergePieces(const std::vector<vtkUnstructuredGrid*>& pieces);

} // namespace banyan

#endif
