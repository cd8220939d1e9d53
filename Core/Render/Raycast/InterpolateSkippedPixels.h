// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_InterpolateSkippedPixels_h
#define banyan_Render_Raycast_InterpolateSkippedPixels_h

#include "Render/Scene/FloatImage.h"

namespace banyan
{

class ThreadPool;
struct RayScene;

/// Makes the pixels that have no ray of their own (RaySampling::PixelStride) from the nearest that
/// have: bilinear between the four around them, also where these belong to tiles with other
/// strides, so that nothing jumps at the edges of tiles.
///
/// To be called once all rays are complete: of what several ranks have drawn, after compositing.
/// What it does to a pixel does not depend on threads or on how the picture was divided.
///
/// @param picture a part of the scene's; all outside of it counts as empty
void InterpolateSkippedPixels(const RayScene& scene, FloatImage& picture, ThreadPool& pool);

/// What has to be drawn of a scene's viewport for all pixels of a rectangle: those around it, too,
/// that pixels without rays are made from.
PixelRect WithMargin(const RayScene& scene, const PixelRect& rect);

} // namespace banyan

#endif
