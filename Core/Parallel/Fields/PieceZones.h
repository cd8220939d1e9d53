// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_PieceZones_h
#define banyan_Parallel_Fields_PieceZones_h

#include "Parallel/Balance/FrameBalancer.h"
#include "Parallel/Fields/PieceGrid.h"

namespace banyan
{

/// Zones in which everything is drawn where it lies: a tree whose planes stand between the pieces,
/// and the ranks in the order of its leaves. Zones of ranks without data are empty, and lie where
/// they can take part of another rank's when planes move. Where no plane goes between pieces, one
/// cuts the fewest of them it can, and a part of those is in the zone of another rank.
///
/// @param cells of the whole grid
/// Throws Error when there are no ranks.
ZonesOfRanks ZonesOfPieces(const PieceGrid& grid, const glm::ivec3& cells);

} // namespace banyan

#endif
