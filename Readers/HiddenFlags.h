// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_HiddenFlags_h
#define banyan_Readers_HiddenFlags_h

#include "vtkBanyanDeferred.h"

class vtkDataSet;

namespace banyan
{

/// Gives an image the ghost arrays (vtkGhostType) that a series has of its points and cells, if
/// any. A cell of a coarser level is hidden where the fine one at its lowest corner is, or a
/// corner. Between two steps, what is hidden at one of them is hidden.
/// @param image or grid, of which the extent is set
/// @param handle of the step, level and samples; its array does not count. Receives the flags of
/// points. Throws Error.
void AddHiddenFlags(vtkDataSet* image, vtkBanyanDeferred::Handle& handle);

} // namespace banyan

#endif
