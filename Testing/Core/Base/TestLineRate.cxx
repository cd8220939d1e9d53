// SPDX-License-Identifier: BSD-3-Clause
#include "Base/LineRate.h"

#include <gtest/gtest.h>

namespace
{

using namespace banyan;

/// Bursts of a line with some bytes a second, which are looked at every hundredth of a second.
void Send(LineRate& rate, double bytesPerSecond, int bursts)
{
  double now = 0.0;
  for (int burst = 1; burst <= bursts; ++burst)
  {
    const int bytes = rate.Credit(0.04);
    for (int sent = 0; sent < bytes; sent += 12000)
    {
      const double arrival = now + sent / bytesPerSecond;
      rate.Came(burst, 12000, std::ceil(100.0 * arrival) / 100.0);
    }
    now += 0.04 + bytes / bytesPerSecond;
  }
}

TEST(LineRate, FindsASlowLineAndAQuickOne)
{
  for (const double line : { 2.5e6, 12e6 })
  {
    LineRate rate;
    Send(rate, line, 20);
    EXPECT_GT(rate.BytesPerSecond(), 0.6 * line);
    EXPECT_LT(rate.BytesPerSecond(), 1.5 * line);
  }
}

TEST(LineRate, LeavesAPartOfTheLineAndAMessageAtLeast)
{
  LineRate rate;
  EXPECT_EQ(rate.Credit(0.1), 75000);
  EXPECT_EQ(rate.Credit(0.0), 12000);
}

TEST(LineRate, FewBytesSayNothing)
{
  LineRate rate;
  const double before = rate.BytesPerSecond();
  rate.Came(1, 28, 0.0);
  rate.Came(1, 28, 5.0);
  rate.Came(2, 28, 6.0);
  EXPECT_EQ(rate.BytesPerSecond(), before);
}

} // namespace
