// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_Zones_h
#define banyan_Parallel_Balance_Zones_h

#include "Base/Box.h"
#include "Render/Scene/Viewpoint.h"

#include <string>
#include <vector>

namespace banyan
{

/// The zones of EqualZoneTree: one per rank, half-open boxes of brick positions, disjoint. They
/// cover the grid; with more ranks than bricks some are empty.
std::vector<Box> StaticZones(const glm::ivec3& bricks, int ranks);

/// Cells of a zone of bricks.
Box CellsOfBricks(const Box& bricks, int brickCells, const glm::ivec3& allCells);

/// Front-to-back order of disjoint boxes: box a stands before box b in the result when a can hide
/// b. Exact for perspective (camera inside a box included) and parallel projections. Empty boxes
/// come last. Throws Error when boxes hide each other in a circle (not possible for zones of a
/// kd-tree).
/// Among the orders that are right it gives the one with the lowest box numbers first, so that all
/// ranks agree.
/// @param view in the space of the boxes: index space, where cell c lies between samples c and
///        c + 1, so that box corners are positions as they stand
std::vector<int> FrontToBack(const Viewpoint& view, const std::vector<Box>& boxes);

} // namespace banyan

#endif
