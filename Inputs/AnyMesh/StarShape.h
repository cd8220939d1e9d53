// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_StarShape_h
#define banyan_Inputs_StarShape_h

#include "vtkType.h"

#include <vector>

class vtkPoints;

namespace banyan
{

/// Whether the mean of a polyhedron's points sees all of its faces from inside, as fans around
/// their own means (see LinearPartsOf). The direction that faces are listed in does not matter.
/// @param faces numbers of points, which exist
bool IsStarAroundMean(const std::vector<std::vector<vtkIdType>>& faces, vtkPoints* points);

} // namespace banyan

#endif
