// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_SegmentMixer_h
#define banyan_Render_Raycast_SegmentMixer_h

#include "Render/Raycast/RaySegments.h"

#include <glm/vec4.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace banyan
{

/// Makes pixels of what several volumes have along the rays of a tile. Where volumes share a part
/// of a ray their densities add up, and their colours count by density: what light meets in such a
/// mixture. A segment of one volume is cut where one of another begins or ends, so volumes need no
/// common distance between samples. Exact, but for rounding, for what the segments say.
///
/// A segment of length 0 is a surface. Segments are cut where it is, and it is blended there. All
/// surfaces in one place are a mixture, too, so their order does not matter.
class SegmentMixer
{
public:
  /// @param volumes how many there are
  explicit SegmentMixer(std::size_t volumes)
    : Volumes(volumes)
  {
  }

  /// Adds a part of what a volume has in the tile. Parts may come in any order. They have to stay
  /// until they are mixed.
  void Add(std::size_t volume, const RaySegments& part);

  /// Mixes what was added, and forgets it.
  /// @param limit rays end when their transmittance is not above this
  /// @param pixels of the tile, x fastest, RayTile::Slots of them: set to premultiplied colour and
  /// opacity
  void Mix(float limit, glm::vec4* pixels);

private:
  /// The segments of a volume along one ray.
  struct Span
  {
    const RaySegment* At;
    const RaySegment* End;
  };
  class RayMix;

  /// Segments of a volume by pixel.
  struct OneVolume
  {
    std::vector<const RaySegments*> Parts;
    RaySegments Segments; ///< of all parts, by pixel; what comes behind them is left over
    std::vector<std::uint32_t> Begins; ///< per pixel, and the end
  };

  static void Sort(OneVolume& volume);

  std::vector<OneVolume> Volumes;
};

} // namespace banyan

#endif
