// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Rebalance_h
#define banyan_Parallel_Rebalance_h

#include "Parallel/BrickCosts.h"
#include "Parallel/ZoneTree.h"

#include <limits>
#include <vector>

namespace banyan
{

/// How zones follow what frames cost.
enum class LoadBalancing
{
  Off,         ///< zones of equal size
  SliceStep,   ///< RebalanceSliceStep
  MeasuredCost ///< RebalanceMeasuredCost
};

/// Largest over mean, at least 1; 1 where there is nothing.
double ImbalanceOf(const std::vector<double>& seconds);

/// The published rule: seconds are summed up the tree, and depth first each plane moves by one
/// slice of bricks towards the child that costs more. With unequal numbers of ranks under the
/// children the costs are those per rank. Planes stay `slice` apart where there is room, so that no
/// zone is lost.
///
/// @param rankSeconds of the last frame, one per rank
/// @param slice positions that a plane moves by, at least 1
/// @par Source: "Dynamic load balancing for parallel volume rendering", section 3.2
/// Throws Error when the numbers of ranks differ.
ZoneTree RebalanceSliceStep(
  const ZoneTree& tree, const std::vector<double>& rankSeconds, int slice = 1);

/// What RebalanceMeasuredCost may do.
struct RebalanceLimits
{
  double Tolerated = 1.04; ///< expected imbalance at which the tree is left alone
  double LeastGain = 0.01; ///< by which the expected imbalance must fall for planes to move
  int PlaneStep = 1;       ///< planes move to multiples of it, or to the end of the grid
  /// What moving each brick takes: bytes, say. Null for nothing.
  const BrickCosts* Bytes = nullptr;
  double MostBytes = std::numeric_limits<double>::infinity(); ///< that change ranks
};

struct Rebalanced
{
  ZoneTree Tree;
  double Before = 1.0;     ///< expected imbalance of the old tree
  double After = 1.0;      ///< and of this one
  double BytesMoved = 0.0; ///< at most MostBytes
};

/// Ours: puts each plane where the costs on its sides are in the ratio of the speeds there, from
/// the root down. Where that would move more bytes than allowed, all planes go the same part of
/// their way. Nothing moves for a gain that is not worth it.
///
/// @param costs of bricks, in any unit
/// @param speeds of the ranks, in costs per second; positive
/// Throws Error when the arguments do not fit together.
Rebalanced RebalanceMeasuredCost(const ZoneTree& tree, const BrickCosts& costs,
  const std::vector<double>& speeds, const RebalanceLimits& limits = {});

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

/// What changes ranks from one tree to another of the same grid.
double MovedBetween(const ZoneTree& from, const ZoneTree& to, const CostSums& bytes);

} // namespace banyan

#endif
