// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/JsonMembers.h"

#include "Base/Error.h"

#include <limits>

namespace banyan::json_members
{

const Json& Member(const Json& json, const char* name)
{
  const auto found = json.find(name);
  if (found == json.end())
  {
    throw Error(std::string("The member '") + name + "' is missing");
  }
  return *found;
}

void WrongType(const char* name)
{
  throw Error(std::string("The member '") + name + "' is not what it should be");
}

double Real(const Json& json, const char* name)
{
  if (!json.is_number())
  {
    WrongType(name);
  }
  return json.get<double>();
}

std::int64_t Integer(const Json& json, const char* name, std::int64_t least, std::int64_t greatest)
{
  const bool fits = json.is_number_integer() &&
                    (!json.is_number_unsigned() ||
                      json.get<std::uint64_t>() <=
                        static_cast<std::uint64_t>(std::numeric_limits<std::int64_t>::max()));
  if (!fits || json.get<std::int64_t>() < least || json.get<std::int64_t>() > greatest)
  {
    WrongType(name);
  }
  return json.get<std::int64_t>();
}

int IntegerMember(const Json& json, const char* name, int least)
{
  return static_cast<int>(
    Integer(Member(json, name), name, least, std::numeric_limits<int>::max()));
}

std::int64_t CountMember(const Json& json, const char* name)
{
  return Integer(Member(json, name), name, 0, std::numeric_limits<std::int64_t>::max());
}

std::string TextMember(const Json& json, const char* name)
{
  const Json& member = Member(json, name);
  if (!member.is_string())
  {
    WrongType(name);
  }
  return member.get<std::string>();
}

const Json& ListMember(const Json& json, const char* name)
{
  const Json& member = Member(json, name);
  if (!member.is_array())
  {
    WrongType(name);
  }
  return member;
}

std::vector<double> Reals(const Json& json, const char* name, std::size_t count)
{
  const Json& list = ListMember(json, name);
  if (list.size() != count)
  {
    WrongType(name);
  }
  std::vector<double> values;
  for (const Json& item : list)
  {
    values.push_back(Real(item, name));
  }
  return values;
}

} // namespace banyan::json_members
