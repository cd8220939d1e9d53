// SPDX-License-Identifier: BSD-3-Clause
// Numbers of a mesh as float32 relative to a base.
#include "Base/ThreadPool.h"
#include "Mesh/Cells/CellArray.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace
{

using banyan::CellArray;
using banyan::NodeArray;
using banyan::ValuesOn;

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();

template <class T>
NodeArray ArrayOf(const std::vector<T>& values, int components = 1, int component = 0)
{
  return { values.data(), banyan::ScalarTypeOf<T>(), components, component };
}

template <class T>
CellArray Taken(const std::vector<T>& values, int components = 1, int component = 0)
{
  banyan::ThreadPool pool(3);
  return banyan::CellArrayOf(ArrayOf(values, components, component),
    static_cast<std::int64_t>(values.size()) / components, ValuesOn::Points, pool);
}

} // namespace

TEST(CellArray, TypesThatFloatHoldsStayAsTheyAre)
{
  const CellArray floats = Taken(std::vector<float>{ 1000000.5f, -0.0f, 1e38f, 3.0f });
  EXPECT_EQ(floats.Base, 0.0);
  EXPECT_EQ(floats.Values, (std::vector<float>{ 1000000.5f, -0.0f, 1e38f, 3.0f }));
  EXPECT_TRUE(std::signbit(floats.Values[1]));
  const CellArray bytes = Taken(std::vector<std::uint8_t>{ 255, 7 });
  EXPECT_EQ(bytes.Base, 0.0);
  EXPECT_EQ(bytes.Values, (std::vector<float>{ 255.0f, 7.0f }));
  const CellArray shorts = Taken(std::vector<std::int16_t>{ -32768, 32767 });
  EXPECT_EQ(shorts.Base, 0.0);
  EXPECT_EQ(shorts.Values, (std::vector<float>{ -32768.0f, 32767.0f }));
}

TEST(CellArray, OthersAreRelativeToTheLowestOne)
{
  const CellArray doubles = Taken(std::vector<double>{ 1e9 + 0.375, 1e9 + 0.125, 1e9 + 0.25 });
  EXPECT_EQ(doubles.Base, 1e9 + 0.125);
  EXPECT_EQ(doubles.Values, (std::vector<float>{ 0.25f, 0.0f, 0.125f }));
  const CellArray ints = Taken(std::vector<std::int32_t>{ -2147483647, 16777217 - 2147483647 });
  EXPECT_EQ(ints.Base, -2147483647.0);
  EXPECT_EQ(ints.Values, (std::vector<float>{ 0.0f, 16777216.0f })) << "rounded as differences are";
  const CellArray longs =
    Taken(std::vector<std::uint64_t>{ (1ull << 52) + 3, 1ull << 52, (1ull << 52) + 1 });
  EXPECT_EQ(longs.Base, std::ldexp(1.0, 52));
  EXPECT_EQ(longs.Values, (std::vector<float>{ 3.0f, 0.0f, 1.0f }));
}

TEST(CellArray, WhatIsNotFiniteIsNoBase)
{
  const CellArray doubles =
    Taken(std::vector<double>{ NotANumber, -Infinity, 5.0, Infinity, 1e300, 7.0 });
  EXPECT_EQ(doubles.Base, 5.0);
  EXPECT_TRUE(std::isnan(doubles.Values[0]));
  EXPECT_TRUE(std::isnan(doubles.Values[1]));
  EXPECT_EQ(doubles.Values[2], 0.0f);
  EXPECT_TRUE(std::isnan(doubles.Values[3]));
  EXPECT_EQ(doubles.Values[4], 1e30f);
  EXPECT_EQ(doubles.Values[5], 2.0f);
  const CellArray none = Taken(std::vector<double>{ NotANumber, Infinity });
  EXPECT_EQ(none.Base, 0.0);
  EXPECT_TRUE(std::isnan(none.Values[0]));
  const CellArray floats = Taken(std::vector<float>{ std::nanf(""), -HUGE_VALF });
  EXPECT_TRUE(std::isnan(floats.Values[0]));
  EXPECT_EQ(floats.Values[1], -HUGE_VALF);
}

