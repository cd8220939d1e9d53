// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_JsonMembers_h
#define banyan_Series_Format_JsonMembers_h

#include "Series/Format/Json.h"

#include <cstdint>
#include <string>
#include <vector>

/// Members of JSON objects, each with its type checked, because nlohmann::json converts numbers
/// silently. All throw Error that names the member when it is missing or of another type.
namespace banyan::json_members
{

const Json& Member(const Json& json, const char* name);

/// @param name of the member that the value belongs to, for the message
[[noreturn]] void WrongType(const char* name);
double Real(const Json& json, const char* name);
std::int64_t Integer(const Json& json, const char* name, std::int64_t least, std::int64_t greatest);

int IntegerMember(const Json& json, const char* name, int least);
/// Not negative.
std::int64_t CountMember(const Json& json, const char* name);
std::string TextMember(const Json& json, const char* name);
const Json& ListMember(const Json& json, const char* name);
/// A list of `count` numbers.
std::vector<double> Reals(const Json& json, const char* name, std::size_t count);

} // namespace banyan::json_members

#endif
