// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_BalanceFrames_h
#define banyan_Benchmarks_BalanceFrames_h

#include "BalanceOptions.h"
#include "BenchScene.h"

#include "Parallel/Balance/FrameCost.h"
#include "Parallel/Balance/LoadBalancer.h"

#include <cstdio>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace banyan::bench
{

/// What one frame took in one mode.
struct BalanceFrame
{
  int Number = 0;
  BalanceMode Mode = BalanceMode::Off;
  std::vector<double> RankMilliseconds; ///< of casting rays, loading included
  double Imbalance = 1.0;               ///< of these
  double Milliseconds = 0;              ///< of the slowest; with MPI, until the picture is complete
  double BytesMoved = 0;
};

using TakeFrame = std::function<void(const BalanceFrame&)>;

constexpr int BenchBrickCells = 16;

/// What counted work takes, in place of processor time: 3 ns a sample.
inline double CountedSeconds(double work)
{
  return 3e-9 * work;
}

/// Settings of the balancer for a volume in memory.
LoadBalancer::Options BalancerFor(
  const BenchScene& scene, const BalanceOptions& options, int ranks);

/// All frames of the path in one mode on simulated ranks.
void DrawSimulated(const BenchScene& scene, const BalanceOptions& options, BalanceMode mode,
  int ranks, const TakeFrame& take);

/// Collective: all modes on the ranks of this job; the first rank takes the frames. Throws Error
/// where there is no MPI.
void DrawOnMpiRanks(const std::function<BenchScene()>& makeScene, const BalanceOptions& options,
  const TakeFrame& take);

/// What each brick took: position, samples, pixels, microseconds.
void WriteBrickTimes(const BenchScene& scene, const BalanceOptions& options, std::FILE* file);

} // namespace banyan::bench

#endif
