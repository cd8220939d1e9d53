// SPDX-License-Identifier: BSD-3-Clause
// Tables that pictures share: are they those that would be made anew?
#include "Render/Scene/FunctionTables.h"

#include "Base/Error.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>

using namespace banyan;

namespace
{

TransferFunction Ramp(int entries = 64)
{
  TransferFunction function;
  for (int i = 0; i < entries; ++i)
  {
    const float x = static_cast<float>(i) / static_cast<float>(entries - 1);
    function.Entries.emplace_back(x, 1.0f - x, 0.5f, i < entries / 4 ? 0.0f : 0.7f * x);
  }
  return function;
}

void ExpectSame(const StepTable& a, const StepTable& b, std::size_t entries)
{
  const std::size_t bytes = (entries + 1) * sizeof(glm::vec4);
  EXPECT_EQ(std::memcmp(a.Steps(), b.Steps(), bytes), 0);
  EXPECT_EQ(std::memcmp(a.Depths(), b.Depths(), bytes), 0);
  EXPECT_EQ(a.Low(), b.Low());
  EXPECT_EQ(a.Lookup().Scale, b.Lookup().Scale);
  EXPECT_EQ(a.Lookup().Bias, b.Lookup().Bias);
}

TEST(FunctionTables, AreMadeOnceForEachDistance)
{
  FunctionTables tables;
  const TransferFunction function = Ramp();
  const auto first = tables.StepsOf(function, 0.5);
  const auto second = tables.StepsOf(function, 2.0);
  ExpectSame(*first, StepTable(function, 0.5), function.Entries.size());
  ExpectSame(*second, StepTable(function, 2.0), function.Entries.size());
  EXPECT_EQ(tables.StepsOf(TransferFunction(function), 0.5), first);
  EXPECT_EQ(tables.StepsOf(function, 2.0), second);
  EXPECT_EQ(tables.VisibleOf(function), tables.VisibleOf(TransferFunction(function)));
  EXPECT_EQ(tables.VisibleOf(function)->Number(), VisibleValues(function).Number());
}

TEST(FunctionTables, AreOthersWhenAnythingChanges)
{
  FunctionTables tables;
  const TransferFunction function = Ramp();
  tables.StepsOf(function, 1.0);
  const auto expectOther = [&](const TransferFunction& other)
  {
    ExpectSame(*tables.StepsOf(other, 1.0), StepTable(other, 1.0), other.Entries.size());
    EXPECT_EQ(tables.VisibleOf(other)->Number(), VisibleValues(other).Number());
  };
  TransferFunction changed = function;
  changed.Entries.back().a = 0.25f;
  expectOther(changed);
  changed = function;
  changed.Entries.pop_back();
  expectOther(changed);
  changed = function;
  changed.Low = -1.0;
  expectOther(changed);
  changed = function;
  changed.UnitDistance = 3.0;
  expectOther(changed);
}

TEST(FunctionTables, RefuseWhatTablesRefuse)
{
  FunctionTables tables;
  TransferFunction function = Ramp();
  for (const double distance : { 0.0, -1.0, std::nan(""), HUGE_VAL })
  {
    EXPECT_THROW(tables.StepsOf(function, distance), Error);
    EXPECT_THROW(tables.StepsOf(function, distance), Error);
  }
  function.Entries[3].a = std::nanf("");
  EXPECT_THROW(tables.StepsOf(function, 1.0), Error);
  EXPECT_THROW(tables.StepsOf(function, 1.0), Error);
  EXPECT_THROW(tables.VisibleOf(function), Error);
}

TEST(FunctionTables, LetGoOfTheLeastRecentlyUsed)
{
  FunctionTables tables;
  const TransferFunction function = Ramp();
  const std::weak_ptr<const StepTable> oldest = tables.StepsOf(function, 1000.0);
  const auto used = tables.StepsOf(function, 2000.0);
  for (std::size_t i = 0; i < FunctionTables::MostTables; ++i)
  {
    EXPECT_EQ(tables.StepsOf(function, 2000.0), used);
    tables.StepsOf(function, 1.0 + static_cast<double>(i));
  }
  EXPECT_TRUE(oldest.expired());

  const std::weak_ptr<const VisibleValues> visible = tables.VisibleOf(function);
  for (std::size_t i = 0; i < FunctionTables::MostFunctions; ++i)
  {
    EXPECT_FALSE(visible.expired());
    tables.VisibleOf(Ramp(8 + static_cast<int>(i)));
  }
  EXPECT_TRUE(visible.expired());
}

} // namespace
