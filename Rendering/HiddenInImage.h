// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_HiddenInImage_h
#define banyan_Rendering_HiddenInImage_h

#include "Base/Box.h"

#include <cstdint>
#include <memory>

class vtkImageData;

namespace banyan
{

class Communicator;
class HiddenCells;

/// The flags of an image's points when some of them are hidden, else null.
/// Throws Error when there is not one for each point.
const std::uint8_t* FlagsOfHiddenPoints(vtkImageData* image);

/// The flags of an image's cells when some of them are hidden or refined by others, as VTK sees it
/// (vtkDataSetAttributes::HIDDENCELL and REFINEDCELL), else null. Ghost cells that are another
/// piece's are not hidden for that.
/// Throws Error when there is not one for each cell.
const std::uint8_t* FlagsOfHiddenCells(vtkImageData* image);

/// Collective: the hidden cells of all ranks' pieces. Where pieces overlap, a cell is hidden that
/// is hidden in one of them.
/// @param image this rank's piece; null for none
/// @param first sample of the whole grid, in the extents of pieces
/// @param cells of the whole grid
/// Throws Error, the same on all ranks, when one cannot.
std::shared_ptr<const HiddenCells> GatherHiddenCells(Communicator& communicator,
  vtkImageData* image, const glm::ivec3& first, const glm::ivec3& cells);

} // namespace banyan

#endif
