// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Series/Bytes.h"
#include "Series/Quantizer.h"

namespace banyan::testing
{
namespace
{

template <class T>
T ValueAt(const Quantizer& quantizer, std::int64_t base, std::uint32_t offset)
{
  T value;
  Dequantize(quantizer, base, &offset, 1, &value);
  return value;
}

TEST(Quantizer, RealNumbersAreOriginPlusSteps)
{
  const double origin = -0.37;
  const double step = 1e-3;
  const Quantizer quantizer = QuantizerFromBits(
    ScalarType::Float64, BitCast<std::uint64_t>(origin), BitCast<std::uint64_t>(step));
  EXPECT_EQ(quantizer.OriginBits(ScalarType::Float64), BitCast<std::uint64_t>(origin));
  EXPECT_EQ(quantizer.StepBits(ScalarType::Float64), BitCast<std::uint64_t>(step));
  EXPECT_EQ(ValueAt<double>(quantizer, -5, 0), origin + -5 * step);
  EXPECT_EQ(ValueAt<double>(quantizer, -5, 1000), origin + 995 * step);
  EXPECT_EQ(ValueAt<float>(quantizer, 7, 3), static_cast<float>(origin + 10 * step));
}

TEST(Quantizer, IntegersAreMultiplesWithinTheType)
{
  const Quantizer exact = QuantizerFromBits(ScalarType::Int64, 0, 1);
  const std::int64_t large = (std::int64_t{ 1 } << 60) + 1;
  EXPECT_EQ(ValueAt<std::int64_t>(exact, large, 5), large + 5);
  const Quantizer thirds = QuantizerFromBits(ScalarType::UInt8, 0, 3);
  EXPECT_EQ(thirds.StepBits(ScalarType::UInt8), 3u);
  EXPECT_EQ(ValueAt<std::uint8_t>(thirds, 5, 2), 21);
  EXPECT_EQ(ValueAt<std::uint8_t>(thirds, 85, 0), 255);
  EXPECT_EQ(ValueAt<std::uint8_t>(thirds, 86, 0), 255);
  EXPECT_EQ(ValueAt<std::int8_t>(thirds, -43, 0), -128);
  const auto top = std::numeric_limits<std::uint64_t>::max();
  EXPECT_EQ(ValueAt<std::uint64_t>(thirds, static_cast<std::int64_t>(top / 3), 0), top);
  EXPECT_EQ(ValueAt<std::uint64_t>(thirds, static_cast<std::int64_t>(top / 3), 1), top);
}

TEST(Quantizer, RejectsWhatCannotBe)
{
  EXPECT_THROW(QuantizerFromBits(ScalarType::Int8, 0, 0), Error);
  EXPECT_THROW(QuantizerFromBits(ScalarType::Int8, 0, 2), Error);
  EXPECT_THROW(QuantizerFromBits(ScalarType::Int8, 1, 1), Error);
  EXPECT_THROW(QuantizerFromBits(ScalarType::Float32, 0, BitCast<std::uint64_t>(-1.0)), Error);
  EXPECT_THROW(
    QuantizerFromBits(ScalarType::Float64, BitCast<std::uint64_t>(std::nan("")), 0), Error);
}

} // namespace
} // namespace banyan::testing
