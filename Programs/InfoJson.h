// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_InfoJson_h
#define banyan_Programs_InfoJson_h

#include "DecodeTimes.h"
#include "StepTable.h"

#include <string>

namespace banyan
{

/// The report as a JSON object; Documentation/howto/how-good.md explains its members. Numbers that
/// do not exist are null.
/// @param times nullptr when they were not measured
std::string InfoToJson(const SeriesReport& report, const DecodeTimes* times);

} // namespace banyan

#endif
