// SPDX-License-Identifier: BSD-3-Clause
#include "Base/PropertyNumber.h"

#include "Base/Error.h"

#include <cmath>
#include <sstream>

namespace banyan
{

std::string CalledInMessages(const std::string& property)
{
  std::string label;
  for (const char letter : property)
  {
    const bool isCapital = letter >= 'A' && letter <= 'Z';
    label += isCapital && !label.empty() ? std::string{ ' ', letter } : std::string{ letter };
  }
  const bool isName = property.find(' ') == std::string::npos && label != property;
  return isName ? "'" + label + "' (" + property + ")" : property;
}

std::string ProblemOfNumber(const std::string& property, double value, bool mayBeNegative)
{
  if (std::isfinite(value) && (mayBeNegative || value >= 0.0))
  {
    return {};
  }
  std::ostringstream text;
  text << CalledInMessages(property) << " must be a finite number"
       << (mayBeNegative ? "" : " that is not negative") << ", and is " << value;
  return text.str();
}

void RequireNumber(const std::string& property, double value, bool mayBeNegative)
{
  const std::string problem = ProblemOfNumber(property, value, mayBeNegative);
  if (!problem.empty())
  {
    throw Error(problem);
  }
}

} // namespace banyan
