// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/PropertyNumber.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace banyan::testing
{
namespace
{

TEST(PropertyNumber, NamesPropertyAndValue)
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(ProblemOfNumber("Width", 0.0), "");
  EXPECT_EQ(ProblemOfNumber("Width", 1e300), "");
  EXPECT_EQ(ProblemOfNumber("Width", -1.5, true), "");
  EXPECT_EQ(ProblemOfNumber("Width", -1.5),
    "Width must be a finite number that is not negative, and is -1.5");
  EXPECT_EQ(ProblemOfNumber("ErrorBound", -1.0),
    "'Error Bound' (ErrorBound) must be a finite number that is not negative, and is -1");
  EXPECT_EQ(ProblemOfNumber("A Part of it", std::nan(""), true),
    "A Part of it must be a finite number, and is nan");
  EXPECT_EQ(
    ProblemOfNumber("Place", std::nan(""), true), "Place must be a finite number, and is nan");
  for (const bool negative : { false, true })
  {
    EXPECT_NE(ProblemOfNumber("Width", infinity, negative).find("inf"), std::string::npos);
    EXPECT_THROW(RequireNumber("Width", -infinity, negative), Error);
    EXPECT_NO_THROW(RequireNumber("Width", 2, negative));
  }
}

} // namespace
} // namespace banyan::testing
