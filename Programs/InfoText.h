// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_InfoText_h
#define banyan_Programs_InfoText_h

#include "DecodeTimes.h"
#include "StepTable.h"

#include <string>

namespace banyan
{

/// The report for people.
/// @param times nullptr when they were not measured
std::string InfoToText(const SeriesReport& series, const DecodeTimes* times);

} // namespace banyan

#endif
