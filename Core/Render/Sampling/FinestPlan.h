// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_FinestPlan_h
#define banyan_Render_Sampling_FinestPlan_h

#include "Render/Sampling/SamplingPlan.h"

namespace banyan
{

/// A plan that is as fine as both in each tile: the finer level, the smaller distance and the
/// smaller stride. For pictures between two that were planned with the same wish. Its error is the
/// larger one; no probe was drawn for it.
/// @param imageSize pixels of the whole picture
SamplingPlan FinestPlan(const glm::ivec2& imageSize, const SamplingPlan& a, const SamplingPlan& b);

} // namespace banyan

#endif
