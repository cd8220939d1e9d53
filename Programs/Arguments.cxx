// SPDX-License-Identifier: BSD-3-Clause
#include "Arguments.h"

#include "Base/Error.h"

#include <charconv>
#include <cmath>
#include <utility>

namespace banyan
{
namespace
{

template <class Number>
bool Parse(const std::string& text, Number& value)
{
  const char* end = text.data() + text.size();
  const auto result = std::from_chars(text.data(), end, value);
  return result.ec == std::errc() && result.ptr == end;
}

} // namespace

Arguments::Arguments(std::vector<std::string> arguments)
  : All(std::move(arguments))
{
}

bool Arguments::NextIsValue() const
{
  return !this->Empty() && this->All[this->Position].rfind("--", 0) != 0;
}

std::string Arguments::Value(const std::string& option)
{
  if (!this->NextIsValue())
  {
    throw Error("Option " + option + " needs a value.");
  }
  return this->Next();
}

std::int64_t Arguments::Whole(const std::string& option, std::int64_t least, std::int64_t greatest)
{
  const std::string text = this->Value(option);
  std::int64_t value = 0;
  if (!Parse(text, value) || value < least || value > greatest)
  {
    throw Error("Option " + option + " needs a whole number from " + std::to_string(least) +
                " to " + std::to_string(greatest) + ", not \"" + text + "\".");
  }
  return value;
}

double NumberFrom(const std::string& text, const std::string& what)
{
  double value = 0.0;
  if (!Parse(text, value) || !std::isfinite(value))
  {
    throw Error(what + " needs a number, not \"" + text + "\".");
  }
  return value;
}

} // namespace banyan
