// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_HiddenOfData_h
#define banyan_Inputs_HiddenOfData_h

#include <cstdint>
#include <vector>

class vtkDataSet;

namespace banyan
{

/// 1 for each cell that is not drawn: another piece has it too (see GhostBits), it is blanked,
/// finer cells replace it, or one of its points is blanked. Empty where there are none. Throws
/// Error when there is not one flag for each point or cell, or a cell names a point that does not
/// exist.
std::vector<std::uint8_t> HiddenCellsOf(vtkDataSet* data);

} // namespace banyan

#endif
