// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_MixVolumes_h
#define banyan_Parallel_Composite_MixVolumes_h

#include "Parallel/Composite/TilePicture.h"
#include "Render/Raycast/RaySegments.h"

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Volumes that share space, as ranks have them along rays.
struct MixedVolumes
{
  /// By volume: what this rank has, any part of it.
  std::vector<std::vector<TileSegments>> Segments;
  PixelRect Viewport;
  float TransmittanceLimit = 0.0f; ///< rays end when their transmittance is not above this
};

/// Collective: the picture of volumes that share space. Tiles belong to ranks in turn. Each gets
/// all that ranks have of its tiles, and mixes it (SegmentMixer).
/// @param space the same on all ranks, but for the segments
/// @param root has the picture
/// @param failure of this rank so far: its sentence, empty if all is well
/// @param sent is added to
/// @return the picture on the root: premultiplied, within rounding the same for any number of ranks
/// Throws CollectiveError.
FloatImage MixVolumes(Communicator& communicator, MixedVolumes space, ThreadPool& pool, int root,
  std::string failure, SentBytes& sent);

/// Takes what a volume has along the rays of a block of a picture. Collective.
/// @return the transmittance at which its rays end; 1 where it could not be drawn
using CastBlock =
  std::function<float(std::size_t volume, const PixelRect& block, SegmentPicture& segments)>;

/// Collective: the same of a picture, block after block, since segments take much memory: about 48
/// MB on a rank. A block is rows of tiles, a part of one, or a tile where that alone has more.
/// @param volumes how many there are
/// @param sent this rank's bytes are added
/// @return the picture on the root; null on other ranks
std::shared_ptr<const FloatImage> MixInBlocks(Communicator& communicator, std::size_t volumes,
  const PixelRect& rect, int root, ThreadPool& pool, const CastBlock& cast, SentBytes& sent);

} // namespace banyan

#endif