TEST(CellArray, ComponentsAndLengths)
{
  const std::vector<float> vectors{ 3.0f, 4.0f, 0.0f, 0.0f, -5.0f, 12.0f };
  EXPECT_EQ(Taken(vectors, 3, 1).Values, (std::vector<float>{ 4.0f, -5.0f }));
  EXPECT_EQ(Taken(vectors, 3, NodeArray::Magnitude).Values, (std::vector<float>{ 5.0f, 13.0f }));
  const std::vector<double> doubles{ 3.0, 4.0, 6.0, 8.0 };
  const CellArray lengths = Taken(doubles, 2, NodeArray::Magnitude);
  EXPECT_EQ(lengths.Base, 5.0);
  EXPECT_EQ(lengths.Values, (std::vector<float>{ 0.0f, 5.0f }));
  const std::vector<float> longest{ 3e38f, 3e38f, 3e38f, HUGE_VALF };
  const CellArray cut = Taken(longest, 2, NodeArray::Magnitude);
  EXPECT_EQ(cut.Values[0], std::numeric_limits<float>::max());
  EXPECT_EQ(cut.Values[1], HUGE_VALF);
  EXPECT_THROW(Taken(vectors, 3, 3), banyan::Error);
}

TEST(CellArray, AnotherBaseMayBeGiven)
{
  banyan::ThreadPool pool(1);
  const std::vector<double> values{ 8.0, 10.0 };
  const CellArray taken = banyan::CellArrayOf(ArrayOf(values), 2, ValuesOn::Cells, pool, 2.0);
  EXPECT_EQ(taken.Base, 2.0);
  EXPECT_EQ(taken.Where, ValuesOn::Cells);
  EXPECT_EQ(taken.Values, (std::vector<float>{ 6.0f, 8.0f }));
  // Of no use to types that float32 holds.
  const std::vector<float> floats{ 8.0f };
  const CellArray same = banyan::CellArrayOf(ArrayOf(floats), 1, ValuesOn::Cells, pool, 2.0);
  EXPECT_EQ(same.Base, 0.0);
  EXPECT_EQ(same.Values[0], 8.0f);
}

TEST(CellArray, ThreadsGiveTheSame)
{
  std::vector<double> values(200001);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    values[i] = 1e7 + std::sin(static_cast<double>(i) * 0.1);
  }
  values[150000] = 1e7 - 3.0;
  const auto count = static_cast<std::int64_t>(values.size());
  banyan::ThreadPool one(1);
  banyan::ThreadPool many(4);
  const CellArray a = banyan::CellArrayOf(ArrayOf(values), count, ValuesOn::Points, one);
  const CellArray b = banyan::CellArrayOf(ArrayOf(values), count, ValuesOn::Points, many);
  EXPECT_EQ(a.Base, 1e7 - 3.0);
  EXPECT_EQ(b.Base, a.Base);
  EXPECT_EQ(a.Values, b.Values);
  for (std::size_t i = 0; i < values.size(); i += 997)
  {
    EXPECT_EQ(a.Values[i], static_cast<float>(values[i] - a.Base)) << i;
  }
  EXPECT_EQ(a.Values.back(), static_cast<float>(values.back() - a.Base));
}

TEST(CellArray, NoValuesOfNothing)
{
  banyan::ThreadPool pool(1);
  const CellArray none = banyan::CellArrayOf({}, 0, ValuesOn::Points, pool);
  EXPECT_TRUE(none.Values.empty());
  EXPECT_EQ(banyan::LowestOf({}, 0, pool), Infinity);
  EXPECT_THROW(banyan::CellArrayOf({}, 1, ValuesOn::Points, pool), banyan::Error);
}
