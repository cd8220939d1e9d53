// SPDX-License-Identifier: BSD-3-Clause
#include "Base/LineRate.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace
{

using namespace banyan;

constexpr int Message = 12000; ///< bytes

/// A line with some bytes a second, and a window that looks at it every 10 ms, and every 60 ms
/// where it draws between. The next burst is asked for when the last one has come.
void Send(LineRate& rate, double bytesPerSecond, int bursts)
{
  double now = 0.0;
  double empty = 0.0;
  for (int burst = 1; burst <= bursts; ++burst)
  {
    std::vector<double> arrivals;
    for (int sent = Message; sent < rate.Credit(0.04) + Message; sent += Message)
    {
      arrivals.push_back(now + sent / bytesPerSecond);
    }
    std::size_t read = 0;
    for (int look = 0; read < arrivals.size(); ++look)
    {
      now += look % 3 == 2 ? 0.06 : 0.01;
      for (; read < arrivals.size() && arrivals[read] <= now; ++read)
      {
        rate.Came({ burst, Message, empty, now, true });
      }
      empty = now;
    }
  }
}

TEST(LineRate, FindsASlowLineAndAQuickOne)
{
  for (const double line : { 0.5e6, 2.5e6, 12e6 })
  {
    // While the window draws, a quick line sends whole bursts: then nobody sees how quick it is.
    const double most = line > 10e6 ? 3.5 : 2.0;
    LineRate rate;
    for (int bursts = 20; bursts < 30; ++bursts)
    {
      Send(rate, line, bursts);
      EXPECT_GT(rate.BytesPerSecond(), 0.4 * line) << line;
      EXPECT_LT(rate.BytesPerSecond(), most * line) << line;
    }
  }
}

TEST(LineRate, FindsThatALineHasNoLimitInFewBursts)
{
  LineRate rate;
  Send(rate, 1e9, 8);
  EXPECT_GT(rate.BytesPerSecond(), 50e6);
}

TEST(LineRate, BurstsThatHadEnoughCreditDoNotRaiseIt)
{
  LineRate rate;
  for (int burst = 1; burst < 10; ++burst)
  {
    for (int message = 0; message < 4; ++message)
    {
      rate.Came({ burst, Message, 1.0 * burst, burst + 0.06, false });
    }
  }
  EXPECT_EQ(rate.BytesPerSecond(), 1e6);
}

TEST(LineRate, WhatHasComeIsALowerLimit)
{
  LineRate rate;
  rate.Came({ 1, Message, 0.0, 0.02, false });
  rate.Came({ 1, 20 * Message, 0.0, 0.02, false });
  EXPECT_DOUBLE_EQ(rate.BytesPerSecond(), 20 * Message / 0.02);
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
  rate.Came({ 1, 28, 0.0, 0.0 });
  rate.Came({ 1, 28, 5.0, 5.0 });
  rate.Came({ 2, 28, 6.0, 6.0 });
  EXPECT_EQ(rate.BytesPerSecond(), before);
}

} // namespace
