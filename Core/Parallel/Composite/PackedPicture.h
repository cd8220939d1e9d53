// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_PackedPicture_h
#define banyan_Parallel_Composite_PackedPicture_h

#include "Base/Bytes.h"
#include "Render/Raycast/DepthOrder.h"
#include "Render/Scene/BytePicture.h"

namespace banyan
{

class ThreadPool;

/// A picture of a volume, and where the volume is: pictures of several are blended in that order.
struct PlacedPicture
{
  BytePicture Picture;
  PlacedBody Body; ///< in world space; at most 8 boxes, and none where nothing is shown
};

/// Lossless bytes of a picture, for a slow line: PackPixels, and zstd, of bands of rows. Gives the
/// same bytes with any number of threads. Throws Error when there are too many boxes.
Bytes PackPicture(const PlacedPicture& placed, ThreadPool& threads);

/// The inverse. Throws Error when the bytes are not those of a picture.
PlacedPicture UnpackPicture(const Bytes& packed, ThreadPool& threads);

} // namespace banyan

#endif
