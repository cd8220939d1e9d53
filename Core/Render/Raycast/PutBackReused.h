// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_PutBackReused_h
#define banyan_Render_Raycast_PutBackReused_h

#include "Render/Scene/FloatImage.h"

namespace banyan
{

class ThreadPool;
struct RayScene;

/// Gives a picture the rays that were not cast for it (RayScene::Reused). To be called after
/// compositing, and before InterpolateSkippedPixels.
///
/// @param picture of all ranks
/// @return the part of the rays that show something which were not cast, [0, 1]
double PutBackReused(const RayScene& scene, FloatImage& picture, ThreadPool& pool);

} // namespace banyan

#endif
