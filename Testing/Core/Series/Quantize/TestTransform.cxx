// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Bytes.h"
#include "Base/Error.h"
#include "Base/Hash.h"
#include "Series/Quantize/Transform.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

namespace banyan
{
namespace
{

using Limits = std::numeric_limits<double>;

std::uint64_t BitsOf(double value)
{
  return BitCast<std::uint64_t>(value);
}

double Ulp(double value)
{
  const double magnitude = std::abs(value);
  return std::nextafter(magnitude, INFINITY) - magnitude;
}

/// From [1/65536, 65536) with either sign, even in the logarithm.
double SomeNumber(std::mt19937_64& random)
{
  const double magnitude = std::exp2(std::uniform_real_distribution<>(-16, 16)(random));
  return random() % 2 == 0 ? magnitude : -magnitude;
}

/// Uneven steps of both directions; knots crowd around some values.
std::vector<TransformKnot> SomeKnots(std::mt19937_64& random, std::size_t count)
{
  std::vector<TransformKnot> knots = { { SomeNumber(random), SomeNumber(random) } };
  while (knots.size() < count)
  {
    const TransformKnot last = knots.back();
    knots.push_back(
      { last.X + std::abs(SomeNumber(random)), last.Y + std::abs(SomeNumber(random)) });
  }
  return knots;
}

std::vector<Transform> AllKinds()
{
  std::mt19937_64 random(11);
  std::vector<Transform> all = { Transform(), Transform::Asinh(1.0), Transform::Asinh(1e-38),
    Transform::Asinh(12345.678), Transform::Asinh(0x1p-1000), Transform::Asinh(0x1p1000),
    Transform::Table({ { -1.0, 0.0 }, { 0.0, 0.5 } }),
    Transform::Table({ { -5.0, -2.0 }, { 0.0, 0.0 }, { 1e-6, 1.0 }, { 9.0, 1.0 + 1e-6 } }) };
  for (const std::size_t count : { 2, 3, 17, 256, 4096 })
  {
    all.push_back(Transform::Table(SomeKnots(random, count)));
  }
  return all;
}

/// Sorted: numbers of many magnitudes, the knots and what lies next to them.
std::vector<double> Arguments(const Transform& transform, double TransformKnot::*column)
{
  std::mt19937_64 random(12);
  std::vector<double> arguments = { 0.0, -0.0, 1e-40, -1e-40, 1e-310, Limits::denorm_min() };
  for (int i = 0; i < 20000; ++i)
  {
    arguments.push_back(SomeNumber(random));
  }
  for (const TransformKnot& knot : transform.Knots())
  {
    for (const double end : { -Limits::infinity(), Limits::infinity() })
    {
      arguments.push_back(std::nextafter(knot.*column, end));
    }
    arguments.push_back(knot.*column);
  }
  std::sort(arguments.begin(), arguments.end());
  return arguments;
}

TEST(Transform, BothDirectionsIncrease)
{
  for (const Transform& transform : AllKinds())
  {
    // The arithmetic of asinh may be off by some units in the last place either way.
    const double slack = transform.Kind() == TransformKind::Asinh ? 8.0 : 0.0;
    const std::vector<double> x = Arguments(transform, &TransformKnot::X);
    const std::vector<double> y = Arguments(transform, &TransformKnot::Y);
    for (std::size_t i = 1; i < x.size(); ++i)
    {
      const double before = transform.Forward(x[i - 1]);
      ASSERT_LE(before, transform.Forward(x[i]) + slack * Ulp(before)) << x[i];
    }
    for (std::size_t i = 1; i < y.size(); ++i)
    {
      const double before = transform.Inverse(y[i - 1]);
      ASSERT_LE(before, transform.Inverse(y[i]) + slack * Ulp(before)) << y[i];
    }
  }
}

TEST(Transform, AsinhIncreasesStrictlyOnALattice)
{
  const Transform transform = Transform::Asinh(0.01);
  double before = transform.Inverse(-30.0);
  for (int k = 1; k <= 600000; ++k)
  {
    const double x = transform.Inverse(-30.0 + k * 1e-4);
    ASSERT_GT(x, before) << k;
    before = x;
  }
}

TEST(Transform, AsinhIsTheMathematicalFunction)
{
  std::mt19937_64 random(13);
  std::uniform_real_distribution<> exponent(-1000, 1000);
  for (int i = 0; i < 200000; ++i)
  {
    const double scale = i % 2 == 0 ? 1.0 : std::exp2(0.99 * exponent(random));
    const double x = i % 2 == 0 ? SomeNumber(random) : std::exp2(exponent(random));
    const Transform transform = Transform::Asinh(scale);
    const double y = transform.Forward(x);
    const long double exact = std::asinh(static_cast<long double>(x) / scale);
    ASSERT_LE(std::abs(y - static_cast<double>(exact)), 8 * Ulp(y)) << x << " / " << scale;
    const double back = transform.Inverse(y);
    const long double exactBack = scale * std::sinh(static_cast<long double>(y));
    ASSERT_LE(std::abs(back - static_cast<double>(exactBack)), 8 * Ulp(back)) << y;
  }
}

TEST(Transform, ThereAndBackIsRoundingOnly)
{
  for (const Transform& transform : AllKinds())
  {
    for (const double x : Arguments(transform, &TransformKnot::X))
    {
      // How far x moves when y moves by some units in the last place.
      const double y = transform.Forward(x);
      const double wide = 16 * Ulp(y);
      const double reach =
        std::max(transform.Inverse(y + wide) - x, x - transform.Inverse(y - wide));
      ASSERT_LE(std::abs(transform.Inverse(y) - x), reach + 4 * Ulp(x)) << x;
    }
  }
}

TEST(Transform, TablesGoThroughTheirKnotsAndOnBeyond)
{
  const Transform table =
    Transform::Table({ { -2.0, 1.0 }, { 0.0, 2.0 }, { 1.0, 10.0 }, { 4.0, 11.0 } });
  EXPECT_EQ(table.Forward(-2.0), 1.0);
  EXPECT_EQ(table.Forward(0.5), 6.0);
  EXPECT_EQ(table.Inverse(10.5), 2.5);
  EXPECT_EQ(table.Forward(-4.0), 0.0);
  EXPECT_EQ(table.Forward(7.0), 12.0);
  EXPECT_EQ(table.Inverse(0.0), -4.0);
  EXPECT_EQ(table.Inverse(12.0), 7.0);
  std::mt19937_64 random(14);
  const std::vector<TransformKnot> knots = SomeKnots(random, 999);
  const Transform other = Transform::Table(knots);
  for (const TransformKnot& knot : knots)
  {
    ASSERT_EQ(other.Forward(knot.X), knot.Y);
    ASSERT_EQ(other.Inverse(knot.Y), knot.X);
  }
}

/// The formula of the format, with the segment found by looking at every knot.
double Obvious(const std::vector<TransformKnot>& knots, double y)
{
  std::size_t j = 0;
  while (j + 1 < knots.size() && knots[j + 1].Y <= y)
  {
    ++j;
  }
  const std::size_t from = std::min(j, knots.size() - 2);
  const double slope = (knots[from + 1].X - knots[from].X) / (knots[from + 1].Y - knots[from].Y);
  const double x = knots[j].X + (y - knots[j].Y) * slope;
  return j + 1 < knots.size() ? std::min(x, knots[j + 1].X) : x;
}

TEST(Transform, TablesFindTheRightSegment)
{
  std::mt19937_64 random(15);
  for (const std::size_t count : { 2, 3, 5, 64, 300 })
  {
    std::vector<TransformKnot> knots = SomeKnots(random, count);
    if (count == 300)
    {
      // All but one knot in the first of the equal buckets.
      knots.push_back({ knots.back().X + 1.0, knots.back().Y + 1e12 });
    }
    const Transform table = Transform::Table(knots);
    for (const double y : Arguments(table, &TransformKnot::Y))
    {
      ASSERT_EQ(BitsOf(table.Inverse(y)), BitsOf(Obvious(knots, y))) << y;
    }
  }
}

/// Near the end of a segment rounding may carry a result past the next knot.
TEST(Transform, TablesDoNotOvershoot)
{
  int overshoots = 0;
  for (int i = 1; i < 200; ++i)
  {
    const double end = 1.0 + i / 64.0;
    const double knot = -1e-17; // where doubles lie much closer together than at -1
    const Transform table = Transform::Table({ { -1.0, 0.0 }, { knot, end }, { 5.0, end + 1.0 } });
    const double before = std::nextafter(end, 0.0);
    overshoots += -1.0 + before * (1.0 / end) > knot ? 1 : 0;
    EXPECT_LE(table.Inverse(before), knot);
  }
  EXPECT_GT(overshoots, 0) << "this test tests nothing";
}

TEST(Transform, ZeroStaysZeroAndSignsMirror)
{
  for (const Transform& transform : { Transform(), Transform::Asinh(3.0), Transform::Asinh(1e-300),
         Transform::Table({ { -1.0, -3.0 }, { 0.0, 0.0 }, { 5.0, 1.0 } }) })
  {
    EXPECT_EQ(transform.Forward(0.0), 0.0);
    EXPECT_EQ(transform.Inverse(0.0), 0.0);
  }
  const Transform asinh = Transform::Asinh(0.7);
  for (const double x : { 1e-300, 1e-40, 0.1, 0.7, 1.0, 3.0, 1e38, 1e300 })
  {
    EXPECT_EQ(asinh.Forward(-x), -asinh.Forward(x));
    EXPECT_EQ(asinh.Inverse(-asinh.Forward(x)), -asinh.Inverse(asinh.Forward(x)));
  }
}

TEST(Transform, ExtremesAreSafe)
{
  for (const Transform& transform : AllKinds())
  {
    EXPECT_TRUE(std::isnan(transform.Forward(NAN)));
    EXPECT_TRUE(std::isnan(transform.Inverse(NAN)));
    EXPECT_EQ(transform.Forward(INFINITY), INFINITY);
    EXPECT_EQ(transform.Forward(-INFINITY), -INFINITY);
    EXPECT_GE(transform.Inverse(INFINITY), Limits::max());
    EXPECT_LE(transform.Inverse(-INFINITY), -Limits::max());
  }
  for (const double scale : { 0x1p-1000, 1e-40, 1.0, 0x1p1000 })
  {
    const Transform asinh = Transform::Asinh(scale);
    const double y = asinh.Forward(Limits::max());
    EXPECT_LT(y, 1416.0);
    EXPECT_NEAR(asinh.Inverse(y) / Limits::max(), 1.0, 1e-12);
    EXPECT_EQ(asinh.Inverse(-1e300), asinh.Inverse(-INFINITY));
  }
  // Values of float32 that are denormal there keep their relative precision.
  const Transform tiny = Transform::Asinh(1e-41);
  EXPECT_NEAR(tiny.Inverse(tiny.Forward(1e-40)) / 1e-40, 1.0, 1e-14);
  const Transform flat = Transform::Asinh(1.0);
  EXPECT_EQ(flat.Inverse(flat.Forward(1e-300)), 1e-300);
}

TEST(Transform, WhatCannotBeATransformIsRejected)
{
  for (const double scale : { 0.0, -1.0, 0x1p-1001, 0x1p1001, double(NAN), double(INFINITY) })
  {
    EXPECT_THROW((void)Transform::Asinh(scale), Error) << scale;
  }
  const std::vector<std::vector<TransformKnot>> bad = { {}, { { 0, 0 } }, { { 0, 0 }, { 0, 1 } },
    { { 0, 0 }, { 1, 0 } }, { { 0, 0 }, { 1, -1 } }, { { 0, 0 }, { -1, 1 } },
    { { 0, 0 }, { NAN, 1 } }, { { 0, 0 }, { 1, INFINITY } }, { { -INFINITY, 0 }, { 1, 1 } },
    { { 0, 0 }, { 1e305, 1 } }, { { 0, 0 }, { 1e-305, 1e-305 } }, { { 0, 0 }, { 1e150, 1e-150 } },
    std::vector<TransformKnot>(4097) };
  for (std::size_t i = 0; i < bad.size(); ++i)
  {
    EXPECT_THROW((void)Transform::Table(bad[i]), Error) << i;
  }
  std::vector<TransformKnot> many;
  for (int i = 0; i < 4097; ++i)
  {
    many.push_back({ i * 1.0, i * 1.0 });
  }
  EXPECT_THROW((void)Transform::Table(many), Error);
  many.pop_back();
  EXPECT_EQ(Transform::Table(many).Knots().size(), 4096u);
}

TEST(Transform, ManyAtOnceAreTheSameBits)
{
  std::mt19937_64 random(16);
  for (const Transform& transform : AllKinds())
  {
    for (std::size_t count = 0; count < 70; ++count)
    {
      std::vector<double> x;
      for (std::size_t i = 0; i < count; ++i)
      {
        x.push_back(SomeNumber(random));
      }
      if (count > 60)
      {
        x[count / 2] = count % 2 == 0 ? INFINITY : NAN; // the careful way, among others
      }
      std::vector<double> y(count);
      transform.Forward(x.data(), count, y.data());
      std::vector<double> back(count);
      transform.Inverse(y.data(), count, back.data());
      std::vector<double> inPlace = x;
      transform.Forward(inPlace.data(), count, inPlace.data());
      for (std::size_t i = 0; i < count; ++i)
      {
        ASSERT_EQ(BitsOf(y[i]), BitsOf(transform.Forward(x[i]))) << x[i];
        ASSERT_EQ(BitsOf(back[i]), BitsOf(transform.Inverse(y[i]))) << y[i];
        ASSERT_EQ(BitsOf(inPlace[i]), BitsOf(y[i]));
      }
    }
  }
}

/// What lattice numbers decode to is part of the format: on every processor, compiler and
/// optimisation, for ever.
TEST(Transform, BitsAreThoseOfTheFormat)
{
  std::vector<double> all;
  std::uint64_t state = 1;
  const std::vector<Transform> transforms = { Transform::Asinh(1.0), Transform::Asinh(1e-39),
    Transform::Table({ { -1.0, -0.7 }, { 0.1, 0.3 }, { 1.3, 0.35 }, { 7.7, 9.1 } }) };
  for (const Transform& transform : transforms)
  {
    for (int i = 0; i < 20000; ++i)
    {
      state = state * 6364136223846793005u + 1442695040888963407u;
      const double unit = static_cast<double>(state >> 11) * 0x1p-53;
      const double y = i % 2 == 0 ? 60.0 * unit - 30.0 : unit * unit * unit - 0.5;
      all.push_back(transform.Inverse(y));
      all.push_back(transform.Forward(y));
    }
  }
  EXPECT_EQ(
    ToHex(HashOf(all.data(), all.size() * sizeof(double))), "3b9848e6cf0802ad6c42fdb18cf02f3f");
}

/// Brute force: how far rounding to float moves values of a range in the transformed domain.
TEST(Transform, OutputRoundingIsABound)
{
  std::mt19937_64 random(17);
  std::vector<Transform> transforms = AllKinds();
  transforms.erase(transforms.begin() + 4, transforms.begin() + 6); // scales beyond float
  for (const Transform& transform : transforms)
  {
    for (const ValueRange& range : { ValueRange{ -1.0, 3.0 }, ValueRange{ 1000.0, 1001.0 },
           ValueRange{ -0.001, 0.0 }, ValueRange{ -60000.0, 60000.0 } })
    {
      const double bound = transform.OutputRounding(ScalarType::Float32, range);
      double greatest = 0.0;
      for (int i = 0; i < 20000; ++i)
      {
        double x = std::uniform_real_distribution<>(range.Low, range.High)(random);
        x = i % 3 == 0 ? range.High - (range.High - x) * 1e-3 : x;
        x = i % 3 == 1 ? range.Low + (x - range.Low) * 1e-3 : x;
        const double rounded = static_cast<double>(static_cast<float>(x));
        const double y = transform.Forward(x);
        const double moved = std::abs(transform.Forward(rounded) - y);
        greatest = std::max(greatest, moved);
        ASSERT_LE(moved, bound + 16 * Ulp(y)) << x;
      }
      EXPECT_GT(bound, 0.0);
      EXPECT_LE(transform.OutputRounding(ScalarType::Float64, range), bound);
    }
  }
  EXPECT_EQ(Transform().OutputRounding(ScalarType::Int16, { 0.0, 9.0 }), 0.5);
  EXPECT_EQ(Transform::Asinh(2.0).OutputRounding(ScalarType::UInt8, { 0.0, 9.0 }), 0.25);
  EXPECT_EQ(Transform().OutputRounding(ScalarType::Float32, { 1.0, 1.5 }), 0x1p-24);
  EXPECT_EQ(Transform().OutputRounding(ScalarType::Float32, {}), 0.0);
}

} // namespace
} // namespace banyan
