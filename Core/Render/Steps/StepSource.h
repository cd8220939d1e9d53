// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Steps_StepSource_h
#define banyan_Render_Steps_StepSource_h

#include "Render/Bricks/BrickSource.h"
#include "Render/Steps/TemporalEnhancement.h"
#include "Series/Decode/SeriesFile.h"

#include <memory>

namespace banyan
{

/// Bricks of a step of an encoded series, enhanced with the steps around it unless Strength is 0.
/// The noise floor is the series' error bound.
/// @param component in [0, components), or -1 for the length
std::unique_ptr<BrickSource> MakeSeriesSource(const std::shared_ptr<const SeriesFile>& series,
  const FieldKey& field, int component, const TemporalEnhancement& how);

/// Bricks between a step and the next one.
/// @param fraction see StepAndFraction; 0 gives the step itself
/// Throws Error for values that are not interpolated.
std::unique_ptr<BrickSource> MakeSourceBetween(const std::shared_ptr<const SeriesFile>& series,
  const FieldKey& field, int component, double fraction);

} // namespace banyan

#endif
