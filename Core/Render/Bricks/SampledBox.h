// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_SampledBox_h
#define banyan_Render_Bricks_SampledBox_h

#include "Base/Box.h"
#include "Base/Hash.h"
#include "Render/Bricks/BrickView.h"

#include <vector>

namespace banyan
{

/// A view, and which samples of the grid it has.
struct SampledBox
{
  BrickView View; ///< of the sample at Samples.Lo
  Box Samples;
};

/// The part of a view that starts at another of its samples.
BrickView ViewFrom(const SampledBox& from, const glm::ivec3& first);

/// Copies the samples that two boxes have in common, converted to `type`.
/// @param out `[z][y][x]` of `target`, x fastest
void CopySamples(const SampledBox& from, const Box& target, ScalarType type, void* out);

/// Samples of a new view, x fastest, in memory that the view owns.
/// @param values set to that memory, not initialised to anything but 0
BrickView AllocateView(const Box& samples, ScalarType type, void*& values);

/// A hash of the values and the type of a view's samples: where they lie in memory does not matter.
/// Zeros of both signs differ, as NaNs of other bits do.
/// @param size of the view, in samples per axis
Hash128 HashOfSamples(const BrickView& view, const glm::ivec3& size);

/// Puts a box together from others; where several have a sample, the last one's is taken. Samples
/// that none has are 0.
BrickView Assemble(const std::vector<SampledBox>& parts, const Box& samples, ScalarType type);

} // namespace banyan

#endif
