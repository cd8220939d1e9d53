// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_IndexJson_h
#define banyan_Series_Format_IndexJson_h

#include "Series/Format/Json.h"
#include "Series/Format/SeriesIndex.h"

namespace banyan
{

Json IndexToJson(const SeriesIndex& index);

/// Checks that members are there and of the right type; what they say is `CheckIndex`'s business.
/// Throws Error.
SeriesIndex IndexFromJson(const Json& json);

} // namespace banyan

#endif
