// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_PictureRegions_h
#define banyan_Parallel_Balance_PictureRegions_h

#include "Parallel/Balance/LoadBalancer.h"
#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Composite/PicturePlace.h"
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
  /// @param places where pixels end: each rank gets a region near its own place, which stays its
  /// own while the places stay
  /// @return a rectangle of the whole picture per rank, disjoint; together they are all of it
  std::vector<PixelRect> BeginFrame(
    RayScene& scene, int ranks, const std::vector<PicturePlace>& places = {});

  /// After it. Collective.
  void EndFrame(Communicator& communicator);

private:
  void Start(const glm::ivec2& size, int ranks, const std::vector<PicturePlace>& places);
  PixelRect PixelsOf(const Box& tiles) const;

  glm::ivec2 Size{ 0 }; ///< of the picture
  std::vector<PicturePlace> Places;
  std::optional<LoadBalancer> Balancer;
  std::vector<int> RankOfSeat; ///< of each leaf of the tree
  std::vector<Box> Tiles;      ///< of each leaf
  BrickCosts View;             ///< pixels in which the volume may be, by tiles
  BrickWork Work;              ///< of this rank for the frame
};

} // namespace banyan

#endif
