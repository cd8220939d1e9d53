// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_QuantizerJson_h
#define banyan_Series_Format_QuantizerJson_h

#include "Series/Format/Json.h"
#include "Series/Format/SeriesIndex.h"

namespace banyan
{

/// Adds the members of a component that say how its range was chosen, which values are fill values,
/// and which opacity function it was encoded for, as Documentation/format.md has them. Members that
/// say nothing are left out.
void QuantizerToJson(const ComponentIndex& component, Json& json);

/// Inverse of `QuantizerToJson`. Throws Error for members that are not what they should be.
void QuantizerFromJson(const Json& json, ComponentIndex& component);

} // namespace banyan

#endif
