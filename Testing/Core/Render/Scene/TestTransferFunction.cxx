// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Render/Scene/TransferFunction.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

namespace
{

using namespace banyan;

constexpr float Infinity = std::numeric_limits<float>::infinity();
constexpr float NotANumber = std::numeric_limits<float>::quiet_NaN();

/// Entry i has red i; opacity as given.
TransferFunction Ramp(double low, double high, int entries, float opacity = 0.5f)
{
  TransferFunction function;
  function.Low = low;
  function.High = high;
  for (int i = 0; i < entries; ++i)
  {
    function.Entries.emplace_back(static_cast<float>(i), 0.0f, 1.0f, opacity);
  }
  return function;
}

TEST(StepTable, NearestEntryAndEnds)
{
  const StepTable table(Ramp(10.0, 14.0, 5), 1.0);
  EXPECT_EQ(table.Lookup().IndexOf(10.0f), 0);
  EXPECT_EQ(table.Lookup().IndexOf(10.49f), 0);
  EXPECT_EQ(table.Lookup().IndexOf(10.51f), 1);
  EXPECT_EQ(table.Lookup().IndexOf(14.0f), 4);
  EXPECT_EQ(table.Lookup().IndexOf(13.49f), 3);
  EXPECT_EQ(table.Lookup().IndexOf(-1e30f), 0);
  EXPECT_EQ(table.Lookup().IndexOf(1e30f), 4);
  EXPECT_EQ(table.Lookup().IndexOf(std::numeric_limits<float>::max()), 4);
  EXPECT_EQ(table.Lookup().IndexOf(std::numeric_limits<float>::lowest()), 0);
}

TEST(StepTable, WhatIsNotFiniteIsTransparent)
{
  const StepTable table(Ramp(0.0, 1.0, 4, 1.0f), 1.0);
  for (const float value : { NotANumber, Infinity, -Infinity })
  {
    EXPECT_EQ(table.At(value), glm::vec4(0.0f));
    EXPECT_EQ(
      table.Steps()[table.RelativeLookup().IndexOf(value)], glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
  }
}

TEST(StepTable, OpacityFollowsTheDistance)
{
  TransferFunction function = Ramp(0.0, 1.0, 2, 0.3f);
  function.UnitDistance = 2.0;
  const StepTable table(function, 0.5);
  const double expected = 1.0 - std::pow(1.0 - 0.3f, 0.25);
  EXPECT_NEAR(table.At(1.0f).a, expected, 1e-8);
  EXPECT_NEAR(table.At(1.0f).r, expected, 1e-8); // premultiplied
  function.Entries[1].a = 1.0f;
  EXPECT_EQ(StepTable(function, 1e-6).At(1.0f).a, 1.0f);
  function.Entries[1].a = 1e-7f;
  EXPECT_NEAR(StepTable(function, 2e-5).At(1.0f).a, 1e-12, 1e-18); // no digits lost
}

TEST(StepTable, SmallRangeAtALargeOffset)
{
  const int entries = 4096;
  const StepTable table(Ramp(1e6, 1e6 + 0.1, entries), 1.0);
  EXPECT_EQ(table.Low(), 1e6);
  for (int i = 0; i < entries; ++i)
  {
    const double value = 1e6 + 0.1 * i / (entries - 1);
    EXPECT_EQ(table.RelativeLookup().IndexOf(static_cast<float>(value - table.Low())), i);
  }
}

TEST(StepTable, LowThatFloatCannotHold)
{
  // float(0.1) is 1.5e-9 above 0.1: 15 entries of a table over 4e-7.
  const StepTable table(Ramp(0.1, 0.1 + 4e-7, 4096), 1.0);
  const float value = std::nextafter(0.1f, 1.0f);
  const double position = (double{ value } - 0.1) / 4e-7 * 4095.0;
  EXPECT_NEAR(table.Lookup().IndexOf(value), position, 1.0);
}

TEST(StepTable, DegenerateRangeIsAStep)
{
  const StepTable table(Ramp(3.0, 3.0, 8), 1.0);
  EXPECT_EQ(table.Lookup().IndexOf(2.9f), 0);
  EXPECT_EQ(table.Lookup().IndexOf(3.0f), 0);
  EXPECT_EQ(table.Lookup().IndexOf(3.1f), 7);
}

TEST(TransferFunction, RefusesWhatCannotBeUsed)
{
  const auto refused = [](const TransferFunction& function, double distance = 1.0)
  { EXPECT_THROW(StepTable(function, distance), Error); };
  refused(Ramp(0, 1, 1));
  refused(Ramp(0, NAN, 4));
  refused(Ramp(-INFINITY, 1, 4));
  refused(Ramp(0, 1, 4, 1.01f));
  refused(Ramp(0, 1, 4, -0.01f));
  refused(Ramp(0, 1, 4, NotANumber));
  refused(Ramp(0, 1, 4), 0.0);
  refused(Ramp(0, 1, 4), NAN);
  TransferFunction function = Ramp(0, 1, 4);
  function.UnitDistance = 0.0;
  refused(function);
}

TEST(VisibleValues, FindsSinglesAndNothing)
{
  TransferFunction function = Ramp(0.0, 100.0, 101, 0.0f);
  EXPECT_FALSE(function.AnyVisible(-1e9, 1e9));
  function.Entries[40].a = 1e-6f;
  EXPECT_TRUE(function.AnyVisible(40.0, 40.0));
  EXPECT_TRUE(function.AnyVisible(-1e9, 1e9));
  EXPECT_FALSE(function.AnyVisible(43.0, 1e9));
  EXPECT_FALSE(function.AnyVisible(-1e9, 37.0));
  EXPECT_FALSE(function.AnyVisible(41.0, 40.0)); // empty interval
  function = Ramp(0.0, 100.0, 101, 0.0f);
  function.Entries[100].a = 1.0f;
  EXPECT_TRUE(function.AnyVisible(5000.0, 6000.0)); // beyond the end: the last entry
  EXPECT_FALSE(function.AnyVisible(-5000.0, -4000.0));
}

/// Whatever the table shows must be announced, at any range and size of table.
TEST(VisibleValues, NeverMissesAVisibleValue)
{
  std::mt19937 random(11);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  for (int round = 0; round < 60; ++round)
  {
    const double low = (unit(random) - 0.5) * std::pow(10.0, round % 7);
    const double width = std::pow(10.0, round % 5 - 2);
    TransferFunction function = Ramp(low, low + width, 2 + round * 37, 0.0f);
    for (glm::vec4& entry : function.Entries)
    {
      entry.a = unit(random) < 0.1 ? 0.5f : 0.0f;
    }
    const StepTable table(function, 1.0);
    const VisibleValues visible(function);
    const MaskRange masks{ low - 0.3 * width, low + 0.9 * width };
    const ValueMask bins = function.VisibleBins(masks);
    for (int i = 0; i < 300; ++i)
    {
      const auto value = static_cast<float>(low + (unit(random) * 1.6 - 0.3) * width);
      if (table.At(value).a > 0.0f)
      {
        EXPECT_TRUE(visible.Any(value, value));
        EXPECT_TRUE(bins >> masks.BinOf(value) & 1) << value;
      }
    }
  }
}

TEST(TransferFunction, VisibleBinsAreFew)
{
  TransferFunction function = Ramp(0.0, 64.0, 6401, 0.0f);
  function.Entries[1050].a = 1.0f; // 10.5
  EXPECT_EQ(function.VisibleBins({ 0.0, 64.0 }), MaskOfBins(10, 10));
  EXPECT_EQ(function.VisibleBins({ 20.0, 84.0 }), MaskOfBins(0, 0));    // below: the first bin
  EXPECT_EQ(function.VisibleBins({ -100.0, 0.0 }), MaskOfBins(63, 63)); // above: the last
  EXPECT_EQ(function.VisibleBins({ 5.0, 5.0 }), MaskOfBins(0, 0));
  function.Entries[1050].a = 0.0f;
  EXPECT_EQ(function.VisibleBins({ 5.0, 5.0 }), 0u);
}

} // namespace
