// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_MeshPlanTexts_h
#define banyan_Inputs_MeshPlanTexts_h

#include "Series/Encode/SeriesEncoder.h"

#include <memory>
#include <string>
#include <vector>

namespace banyan
{

/// What encoding must know of a mesh as texts, to be sent to other ranks.
std::vector<std::string> TextsOf(const MeshPlan& plan);

/// The inverse of TextsOf.
std::shared_ptr<const MeshPlan> PlanFrom(const std::vector<std::string>& texts);

} // namespace banyan

#endif
