#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Series/Bytes.h"

namespace banyan::testing
{
namespace
{

template <class T>
std::vector<T> AllKindsOfValues()
{
  using Limits = std::numeric_limits<T>;
  std::vector<T> values = { T(0), T(1), T(2), Limits::max(), Limits::lowest(),
    static_cast<T>(Limits::max() / 2), static_cast<T>(Limits::max() - T(1)) };
  std::mt19937_64 random(7);
  for (int i = 0; i < 4000; ++i)
  {
    const std::uint64_t bits = random();
    T value;
    std::memcpy(&value, &bits, sizeof(T));
    values.push_back(value);
  }
  if constexpr (std::is_floating_point_v<T>)
  {
    for (const T special : { Limits::denorm_min(), Limits::min(), Limits::infinity(),
           -Limits::infinity(), Limits::quiet_NaN(), T(-0.0) })
    {
      values.push_back(special);
    }
  }
  return values;
}

/// Quantizes, checks the bound for each value, and that decoding numbers gives the same bits.
template <class T>
std::size_t CheckBound(const std::vector<T>& values, double bound, const ValueRange& expected)
{
  const Quantizer made = MakeQuantizer(ScalarTypeOf<T>(), bound, expected);
  std::vector<LatticeNumber<T>> numbers(values.size());
  std::vector<T> decoded(values.size());
  const bool all = Quantize(made, values.data(), values.size(), numbers.data(), decoded.data());
  EXPECT_TRUE(WithinBound(values, decoded, bound));
  const Quantizer stored = QuantizerFromBits(
    ScalarTypeOf<T>(), made.OriginBits(ScalarTypeOf<T>()), made.StepBits(ScalarTypeOf<T>()));
  std::size_t onLattice = 0;
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    T again;
    const std::uint32_t none = 0;
    Dequantize(stored, static_cast<std::int64_t>(numbers[i]), &none, 1, &again);
    const bool same = SameBits(again, decoded[i]);
    EXPECT_TRUE(same || !all) << +values[i];
    onLattice += same ? 1 : 0;
  }
  return onLattice;
}

template <class T>
class QuantizerOf : public ::testing::Test
{
};
using AllTypes = ::testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(QuantizerOf, AllTypes);

TYPED_TEST(QuantizerOf, KeepsAnyBoundOnAnyValue)
{
  const auto values = AllKindsOfValues<TypeParam>();
  for (const double bound :
    { 0.0, 1e-300, 1e-10, 0.5, 0.999, 1.0, 1.5, 2.0, 100.25, 32767.0, 1e9, 1e18, 1e19, 1e100 })
  {
    CheckBound(values, bound, RangeOf(values));
    CheckBound(values, bound, ValueRange{});
    CheckBound(values, bound, ValueRange{ 0.0, 1.0 });
  }
}

TYPED_TEST(QuantizerOf, BoundZeroKeepsBits)
{
  const auto values = AllKindsOfValues<TypeParam>();
  const Quantizer exact = MakeQuantizer(ScalarTypeOf<TypeParam>(), 0.0, RangeOf(values));
  std::vector<LatticeNumber<TypeParam>> numbers(values.size());
  std::vector<TypeParam> decoded(values.size());
  Quantize(exact, values.data(), values.size(), numbers.data(), decoded.data());
  EXPECT_EQ(std::memcmp(values.data(), decoded.data(), values.size() * sizeof(TypeParam)), 0);
}

/// The lattice must really be used where the bound is well above one unit in the last place.
template <class T>
void ExpectLatticeServes(double low, double width, double share)
{
  std::vector<T> values;
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(low, low + width);
  for (int i = 0; i < 20000; ++i)
  {
    values.push_back(static_cast<T>(uniform(random)));
  }
  const ValueRange range = RangeOf(values);
  EXPECT_EQ(CheckBound(values, range.Width() * share, range), values.size())
    << low << " + " << width << " * " << share;
}

TEST(Quantizer, LatticeServesTinyHugeAndShiftedRanges)
{
  ExpectLatticeServes<float>(0, 1, 1.0 / 512);
  ExpectLatticeServes<float>(0, 1e-40, 1.0 / 512);
  ExpectLatticeServes<float>(-1e38, 2e38, 1.0 / 512);
  ExpectLatticeServes<float>(1e6, 50, 1.0 / 512);
  ExpectLatticeServes<double>(0, 1e-310, 1.0 / 512);
  ExpectLatticeServes<double>(1e6, 0.1, 1.0 / 512);
  ExpectLatticeServes<double>(-1e307, 2e307, 1.0 / 512);
  ExpectLatticeServes<double>(0, 1, 1e-9);
}

/// Many fields are 0 almost everywhere: that must not become a small constant.
TEST(Quantizer, ZeroDecodesToZero)
{
  for (const ValueRange range : { ValueRange{ -0.0337, 1.03 }, ValueRange{ 0.0, 78.66 },
         ValueRange{ -1e-40, 3e-40 }, ValueRange{ -7e300, 1e300 } })
  {
    const Quantizer quantizer = MakeQuantizer(ScalarType::Float64, range.Width() / 512.0, range);
    ASSERT_GT(quantizer.Step, 0.0);
    const double zero = 0.0;
    double decoded = 1.0;
    std::int32_t number = 0;
    EXPECT_TRUE(Quantize(quantizer, &zero, 1, &number, &decoded));
    EXPECT_EQ(decoded, 0.0) << range.Low;
  }
}

TEST(Quantizer, BoundBelowOneUlpFallsBackToExactValues)
{
  std::vector<float> values;
  for (int i = 0; i < 1000; ++i)
  {
    values.push_back(1e6f + 0.0625f * static_cast<float>(i % 3));
  }
  CheckBound(values, 1e-4, RangeOf(values));
}

TEST(Quantizer, IntegerStepsAreExactArithmetic)
{
  EXPECT_EQ(MakeQuantizer(ScalarType::UInt8, 0.99, {}).IntegerStep, 1u);
  EXPECT_EQ(MakeQuantizer(ScalarType::UInt8, 1.0, {}).IntegerStep, 3u);
  EXPECT_EQ(MakeQuantizer(ScalarType::Int64, 2.7, {}).IntegerStep, 5u);
  const auto top = std::numeric_limits<std::uint64_t>::max();
  const std::vector<std::uint64_t> values = { top, top - 1, top - 2, top - 3, 0, 1, 2 };
  EXPECT_EQ(CheckBound(values, 1.0, RangeOf(values)), values.size());
}

TEST(Quantizer, RejectsWhatCannotBe)
{
  EXPECT_THROW(MakeQuantizer(ScalarType::Float32, -1, {}), Error);
  EXPECT_THROW(MakeQuantizer(ScalarType::Float32, std::nan(""), {}), Error);
  EXPECT_THROW(MakeQuantizer(ScalarType::Int8, INFINITY, {}), Error);
  EXPECT_THROW(QuantizerFromBits(ScalarType::Int8, 0, 0), Error);
  EXPECT_THROW(QuantizerFromBits(ScalarType::Int8, 0, 2), Error);
  EXPECT_THROW(QuantizerFromBits(ScalarType::Int8, 1, 1), Error);
  EXPECT_THROW(QuantizerFromBits(ScalarType::Float32, 0, BitCast<std::uint64_t>(-1.0)), Error);
  EXPECT_THROW(
    QuantizerFromBits(ScalarType::Float64, BitCast<std::uint64_t>(std::nan("")), 0), Error);
}

} // namespace
} // namespace banyan::testing
