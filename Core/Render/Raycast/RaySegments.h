// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_RaySegments_h
#define banyan_Render_Raycast_RaySegments_h

#include <glm/vec2.hpp>

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>
#include <vector>

namespace banyan
{

/// A part of a ray in which a volume has one colour and one density: the interval of a sample.
struct RaySegment
{
  double Begin = 0.0;         ///< t along the ray, in the space of the scene's camera
  float Length = 0.0f;        ///< the same; 0 for a surface
  float Color[3] = {};        ///< premultiplied, of the whole segment
  float Transmittance = 1.0f; ///< of the whole segment
  std::uint32_t Pixel = 0;    ///< of the tile, x fastest
};

using RaySegments = std::vector<RaySegment>;

/// What a volume has along the rays of a tile of TileSamplings, or of a part of the tile. Segments
/// of a pixel are in the order of the ray, and have no point in common.
struct TileSegments
{
  glm::ivec2 Position{ 0 };
  RaySegments Segments;
};

/// What one rank has of a volume along the rays of a picture. A tile may be in it in several parts.
class SegmentPicture
{
public:
  /// From any thread.
  void Add(TileSegments tile)
  {
    if (!tile.Segments.empty())
    {
      const std::lock_guard<std::mutex> lock(this->Mutex);
      this->Count += tile.Segments.size();
      this->Tiles.push_back(std::move(tile));
    }
  }

  /// All parts, in any order; nothing is left.
  std::vector<TileSegments> Take()
  {
    const std::lock_guard<std::mutex> lock(this->Mutex);
    this->Count = 0;
    return std::exchange(this->Tiles, {});
  }

  std::size_t Bytes() const { return this->Count * sizeof(RaySegment); }

private:
  std::mutex Mutex;
  std::vector<TileSegments> Tiles;
  std::size_t Count = 0; ///< of segments
};

} // namespace banyan

#endif
