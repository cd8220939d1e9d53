// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_RestPoints_h
#define banyan_Inputs_RestPoints_h

#include "BanyanInputsModule.h"

#include "vtkSmartPointer.h"

#include <string>

class vtkUnstructuredGrid;

namespace banyan
{

/// A mesh whose points were moved by displacements that it carries, with its points where they were
/// at rest: to the rounding of their type. Shares everything else with `grid`.
/// Throws Error when there is no such point array, or it has not three components.
/// @param displacements name of the point array; empty: `grid` is handed back as it is
BANYANINPUTS_EXPORT vtkSmartPointer<vtkUnstructuredGrid> AtRest(
  vtkUnstructuredGrid* grid, const std::string& displacements);

/// How the points of a later step differ from those of the first one, as the second half of a
/// sentence that says what to do; nothing if they do not: bit for bit, or to what rounding to
/// float32 does where displacements were taken off.
/// @param first, now as AtRest() gave them; as many points each
/// @param displacements as it was given there
BANYANINPUTS_EXPORT std::string HowPointsMoved(
  vtkUnstructuredGrid* first, vtkUnstructuredGrid* now, const std::string& displacements);

} // namespace banyan

#endif
