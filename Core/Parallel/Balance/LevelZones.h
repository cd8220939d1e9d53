// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_LevelZones_h
#define banyan_Parallel_Balance_LevelZones_h

#include "Base/Box.h"
#include "Render/Levels/RayCaster.h"

#include <vector>

namespace banyan
{

/// Says which coarse cells are drawn of a zone: those that begin in it. Some of them end in the
/// next zone. Zones that begin and end at multiples of its edges, as those of encoded series do,
/// stay as they are; zones of pieces may begin anywhere.

/// Cells of the finest level under those of a level that begin in a zone, inside `domain`.
/// @param edges of cells of the level
Box ZoneAtLevel(const Box& zone, const glm::ivec3& edges, const Box& domain);

/// Per zone, all cells that are drawn of it at the levels of a scene: where its pixels may be.
std::vector<Box> ZonesAsDrawn(const RayScene& scene, const std::vector<Box>& zones);

/// Front-to-back order of zones at the level that a scene is drawn from; of the zones as they are
/// when there are several, which is right for all of them where LevelsHaveOneOrder.
std::vector<int> OrderAsDrawn(const RayScene& scene, const std::vector<Box>& zones);

/// Whether the order of the zones is right at levels 1 to `coarsest` as well. It is not where the
/// eye is between where a zone ends and where its coarse cells end. Depends on the arguments only.
/// May say no where they have one, when zones have no cells at a level.
bool LevelsHaveOneOrder(const RayScene& scene, const std::vector<Box>& zones, int coarsest);

} // namespace banyan

#endif
