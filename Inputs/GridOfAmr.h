// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_GridOfAmr_h
#define banyan_Inputs_GridOfAmr_h

#include "BanyanInputsModule.h" // for export macro

#include "vtkSmartPointer.h"

#include <cstdint>
#include <string>
#include <vector>

class vtkOverlappingAMR;
class vtkUnstructuredGrid;

namespace banyan
{

/// A block of an AMR data set in cells of its own level, half-open. Plain memory: ranks send it as
/// it is.
struct AmrBox
{
  std::int32_t Level = 0;
  std::int32_t Lo[3] = { 0, 0, 0 };
  std::int32_t Hi[3] = { 0, 0, 0 };
};

/// The blocks whose data this process has. Ranks have the boxes of all blocks, but not their data:
/// only blocks that one of them has hide the coarser cells below. Throws Error with a sentence for
/// blocks without volume, of other sizes or places than their boxes, and for levels whose cells are
/// not smaller by the same power of two along all axes.
BANYANINPUTS_EXPORT std::vector<AmrBox> BoxesOf(vtkOverlappingAMR* blocks);

/// The visible cells of the blocks that this process has, as voxels with their data, level by level
/// and block by block. Cells that blocks of the next level cover are left out, and those that are
/// flagged as ghosts, hidden or refined. Each block has points of its own: at one place those of
/// two blocks may have different values.
/// @param all the blocks of all processes
/// @param array name of the only array that is wanted; all that all blocks have where empty
/// Throws Error as BoxesOf, and where a cell is covered in part.
BANYANINPUTS_EXPORT vtkSmartPointer<vtkUnstructuredGrid> GridOfAmr(
  vtkOverlappingAMR* blocks, const std::vector<AmrBox>& all, const std::string& array = {});

class Communicator;

/// Collective. The boxes of all ranks, in the order of ranks.
std::vector<AmrBox> BoxesOfAll(Communicator& ranks, const std::vector<AmrBox>& mine);

/// Collective: GridOfAmr with the blocks of all ranks. Throws CollectiveError.
vtkSmartPointer<vtkUnstructuredGrid> GridOfAmrOnRanks(
  Communicator& ranks, vtkOverlappingAMR* blocks);

} // namespace banyan

#endif
