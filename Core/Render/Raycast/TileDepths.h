// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Raycast_TileDepths_h
#define banyan_Render_Raycast_TileDepths_h

#include "Render/Scene/RayScene.h"

#include <vector>

namespace banyan
{

/// How near a volume comes to the eye under each tile of a picture: per tile (TileSamplings), the
/// smallest w in clip space of what may be seen of the scene's DomainCells there; infinite where
/// there is nothing. It depends on the camera and on DomainCells only, so all ranks find the same.
///
/// The domain is cut into up to 16 x 16 x 16 blocks. A tile takes the nearest corner of the blocks
/// that may be under it: depths are too small by at most a block. Of a block that the plane of the
/// eye goes through only what is in front of it, within the edges of the picture, counts; where the
/// eye is inside of a block, all depths are 0.
class TileDepths
{
public:
  explicit TileDepths(const RayScene& scene);

  glm::ivec2 Tiles() const { return this->TileCounts; }
  /// @param tile inside Tiles()
  double At(const glm::ivec2& tile) const
  {
    return this->Depths[static_cast<std::size_t>(tile.y) * this->TileCounts.x + tile.x];
  }

private:
  void Add(const std::vector<glm::dvec4>& points);
  glm::ivec2 TileUnder(const glm::dvec2& place) const;

  glm::ivec2 ImageSize;
  glm::ivec2 TileCounts;
  std::vector<double> Depths;
};

/// World lengths of the two sides of a pixel where w is 1; elsewhere they are w times as long.
glm::dvec2 PixelSides(const RayCamera& camera);

} // namespace banyan

#endif
