// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_Fields_PlainSamples_h
#define banyan_Inputs_Fields_PlainSamples_h

#include "Render/Bricks/ArraySamples.h"

class vtkDataArray;
class vtkImageData;

namespace banyan
{

/// The samples of a piece of image data, where they are in memory. Hidden points count as missing.
/// @param values point data of `image`
/// @param component in [0, components), or -1 for the Euclidean norm
/// @param first extent index of the first sample of the whole grid that the piece belongs to
/// Throws Error when the values cannot be decoded or drawn.
SampleArray PlainSamples(
  vtkImageData* image, vtkDataArray* values, int component, const glm::ivec3& first);

} // namespace banyan

#endif
