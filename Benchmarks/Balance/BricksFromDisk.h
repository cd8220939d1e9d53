// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_BricksFromDisk_h
#define banyan_Benchmarks_BricksFromDisk_h

#include "BenchScene.h"

#include <string>

namespace banyan::bench
{

/// Encodes the volume as a series of one step, with the default error bound, unless it is there.
/// What it wrote is on the disk, and not in the system's cache alone.
void EncodeForDisk(const BenchScene& scene, const std::string& series);

/// What it takes one thread to read and decode bricks of the series, first with nothing of its
/// files in the system's cache, then with all. Prints a line for each.
void ReadBricks(const std::string& series);

} // namespace banyan::bench

#endif
