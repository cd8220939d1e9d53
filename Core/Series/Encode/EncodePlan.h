// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_EncodePlan_h
#define banyan_Series_Encode_EncodePlan_h

#include "Series/Encode/SeriesEncoder.h"

namespace banyan
{

/// Cells per axis of a brick when the user leaves the choice to us: 16, and 32 from 2^24 samples
/// on. Documentation/measurements/codec-size.md has the measurements.
int ChooseBrickCells(const glm::ivec3& samples);

/// The index of a series before its first step, with the absolute error bounds worked out. Throws
/// Error when an option is out of range or a range is missing.
SeriesIndex PlanSeries(
  const Grid& grid, const std::vector<ArrayDescription>& arrays, const EncodeOptions& options);

} // namespace banyan

#endif
