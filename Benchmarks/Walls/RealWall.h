// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_RealWall_h
#define banyan_Benchmarks_RealWall_h

#include "BenchScene.h"
#include "Wall.h"

#include <string>

namespace banyan::bench
{

/// Collective, on the ranks of mpirun: draws a wall with recorded zones, and then with recorded
/// regions. The first rank prints for each `division,bytes_pixels,largest_difference`: bytes of
/// compositing, and the largest difference to the picture of one rank, in 1/255.
/// @param folder that banyan-bench-walls has recorded in
/// Throws Error where there is no MPI, or when the ranks are others than were recorded.
void DrawRealWall(const BenchScene& scene, const WallColumn& column, const std::string& view,
  const std::string& folder);

} // namespace banyan::bench

#endif
