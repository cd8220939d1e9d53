// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Data_WaveSeries_h
#define banyan_Data_WaveSeries_h

#include "SeriesCatalog.h"

namespace banyan
{

/// An earthquake below a basin of soft sediments (`BasinModel` in an `ElasticWaveSimulation`). Next
/// to the source the ground moves hundreds of times faster than in the waves that follow. Times
/// are in seconds; steps lie at the time steps of the simulation that are nearest.
SeriesKind WaveSeries();

/// The same with its speed cut at the 99.99 percentile of the whole series, so that the waves fill
/// the range. The whole series is held in memory to find the percentile: 4 bytes a value.
SeriesKind ClippedWaveSeries();

/// The smallest of the values that are above the given share of them, all steps together.
/// @param share in [0, 1)
/// @param steps at least one value in all
float Percentile(const std::vector<std::vector<float>>& steps, double share);

} // namespace banyan

#endif
