// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/ScreenCuts.h"

#include "Parallel/Balance/ZoneDivision.h"
#include "Render/Levels/RayCaster.h"

#include <glm/gtc/matrix_transform.hpp>
#include <glm/matrix.hpp>

#include <cmath>

namespace banyan
{
namespace
{

using Polygon = std::vector<glm::dvec4>;

/// The part of a polygon for which `distance` is not negative; it is linear.
template <typename Distance>
Polygon Clipped(const Polygon& polygon, const Distance& distance)
{
  Polygon inside;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const glm::dvec4& here = polygon[i];
    const glm::dvec4& next = polygon[(i + 1) % polygon.size()];
    const double a = distance(here);
    const double b = distance(next);
    if (a >= 0.0)
    {
      inside.push_back(here);
    }
    if ((a >= 0.0) != (b >= 0.0))
    {
      inside.push_back(here + (a / (a - b)) * (next - here));
    }
  }
  return inside;
}

/// The smallest box that has all of the costs of a zone.
Box CostlyPart(const CostSums& costs, Box zone)
{
  const double nothing = 1e-9 * costs.Total();
  for (int axis = 0; axis < 3; ++axis)
  {
    for (const bool fromBelow : { true, false })
    {
      // The largest slab at this side that has nothing in it.
      int free = 0;
      int most = zone.Size()[axis];
      while (free < most)
      {
        const int middle = free + (most - free + 1) / 2;
        Box slab = zone;
        (fromBelow ? slab.Hi : slab.Lo)[axis] =
          fromBelow ? zone.Lo[axis] + middle : zone.Hi[axis] - middle;
        if (costs.In(slab) <= nothing)
        {
          free = middle;
        }
        else
        {
          most = middle - 1;
        }
      }
      (fromBelow ? zone.Lo : zone.Hi)[axis] += fromBelow ? free : -free;
    }
  }
  return zone;
}

double RaysThrough(const Box& costly, int axis, int plane, const ScreenCuts& cuts)
{
  if (costly.Empty() || plane <= costly.Lo[axis] || plane >= costly.Hi[axis])
  {
    return 0.0;
  }
  Box flat = costly;
  flat.Lo[axis] = flat.Hi[axis] = plane;
  return cuts.Pixels(flat);
}

} // namespace

ScreenCuts::ScreenCuts(const RayScene& scene)
  : ViewportPixels(static_cast<double>(scene.Viewport.Count()))
{
  if (scene.Viewport.Empty())
  {
    return;
  }
  const glm::dvec2 picture(scene.Camera.ImageSize());
  const glm::dvec2 low = 2.0 * glm::dvec2(scene.Viewport.Lo) / picture - 1.0;
  const glm::dvec2 high = 2.0 * glm::dvec2(scene.Viewport.Hi) / picture - 1.0;
  const glm::dvec2 scale = 2.0 / (high - low);
  const glm::dvec2 middle = 0.5 * (low + high);
  const glm::dmat4 zoom =
    glm::translate(glm::scale(glm::dmat4(1.0), glm::dvec3(scale, 1.0)), glm::dvec3(-middle, 0.0));
  this->IndexToView = zoom * glm::inverse(scene.Camera.ClipToWorldMatrix()) * scene.IndexToWorld;
}

double ScreenCuts::Pixels(const Box& flat) const
{
  const glm::dvec3 lo(flat.Lo);
  const glm::dvec3 hi(flat.Hi);
  const int axis = lo.x == hi.x ? 0 : lo.y == hi.y ? 1 : 2;
  const int u = (axis + 1) % 3;
  const int v = (axis + 2) % 3;
  Polygon polygon;
  for (const auto& [high, far] : { std::pair(false, false), std::pair(true, false),
         std::pair(true, true), std::pair(false, true) })
  {
    glm::dvec4 corner(lo, 1.0);
    corner[u] = high ? hi[u] : lo[u];
    corner[v] = far ? hi[v] : lo[v];
    polygon.push_back(this->IndexToView * corner);
  }
  // Parts behind the eye or beside the viewport are not seen.
  double largest = 0.0;
  for (const glm::dvec4& corner : polygon)
  {
    largest = std::max(largest, std::abs(corner.w));
  }
  polygon = Clipped(polygon, [=](const glm::dvec4& p) { return p.w - 1e-6 * largest; });
  polygon = Clipped(polygon, [](const glm::dvec4& p) { return p.w - p.x; });
  polygon = Clipped(polygon, [](const glm::dvec4& p) { return p.w + p.x; });
  polygon = Clipped(polygon, [](const glm::dvec4& p) { return p.w - p.y; });
  polygon = Clipped(polygon, [](const glm::dvec4& p) { return p.w + p.y; });
  double twice = 0.0;
  for (std::size_t i = 0; i < polygon.size(); ++i)
  {
    const glm::dvec4& a = polygon[i];
    const glm::dvec4& b = polygon[(i + 1) % polygon.size()];
    twice += (a.x * b.y - b.x * a.y) / (a.w * b.w);
  }
  // The viewport has an area of 4.
  return 0.125 * std::abs(twice) * this->ViewportPixels;
}

double RaysCut(const ZoneTree& tree, const CostSums& costs, const ScreenCuts& cuts)
{
  const std::vector<Box> zones = NodeZones(tree);
  double rays = 0.0;
  for (std::size_t number = 0; number < zones.size(); ++number)
  {
    const ZoneTree::Node& node = tree.Nodes[number];
    if (!node.IsLeaf())
    {
      rays += RaysThrough(CostlyPart(costs, zones[number]), node.Axis, node.Plane, cuts);
    }
  }
  return rays;
}

ZoneTree TurnedTree(const ZoneTree& tree, const CostSums& costs, const std::vector<double>& speeds,
  int step, const ScreenCuts& cuts, double workPerRay)
{
  const std::vector<double> speedOf = SumsOfNodes(tree, speeds);
  ZoneTree turned = tree;
  std::vector<Box> zones(tree.Nodes.size());
  zones.front() = tree.Whole();
  for (std::size_t number = 0; number < zones.size(); ++number)
  {
    ZoneTree::Node& node = turned.Nodes[number];
    if (node.IsLeaf())
    {
      continue;
    }
    const Box& zone = zones[number];
    const Box costly = CostlyPart(costs, zone);
    const double below = speedOf[static_cast<std::size_t>(node.Below)];
    const double above = speedOf[static_cast<std::size_t>(node.Above)];
    const ZoneTree::Node before = node;
    double least = 0.0;
    for (int turn = 0; turn < 3; ++turn)
    {
      // The axis of before first: others must be better.
      const int axis = (before.Axis + turn) % 3;
      const Division division(costs, zone, axis, step, below, above);
      const int now = axis == before.Axis ? before.Plane : (zone.Lo[axis] + zone.Hi[axis]) / 2;
      const int plane = division.Best(now);
      const double work = division.Slower(plane) * (below + above) +
                          workPerRay * RaysThrough(costly, axis, plane, cuts);
      if (turn == 0 || work < (1.0 - 1e-6) * least)
      {
        least = work;
        node.Axis = axis;
        node.Plane = plane;
      }
    }
    Cut(zone, node, zones);
  }
  return turned;
}

} // namespace banyan
