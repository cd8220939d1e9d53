// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_ScreenCuts_h
#define banyan_Parallel_Balance_ScreenCuts_h

#include "Parallel/Balance/BrickCosts.h"
#include "Parallel/Balance/ZoneTree.h"
#include "Render/Scene/FloatImage.h"

#include <glm/mat4x4.hpp>

#include <vector>

namespace banyan
{

struct RayScene;

/// How planes of zones look from where the camera is. A ray that goes through such a plane is made
/// on both of its sides, and what hides the far side is not known there: planes that are seen
/// edge-on, with zones side by side on the screen, cost nothing of that.
class ScreenCuts
{
public:
  explicit ScreenCuts(const RayScene& scene);

  /// Pixels of the viewport under a part of a plane.
  /// @param flat cells; Lo and Hi are equal along one axis
  double Pixels(const Box& flat) const;

  /// Whether all planes look the same.
  bool operator==(const ScreenCuts& other) const
  {
    return this->IndexToView == other.IndexToView && this->ViewportPixels == other.ViewportPixels;
  }

private:
  glm::dmat4 IndexToView{ 1.0 }; ///< homogeneous; the viewport is [-1, 1] x [-1, 1]
  double ViewportPixels = 0.0;
};

/// A ray that a plane cuts takes so many samples more: it is made twice, and goes on behind what
/// would have ended it.
constexpr double WorkPerCutRay = 24.0;

/// Rays that planes of a tree cut, of those that meet what costs something; a ray counts as often
/// as it is cut.
double RaysCut(const ZoneTree& tree, const CostSums& costs, const ScreenCuts& cuts);

/// A tree of zones for the same ranks, nested alike, with axes and planes chosen anew from the root
/// down: planes stand where costs balance, along the axis that makes the least work.
/// @param costs of bricks
/// @param speeds of the ranks, positive
/// @param step planes stand at multiples of it
/// @param workPerRay what cutting a ray takes, in the unit of the costs
ZoneTree TurnedTree(const ZoneTree& tree, const CostSums& costs, const std::vector<double>& speeds,
  int step, const ScreenCuts& cuts, double workPerRay);

} // namespace banyan

#endif
