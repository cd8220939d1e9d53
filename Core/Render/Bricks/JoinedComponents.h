// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_JoinedComponents_h
#define banyan_Render_Bricks_JoinedComponents_h

#include "Render/Bricks/BrickView.h"
#include "Series/Quantize/ValueRange.h"

#include <glm/vec3.hpp>

#include <vector>

namespace banyan
{

// All components of an array as one field. `how` is SampleArray::Magnitude or
// SampleArray::Colours.

/// Throws Error when an array of so many components has no colours.
void CheckColours(int components);

/// The type of joined samples: float32 for lengths, float64 for colours (ColourNumber).
ScalarType JoinedType(int how);

/// Joins the samples of all components.
/// @param parts one view per component, each of `samples` samples
/// @return x fastest, without gaps
BrickView Joined(int how, const std::vector<BrickView>& parts, const glm::ivec3& samples);

/// Bounds of lengths, or of what the opacity function is asked for, where components lie in the
/// given ranges; empty when one of them is.
ValueRange JoinedBounds(int how, const std::vector<ValueRange>& components);

} // namespace banyan

#endif
