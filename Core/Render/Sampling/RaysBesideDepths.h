// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_RaysBesideDepths_h
#define banyan_Render_Sampling_RaysBesideDepths_h

#include "Render/Scene/RayScene.h"

#include <memory>

namespace banyan
{

/// Samplings that were chosen as if nothing opaque were in a picture, for one where something is.
/// @param scene its depths and its viewport
/// @return the same, but with a ray in each pixel of tiles in which something opaque is, and of
/// those next to them: pixels are not interpolated over its edges. Null for null
std::shared_ptr<const TileSamplings> WithRaysBesideDepths(
  const std::shared_ptr<const TileSamplings>& samplings, const RayScene& scene);

} // namespace banyan

#endif
