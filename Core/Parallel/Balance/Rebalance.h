// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Balance_Rebalance_h
#define banyan_Parallel_Balance_Rebalance_h

#include "Parallel/Balance/BrickCosts.h"
#include "Parallel/Balance/ZoneTree.h"

#include <vector>

namespace banyan
{

/// Largest over mean, at least 1; 1 where there is nothing.
double ImbalanceOf(const std::vector<double>& seconds);

/// Puts each plane where the costs on its sides are in the ratio of the speeds there, from the root
/// down. Nothing moves for a gain that is not worth it.
///
/// @param costs of bricks, in any unit
/// @param speeds of the ranks, in costs per second; positive
/// @param leastGain by which the expected imbalance must fall for planes to move
/// @param step planes move to multiples of it, or to the end of the grid
/// Throws Error when the arguments do not fit together.
ZoneTree RebalanceMeasuredCost(const ZoneTree& tree, const BrickCosts& costs,
  const std::vector<double>& speeds, double leastGain = 0.0, int step = 1);

/// Goes from one tree towards another as far as `most` bytes allow. All planes go the same part of
/// their way. Where that moves none, the first plane from the root on that may move goes one step.
/// Trees with other axes or another nesting are reached at once.
/// @param bytes that moving each brick takes
ZoneTree WithinBytes(
  const ZoneTree& from, const ZoneTree& to, const CostSums& bytes, double most, int step);

/// A tree made for costs, as RebalanceMeasuredCost would move planes of an EqualZoneTree.
ZoneTree CostZoneTree(const BrickCosts& costs, const std::vector<double>& speeds);

/// Expected seconds of each rank.
std::vector<double> ExpectedSeconds(
  const ZoneTree& tree, const CostSums& costs, const std::vector<double>& speeds);

/// Expected seconds of the slowest rank over those that no tree could beat; at least 1, and for
/// equal speeds the same as ImbalanceOf.
double ExpectedImbalance(
  const ZoneTree& tree, const CostSums& costs, const std::vector<double>& speeds);

/// All planes the same part of the way from one tree to another, whose zones are nested alike.
/// @param part in [0, 1]
/// @param step planes of the result stand at multiples of it
ZoneTree PartOfTheWay(const ZoneTree& from, const ZoneTree& to, double part, int step);

/// Returns the bytes that change ranks from one tree to another of the same grid.
double MovedBetween(const ZoneTree& from, const ZoneTree& to, const CostSums& bytes);

} // namespace banyan

#endif
