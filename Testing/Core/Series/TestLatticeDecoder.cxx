#include "Base/Error.h"
#include "Series/LatticeDecoder.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>
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
