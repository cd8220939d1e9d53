// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_PictureRegions_h
#define banyan_Parallel_Balance_PictureRegions_h

#include "Parallel/Balance/LoadBalancer.h"
#include "Parallel/Communicate/Communicator.h"
#include "Render/Raycast/BrickWork.h"
#include "Render/Scene/RayScene.h"

#include <optional>
#include <vector>

namespace banyan
{

/// Divides a picture among ranks, each of which draws all cells under its pixels: rectangles of
/// whole tiles of samplings, cut by a kd-tree. What frames took moves the cuts, as LoadBalancer
/// moves those of zones: it is given a grid of tiles, one cell deep. Used alike on all ranks.
class PictureRegions
{
public:
  /// Moves cuts for the next frame, and lets the scene tell what its bricks take.
  /// @return a rectangle of the whole picture per rank, disjoint; together they are all of it
  std::vector<PixelRect> BeginFrame(RayScene& scene, int ranks);

  /// After it. Collective.
  void EndFrame(Communicator& communicator);

private:
  glm::ivec2 Size{ 0 }; ///< of the picture
  std::optional<LoadBalancer> Balancer;
  std::vector<Box> Tiles; ///< of each rank
  BrickCosts View;        ///< pixels in which the volume may be, by tiles
  BrickWork Work;         ///< of this rank for the frame
};

} // namespace banyan

#endif
