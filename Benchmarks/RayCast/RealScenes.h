// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_RealScenes_h
#define banyan_Benchmarks_RealScenes_h

#include "BenchScene.h"

namespace banyan::bench
{

/// The scene of a raw series (see RawSeries::Open) whose name is in the table of the .cxx: its last
/// step, with a camera and a transfer function chosen for it. Throws Error when the file is damaged
/// or nothing is known about the name.
BenchScene RealScene(const std::string& description, int picture);

} // namespace banyan::bench

#endif
