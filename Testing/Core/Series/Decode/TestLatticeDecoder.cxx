// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Series/Decode/LatticeDecoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numeric>
#include <random>
#include <vector>

namespace banyan
{
namespace
{

TEST(ValueFromReal, ValuesOfIntegerTypesAreRoundedAndClamped)
{
  EXPECT_EQ(ValueFromReal<std::int8_t>(2.5), 3);
  EXPECT_EQ(ValueFromReal<std::int8_t>(-2.5), -2);
  EXPECT_EQ(ValueFromReal<std::int8_t>(0.49999999999999994), 0);
  EXPECT_EQ(ValueFromReal<std::int8_t>(127.6), 127);
  EXPECT_EQ(ValueFromReal<std::int8_t>(-1e300), -128);
  EXPECT_EQ(ValueFromReal<std::uint8_t>(-0.6), 0);
  EXPECT_EQ(ValueFromReal<std::uint8_t>(255.4), 255);
  EXPECT_EQ(ValueFromReal<std::int32_t>(double(NAN)), 0);
  EXPECT_EQ(ValueFromReal<std::uint64_t>(0x1p64), std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(ValueFromReal<std::uint64_t>(0x1p63), std::uint64_t{ 1 } << 63);
  EXPECT_EQ(ValueFromReal<std::int64_t>(0x1p63), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(ValueFromReal<std::int64_t>(-0x1p63), std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(
    ValueFromReal<std::int64_t>(double(INFINITY)), std::numeric_limits<std::int64_t>::max());
  EXPECT_EQ(ValueFromReal<float>(0.1), 0.1f);
}

template <class T>
void ExpectTableDecodesAsComputed(const Transform& transform, double origin, double step)
{
  const LatticeDecoder<T> table(transform, origin, step, -100, 3000);
  const LatticeDecoder<T> none(transform, origin, step, 1, 0);
  const LatticeDecoder<T> tooMany(transform, origin, step, -40000, 40000);
  std::vector<std::uint32_t> offsets;
  for (std::uint32_t i = 0; i < 3500; ++i)
  {
    offsets.push_back(i);
  }
  offsets.push_back(0x7fffffffu);
  offsets.push_back(0xffffffffu);
  for (const std::int64_t base : { std::int64_t{ -300 }, std::int64_t{ 0 },
         std::numeric_limits<std::int64_t>::max(), std::numeric_limits<std::int64_t>::min() })
  {
    std::vector<T> a(offsets.size());
    std::vector<T> b(offsets.size());
    std::vector<T> c(offsets.size());
    table.Decode(base, offsets.data(), offsets.size(), a.data());
    none.Decode(base, offsets.data(), offsets.size(), b.data());
    tooMany.Decode(base, offsets.data(), offsets.size(), c.data());
    ASSERT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(T)), 0);
    ASSERT_EQ(std::memcmp(a.data(), c.data(), a.size() * sizeof(T)), 0);
    ASSERT_EQ(std::memcmp(&a[17], &b[17], sizeof(T)), 0);
    const auto number = static_cast<std::int64_t>(static_cast<std::uint64_t>(base) + 17);
    const T expected =
      ValueFromReal<T>(transform.Inverse(origin + static_cast<double>(number) * step));
    const T one = table.ValueOf(number);
    ASSERT_EQ(std::memcmp(&expected, &one, sizeof(T)), 0);
    ASSERT_EQ(std::memcmp(&expected, &a[17], sizeof(T)), 0);
  }
}

/// Boxes of all sizes up to some vectors, their rows apart.
template <class T, class Number>
void ExpectBoxesDecodeAsSingleNumbers(const Transform& transform)
{
  const LatticeDecoder<T> decoder(transform, -3.0, 0.01, -100, 3000);
  std::vector<Number> numbers(20 * 19 * 5);
  std::mt19937 random(3);
  for (Number& number : numbers)
  {
    number = static_cast<Number>(random());
  }
  for (int width = 1; width <= 19; ++width)
  {
    const glm::ivec3 size{ width, 3, 2 };
    const glm::i64vec3 pitch{ 1, 20, 20 * 19 };
    for (const std::int64_t step : { 1, 3 })
    {
      const T unset = static_cast<T>(77);
      std::vector<T> values(static_cast<std::size_t>(4 * 23 * 3 * step), unset);
      const glm::i64vec3 to{ step, 23 * step, 23 * 4 * step };
      decoder.Decode(numbers.data(), pitch, size, values.data(), to);
      for (int i = 0; i < 4 * 23 * 3; ++i)
      {
        const glm::ivec3 p{ i % 23, i / 23 % 4, i / 23 / 4 };
        const bool inside = p.x < size.x && p.y < size.y && p.z < size.z;
        const T expected =
          inside ? decoder.ValueOf(numbers[static_cast<std::size_t>(p.x + 20 * (p.y + 19 * p.z))])
                 : unset;
        ASSERT_EQ(std::memcmp(&values[static_cast<std::size_t>(i * step)], &expected, sizeof(T)), 0)
          << width << " " << i;
      }
    }
  }
}

TEST(LatticeDecoder, BoxesDecodeAsSingleNumbers)
{
  for (const Transform& transform : { Transform(), Transform::Asinh(0.5) })
  {
    ExpectBoxesDecodeAsSingleNumbers<float, std::int16_t>(transform);
    ExpectBoxesDecodeAsSingleNumbers<float, std::int32_t>(transform);
    ExpectBoxesDecodeAsSingleNumbers<double, std::int16_t>(transform);
    ExpectBoxesDecodeAsSingleNumbers<double, std::int32_t>(transform);
    ExpectBoxesDecodeAsSingleNumbers<std::uint8_t, std::int16_t>(transform);
  }
}

template <class Number>
void ExpectBoxesAreTransposed()
{
  std::vector<Number> numbers(17 * 17 * 17);
  std::iota(numbers.begin(), numbers.end(), Number{ 1 });
  for (const glm::i64vec3& stride : { glm::i64vec3{ 17, 1, 289 }, glm::i64vec3{ 289, 1, 17 },
         glm::i64vec3{ 17, 289, 1 }, glm::i64vec3{ 289, 17, 1 } })
  {
    for (const glm::ivec3& size :
      { glm::ivec3{ 17, 17, 17 }, glm::ivec3{ 16, 16, 16 }, glm::ivec3{ 8, 9, 7 },
        glm::ivec3{ 9, 7, 8 }, glm::ivec3{ 1, 1, 1 }, glm::ivec3{ 15, 8, 17 } })
    {
      std::vector<Number> ordered(static_cast<std::size_t>(size.x * size.y * size.z) + 1);
      TransposeBox(numbers.data(), stride, size, ordered.data());
      for (int i = 0; i < size.x * size.y * size.z; ++i)
      {
        const glm::i64vec3 p{ i % size.x, i / size.x % size.y, i / size.x / size.y };
        ASSERT_EQ(ordered[static_cast<std::size_t>(i)],
          numbers[static_cast<std::size_t>(p.x * stride.x + p.y * stride.y + p.z * stride.z)]);
      }
      ASSERT_EQ(ordered.back(), 0) << "nothing is written behind";
    }
  }
}

TEST(LatticeDecoder, BoxesAreTransposed)
{
  ExpectBoxesAreTransposed<std::int16_t>();
  ExpectBoxesAreTransposed<std::int32_t>();
}

TEST(LatticeDecoder, TableDecodesAsComputed)
{
  for (const Transform& transform :
    { Transform(), Transform::Asinh(0.5), Transform::Table({ { 0, 0 }, { 1, 5 }, { 90, 6 } }) })
  {
    ExpectTableDecodesAsComputed<float>(transform, -3.0, 0.01);
    ExpectTableDecodesAsComputed<double>(transform, 0.0, 0.003);
    ExpectTableDecodesAsComputed<std::int16_t>(transform, -3.0, 0.01);
    ExpectTableDecodesAsComputed<std::uint64_t>(transform, 0.0, 0.02);
  }
  for (const double step : { 0.0, -1.0, double(NAN), double(INFINITY) })
  {
    EXPECT_THROW(LatticeDecoder<float>(Transform(), 0.0, step, 0, 1), Error);
  }
  EXPECT_THROW(LatticeDecoder<float>(Transform(), double(NAN), 1.0, 0, 1), Error);
}

/// A lattice in the transformed domain keeps the bound there, decades of values apart.
TEST(TransformLattice, KeepsTheBound)
{
  std::mt19937_64 random(18);
  for (const double scale : { 1e-40, 1e-6, 1.0, 1e30 })
  {
    const Transform transform = Transform::Asinh(scale);
    std::vector<float> values = { 0.0f, static_cast<float>(scale), -1e-40f };
    for (int i = 0; i < 5000; ++i)
    {
      const double decades = std::uniform_real_distribution<>(-2.0, 6.0)(random);
      const double value = scale * std::pow(10.0, decades) * (i % 2 == 0 ? 1.0 : -1.0);
      values.push_back(static_cast<float>(value));
    }
    ValueRange range;
    for (const float value : values)
    {
      range.Include(static_cast<double>(value));
    }
    const double bound = transform.TransformedWidth(range) / 512.0;
    // Denormal floats lie further apart than the bound can be kept; elsewhere little is lost.
    const double rounding = transform.OutputRounding(ScalarType::Float32, range);
    const double step = scale < 1e-38 ? 2.0 * bound : 2.0 * (bound - rounding);
    if (scale > 1e-38)
    {
      EXPECT_LT(rounding, 0.001 * bound);
    }
    for (const float value : values)
    {
      const double y = transform.Forward(static_cast<double>(value));
      const double k = std::nearbyint(y / step);
      const float decoded = ValueFromReal<float>(transform.Inverse(k * step));
      const double error = std::abs(transform.Forward(static_cast<double>(decoded)) - y);
      ASSERT_LE(error, scale < 1e-38 ? bound + rounding : bound) << value;
      EXPECT_TRUE(value != 0.0f || decoded == 0.0f);
    }
  }
}

} // namespace
} // namespace banyan
