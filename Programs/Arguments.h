// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_Arguments_h
#define banyan_Programs_Arguments_h

#include <cstdint>
#include <string>
#include <vector>

namespace banyan
{

/// The arguments of a program, taken one by one.
class Arguments
{
public:
  explicit Arguments(std::vector<std::string> arguments);

  bool Empty() const { return this->Position == this->All.size(); }
  /// The next argument; there is one.
  std::string Next() { return this->All[this->Position++]; }
  /// Whether the next argument is one that does not start with "--".
  bool NextIsValue() const;

  /// The value behind an option. Throws Error when there is none.
  std::string Value(const std::string& option);
  /// A whole number within limits. Throws Error.
  std::int64_t Whole(const std::string& option, std::int64_t least, std::int64_t greatest);

private:
  std::vector<std::string> All;
  std::size_t Position = 0;
};

/// The number that a text is; no blanks, nothing behind it, finite. Throws Error with `what` in it.
double NumberFrom(const std::string& text, const std::string& what);

} // namespace banyan

#endif
