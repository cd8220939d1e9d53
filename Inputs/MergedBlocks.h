// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_MergedBlocks_h
#define banyan_Inputs_MergedBlocks_h

#include "BanyanInputsModule.h" // for export macro
#include "Base/Hash.h"

#include "vtkSmartPointer.h"

#include <vector>

class vtkDataSet;
class vtkUnstructuredGrid;

namespace banyan
{

/// Blocks of a data set as one grid, step by step: their cells are merged when they are new, and
/// only points and values as long as the cells of all blocks, and which arrays they have, stay the
/// same.
///
/// The result is that of vtkAppendFilter, which takes all cells anew at each step.
class BANYANINPUTS_EXPORT MergedBlocks
{
public:
  /// @param blocks at least one
  vtkSmartPointer<vtkUnstructuredGrid> Of(const std::vector<vtkSmartPointer<vtkDataSet>>& blocks);

  /// One block as it is, of whatever type; several as `Of` makes them.
  /// @param blocks at least one
  vtkSmartPointer<vtkDataSet> AsOne(const std::vector<vtkSmartPointer<vtkDataSet>>& blocks);

  /// How often cells were merged.
  int CellsMerged() const { return this->Merged; }

private:
  vtkSmartPointer<vtkUnstructuredGrid> Kept; ///< cells, and empty arrays
  Hash128 Key;
  int Merged = 0;
};

} // namespace banyan

#endif
