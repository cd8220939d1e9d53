// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_VerifyOptions_h
#define banyan_Programs_VerifyOptions_h

#include "Base/ScalarType.h"
#include "Series/Quantize/OpacityWeight.h"

#include <glm/vec3.hpp>

#include <optional>
#include <string>
#include <vector>

namespace banyan
{

/// Holds what banyan-verify is asked to do. `VerifyHelp()` explains each one.
struct VerifyOptions
{
  std::string File;
  std::vector<std::string> Against; ///< files of the source
  bool Stream = false;              ///< the source comes through standard input
  std::vector<std::string> Arrays;
  std::optional<ScalarType> RawType;
  std::optional<glm::ivec3> Dims;
  std::optional<OpacityFunction> Opacity;
  bool Json = false;
  bool Help = false;
};

/// @param arguments without the program's name
/// Throws Error, with a sentence that names the argument, when one is unknown, out of range, or
/// does not go with another.
VerifyOptions ParseVerifyOptions(const std::vector<std::string>& arguments);

/// "v:o,v:o,...": values and their opacities. Throws Error.
OpacityFunction OpacityFrom(const std::string& text);

std::string VerifyHelp();

} // namespace banyan

#endif
