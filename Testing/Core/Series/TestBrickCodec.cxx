// SPDX-License-Identifier: BSD-3-Clause
#include "Series/SeriesTesting.h"

#include "Base/Error.h"
#include "Series/BrickCodec.h"
#include "Series/Lorenzo.h"

namespace banyan::testing
{
namespace
{

const std::vector<glm::ivec3> Shapes = { { 1, 1, 1 }, { 2, 1, 1 }, { 1, 1, 5 }, { 1, 9, 2 },
  { 3, 1, 7 }, { 9, 9, 9 }, { 17, 17, 17 }, { 17, 5, 2 } };

template <class C>
void CheckLorenzo()
{
  std::mt19937 random(5);
  for (const glm::ivec3& n : Shapes)
  {
    std::vector<C> codes(static_cast<std::size_t>(n.x * n.y * n.z));
    for (C& code : codes)
    {
      code = static_cast<C>(random());
    }
    const auto at = [&](int x, int y, int z)
    { return x < 0 || y < 0 || z < 0 ? C{ 0 } : codes[(z * n.y + y) * n.x + x]; };
    std::vector<C> residuals;
    for (int z = 0; z < n.z; ++z)
    {
      for (int y = 0; y < n.y; ++y)
      {
        for (int x = 0; x < n.x; ++x)
        {
          const C predicted = static_cast<C>(at(x - 1, y, z) + at(x, y - 1, z) + at(x, y, z - 1) -
                                             at(x - 1, y - 1, z) - at(x - 1, y, z - 1) -
                                             at(x, y - 1, z - 1) + at(x - 1, y - 1, z - 1));
          residuals.push_back(static_cast<C>(at(x, y, z) - predicted));
        }
      }
    }
    FromLorenzo(residuals.data(), n);
    EXPECT_EQ(residuals, codes);
  }
}

TEST(Lorenzo, ResidualsOfTheTextbookPredictorComeBack)
{
  CheckLorenzo<std::uint8_t>();
  CheckLorenzo<std::uint16_t>();
  CheckLorenzo<std::uint32_t>();
}

TEST(Lorenzo, ZigzagAlternates)
{
  for (int i = 0; i < 65536; ++i)
  {
    const int value = static_cast<std::int16_t>(FromZigzag(static_cast<std::uint16_t>(i)));
    EXPECT_EQ(value, i % 2 == 0 ? i / 2 : -(i + 1) / 2);
  }
}

TEST(BrickCodec, MacroVoxelsFillOrAreRejected)
{
  float values[8];
  DecodeBrick(0, nullptr, 0, {}, ScalarType::Float32, { 2, 2, 2 }, -0.0, values);
  EXPECT_TRUE(SameBits(values[7], -0.0f));
  std::int64_t wide[1];
  DecodeBrick(0, nullptr, 0, {}, ScalarType::Int64, { 1, 1, 1 }, -0x1p63, wide);
  EXPECT_EQ(wide[0], std::numeric_limits<std::int64_t>::min());
  const auto reject = [](ScalarType type, double value)
  {
    std::uint64_t room[1];
    EXPECT_THROW(DecodeBrick(0, nullptr, 0, {}, type, { 1, 1, 1 }, value, room), Error) << value;
  };
  reject(ScalarType::Int64, 0x1p63);
  reject(ScalarType::UInt8, 256);
  reject(ScalarType::UInt8, -1);
  reject(ScalarType::UInt8, 0.5);
  reject(ScalarType::Float32, 0.1);
  reject(ScalarType::Float32, 1e300);
  reject(ScalarType::Float64, std::nan(""));
}

TEST(BrickCodec, AnyBytesGiveAnErrorOrValues)
{
  std::mt19937 random(17);
  std::vector<std::uint64_t> out(729);
  int decoded = 0;
  for (int i = 0; i < 20000; ++i)
  {
    Bytes payload(random() % 900);
    for (std::uint8_t& byte : payload)
    {
      byte = static_cast<std::uint8_t>(random());
    }
    if (payload.size() > 2)
    {
      payload[0] = static_cast<std::uint8_t>(random() % 16);
      payload[1] &= 127;
    }
    const auto type = static_cast<ScalarType>(random() % 10);
    const bool real = type == ScalarType::Float32 || type == ScalarType::Float64;
    const Quantizer quantizer =
      QuantizerFromBits(type, 0, real ? BitCast<std::uint64_t>(1e300) : random() | 1);
    const int edge = i % 2 == 0 ? 9 : 1 + static_cast<int>(random() % 9);
    try
    {
      DecodeBrick(static_cast<std::uint8_t>(random() % 4), payload.data(), payload.size(),
        quantizer, type, glm::ivec3(edge), 0.0, out.data());
      ++decoded;
    }
    catch (const Error&)
    {
    }
  }
  EXPECT_GT(decoded, 100);
}

TEST(BrickCodec, UnknownModesAreNamed)
{
  float value;
  try
  {
    DecodeBrick(3, nullptr, 0, {}, ScalarType::Float32, { 1, 1, 1 }, 0, &value);
    FAIL();
  }
  catch (const Error& failure)
  {
    EXPECT_NE(std::string(failure.what()).find("newer"), std::string::npos);
  }
}

TEST(BrickCodec, IdentityTellsApartWhatDecodesDifferently)
{
  const std::uint8_t bytes[] = { 1, 2, 3 };
  Quantizer a;
  a.Step = 1;
  Quantizer b;
  b.Step = 2;
  const glm::ivec3 n(2, 2, 2);
  const auto id = [&](int mode, std::size_t size, const Quantizer& q, ScalarType type, glm::ivec3 s)
  { return IdentityOf(static_cast<std::uint8_t>(mode), bytes, size, q, type, s); };
  const Hash128 first = id(1, 3, a, ScalarType::Float32, n);
  EXPECT_EQ(first, id(1, 3, a, ScalarType::Float32, n));
  EXPECT_NE(first, id(1, 2, a, ScalarType::Float32, n));
  EXPECT_NE(first, id(2, 3, a, ScalarType::Float32, n));
  EXPECT_NE(first, id(1, 3, b, ScalarType::Float32, n));
  EXPECT_NE(first, id(1, 3, a, ScalarType::Float64, n));
  EXPECT_NE(first, id(1, 3, a, ScalarType::Float32, { 4, 2, 1 }));
  EXPECT_EQ(id(2, 3, a, ScalarType::Float32, n), id(2, 3, b, ScalarType::Float32, n));
}

} // namespace
} // namespace banyan::testing
