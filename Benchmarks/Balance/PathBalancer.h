// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_PathBalancer_h
#define banyan_Benchmarks_PathBalancer_h

#include "BalanceOptions.h"

#include "Parallel/Balance/LoadBalancer.h"

namespace banyan::bench
{

/// Zones along a path of the camera, in any mode.
class PathBalancer
{
public:
  PathBalancer(BalanceMode mode, const LoadBalancer::Options& options);

  const LoadBalancer::Options& GetOptions() const { return this->Measured.GetOptions(); }
  const ZoneTree& Tree() const { return this->Zones; }
  double BytesMoved() const { return this->Moved; }

  /// As LoadBalancer's.
  void BeginFrame(const BrickCosts& view, const ScreenCuts* cuts);
  void FrameTook(const std::vector<RankWork>& ranks, const BrickCosts& work);

private:
  BalanceMode Mode;
  LoadBalancer Measured;
  ZoneTree Zones;
  double Moved = 0.0;
  std::vector<double> Seconds; ///< of the last frame, by rank
  BrickCosts Bytes;            ///< that were drawn in it, by block
};

} // namespace banyan::bench

#endif
