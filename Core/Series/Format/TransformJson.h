// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_TransformJson_h
#define banyan_Series_Format_TransformJson_h

#include "Series/Format/Json.h"
#include "Series/Quantize/Transform.h"

namespace banyan
{

/// The member `transform` of a component, as Documentation/format.md has it.
Json TransformToJson(const Transform& transform);

/// Inverse of `TransformToJson`: the same bits. Throws Error for anything that is no transform.
Transform TransformFromJson(const Json& json);

} // namespace banyan

#endif
