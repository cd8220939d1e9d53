// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_Fields_HiddenInImage_h
#define banyan_Inputs_Fields_HiddenInImage_h

#include "Base/Box.h"

#include <cstdint>

class vtkImageData;

namespace banyan
{

class HiddenCells;

/// The flags of an image's points when some of them are hidden, else null.
/// Throws Error when there is not one for each point.
const std::uint8_t* FlagsOfHiddenPoints(vtkImageData* image);

/// Whether some of an image's cells are hidden or refined by others, as VTK sees it
/// (vtkDataSetAttributes::HIDDENCELL and REFINEDCELL). Ghost cells that are another piece's are not
/// hidden for that.
/// Throws Error when there is not one flag for each cell.
bool HasHiddenCells(vtkImageData* image);

/// Hides the hidden cells of an image.
/// @param first sample of the whole grid, in the extents of pieces
/// @param hidden of the whole grid
/// Throws Error when there is not one flag for each cell.
void HideCellsOf(vtkImageData* image, const glm::ivec3& first, HiddenCells& hidden);

} // namespace banyan

#endif
