// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_Json_h
#define banyan_Series_Format_Json_h

#include <nlohmann/json.hpp>

namespace banyan
{

/// Keeps members in the order they are written in, which is the order of Documentation/format.md.
using Json = nlohmann::ordered_json;

} // namespace banyan

#endif
