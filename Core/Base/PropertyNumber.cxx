// SPDX-License-Identifier: BSD-3-Clause
#include "Base/PropertyNumber.h"

#include "Base/Error.h"

#include <cmath>
#include <sstream>

namespace banyan
{

std::string ProblemOfNumber(const std::string& property, double value, bool mayBeNegative)
{
  if (std::isfinite(value) && (mayBeNegative || value >= 0.0))
  {
    return {};
  }
  std::ostringstream text;
  text << property << " must be a finite number" << (mayBeNegative ? "" : " that is not negative")
       << ", and is " << value;
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
