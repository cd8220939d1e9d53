// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Balance/LevelZones.h"

#include "Parallel/Balance/Zones.h"
#include "Render/Scene/Viewpoint.h"

#include <algorithm>
#include <iterator>
#include <set>

namespace banyan
{
namespace
{

std::set<int> LevelsOf(const RayScene& scene)
{
  return scene.Samplings && !scene.Levels.AreFinest() ? scene.Samplings->UsedLevels()
                                                      : std::set<int>{ 0 };
}

std::vector<Box> ZonesAtLevel(const std::vector<Box>& zones, int level, const RayScene& scene)
{
  std::vector<Box> boxes;
  boxes.reserve(zones.size());
  for (const Box& zone : zones)
  {
    boxes.push_back(ZoneAtLevel(zone, scene.Levels.At(level), scene.DomainCells));
  }
  return boxes;
}

/// Returns the zones of an order that have cells.
std::vector<int> WithCells(const std::vector<int>& order, const std::vector<Box>& zones)
{
  std::vector<int> some;
  std::copy_if(order.begin(), order.end(), std::back_inserter(some),
    [&](int rank) { return !zones[static_cast<std::size_t>(rank)].Empty(); });
  return some;
}

} // namespace

Box ZoneAtLevel(const Box& zone, const glm::ivec3& edges, const Box& domain)
{
  const Box cells = CellsAtLevel(zone, edges);
  const Box box = Intersection({ cells.Lo * edges, cells.Hi * edges }, domain);
  return zone.Empty() || box.Empty() ? Box{} : box;
}

std::vector<Box> ZonesAsDrawn(const RayScene& scene, const std::vector<Box>& zones)
{
  std::vector<Box> drawn(zones.size());
  for (const int level : LevelsOf(scene))
  {
    const std::vector<Box> boxes = ZonesAtLevel(zones, level, scene);
    for (std::size_t rank = 0; rank < boxes.size(); ++rank)
    {
      drawn[rank] = Union(drawn[rank], boxes[rank]);
    }
  }
  return drawn;
}

std::vector<int> OrderAsDrawn(const RayScene& scene, const std::vector<Box>& zones)
{
  const std::set<int> levels = LevelsOf(scene);
  const int level = levels.size() == 1 ? *levels.begin() : 0;
  return FrontToBack(InIndexSpace(scene.Camera, scene.IndexToWorld),
    level == 0 ? zones : ZonesAtLevel(zones, level, scene));
}

bool LevelsHaveOneOrder(const RayScene& scene, const std::vector<Box>& zones, int coarsest)
{
  const Viewpoint view = InIndexSpace(scene.Camera, scene.IndexToWorld);
  const std::vector<int> order = FrontToBack(view, zones);
  coarsest = scene.Levels.AreFinest() ? 0 : coarsest;
  for (int level = 1; level <= coarsest; ++level)
  {
    const std::vector<Box> boxes = ZonesAtLevel(zones, level, scene);
    if (boxes != zones && WithCells(FrontToBack(view, boxes), boxes) != WithCells(order, boxes))
    {
      return false;
    }
  }
  return true;
}

} // namespace banyan
