// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_Error_h
#define banyan_Base_Error_h

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

namespace banyan
{

/// Where something went wrong; every member is optional and shows up in the message when set.
struct ErrorPlace
{
  std::string File;                          ///< path of the file concerned
  std::optional<std::uint64_t> Offset = {};  ///< byte offset in that file
  std::optional<std::uint64_t> Found = {};   ///< the value that was met
  std::optional<std::uint64_t> Allowed = {}; ///< the limit, or the value that was expected
};

/// The one exception of Core. `what()` is a whole sentence for a user: what is wrong, where, and
/// (when known) what to do. Nothing in Core prints or aborts.
class Error : public std::runtime_error
{
public:
  explicit Error(const std::string& sentence, ErrorPlace place = {});

  const ErrorPlace& Place() const noexcept { return this->Where; }

private:
  ErrorPlace Where;
};

} // namespace banyan

#endif
