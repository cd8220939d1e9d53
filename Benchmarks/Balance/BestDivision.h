// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_BestDivision_h
#define banyan_Benchmarks_BestDivision_h

#include "BalanceOptions.h"
#include "BenchScene.h"

#include <cstdio>

namespace banyan::bench
{

/// Every tenth frame of the path (each view of `jumps` once), divided among ranks as well as planes
/// can: with the work of each zone counted by drawing it, as often as it takes, which no balancer
/// has the time for. What balancing is measured against: where this is poor, planes cannot do
/// better.
void WriteBestDivisions(const BenchScene& scene, const BalanceOptions& options, std::FILE* file);

} // namespace banyan::bench

#endif
