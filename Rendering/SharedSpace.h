// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_SharedSpace_h
#define banyan_Rendering_SharedSpace_h

#include "VolumeFrame.h"

#include "Render/Raycast/RaySegments.h"

#include <functional>
#include <memory>
#include <vector>

namespace banyan
{

class DepthOrder;

/// Which volumes are mixed, since they share space: one number per frame, the same for those of one
/// group. A volume that is before one of a group and behind another one belongs to it.
std::vector<int> GroupsThatMix(const std::vector<VolumeFrame*>& frames, const DepthOrder& order);

/// Takes what a volume has along the rays of a band of a picture.
/// @return the transmittance at which rays end; 1 where the volume could not be drawn
using CastBand =
  std::function<float(VolumeFrame& frame, const PixelRect& band, SegmentPicture& segments)>;

/// Collective: draws volumes that share space, band after band: what they have along rays takes
/// much memory.
/// @param group the same on all ranks
/// @param root gets the picture
/// @return the picture; null on other ranks
std::shared_ptr<const FloatImage> DrawMixed(Communicator& communicator,
  const std::vector<VolumeFrame*>& group, const PixelRect& rect, int root, const CastBand& cast);

} // namespace banyan

#endif
