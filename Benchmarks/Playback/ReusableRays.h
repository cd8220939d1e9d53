// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_ReusableRays_h
#define banyan_Benchmarks_ReusableRays_h

#include "Base/Hash.h"
#include "Render/Levels/RayCaster.h"

#include <vector>

namespace banyan::bench
{

/// Counts what of a picture cannot have changed since the step before: packets of 4 x 4 rays under
/// no visible brick of the finest level that has other values now. The ray caster itself counts:
/// depths end the other rays where they begin.
class ReusableRays
{
public:
  struct Shares
  {
    double Bricks = 0.0;  ///< of the visible bricks, those that changed
    double Packets = 0.0; ///< of the packets with samples, those under no changed brick
    double Samples = 0.0; ///< of all samples, those of such packets
    double Pixels = 0.0;  ///< of the pixels that show something, those with equal bits
  };

  /// @param scene of one sample per voxel, without depths
  Shares Since(const RayScene& scene, BrickSource& source, std::uint64_t budget);

private:
  std::vector<Hash128> Before;
  FloatImage Picture;
};

} // namespace banyan::bench

#endif
