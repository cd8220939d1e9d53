// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_PaperExperiment_h
#define banyan_Benchmarks_PaperExperiment_h

#include "PlaybackOptions.h"

namespace banyan::bench
{

/// Prints the study's experiment on a raw series as a table: a line for each step, kind of values
/// and transfer function, with the shares that PaperCounts counts.
/// Throws Error when a series cannot be read, or when the two are of different grids.
void RunPaperExperiment(const PlaybackOptions& options);

} // namespace banyan::bench

#endif
