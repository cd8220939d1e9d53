// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Base/ForEachScalarType.h"
#include "Series/Format/Exceptions.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <vector>

namespace banyan::testing
{
namespace
{

template <class T>
class Exceptions : public ::testing::Test
{
};

using AllTypes = ::testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;
TYPED_TEST_SUITE(Exceptions, AllTypes);

/// Any bits: NaN with payloads, infinities, both zeros, denormals, extremes.
template <class T>
T AnyBits(std::mt19937& random)
{
  std::uint8_t bytes[sizeof(T)];
  const unsigned kind = random() % 4;
  for (std::uint8_t& byte : bytes)
  {
    byte = static_cast<std::uint8_t>(kind == 0 ? 0xff : kind == 1 ? 0 : random());
  }
  bytes[random() % sizeof(T)] ^= static_cast<std::uint8_t>(1u << random() % 8);
  T value;
  std::memcpy(&value, bytes, sizeof(T));
  return value;
}

/// @param share of 256 of the samples
template <class T>
ExceptionList<T> MakeList(std::uint32_t samples, unsigned share, unsigned seed)
{
  std::mt19937 random(seed);
  ExceptionList<T> list;
  for (std::uint32_t i = 0; i < samples; ++i)
  {
    if (random() % 256 < share)
    {
      list.Positions.push_back(i);
      list.Values.push_back(AnyBits<T>(random));
    }
  }
  return list;
}

TYPED_TEST(Exceptions, ComeBackBitExact)
{
  for (const std::uint32_t samples : { 1u, 7u, 8u, 9u, 512u, 4096u, 32768u })
  {
    for (const unsigned share : { 0u, 1u, 20u, 128u, 255u, 256u })
    {
      const auto list = MakeList<TypeParam>(samples, share, samples + share);
      const Bytes payload = PackExceptions(list, samples, 3);
      const auto back = UnpackExceptions<TypeParam>(payload.data(), payload.size(), samples);
      ASSERT_EQ(back.Positions, list.Positions);
      ASSERT_EQ(back.Values.size(), list.Values.size());
      ASSERT_TRUE(back.Values.empty() || std::memcmp(back.Values.data(), list.Values.data(),
                                           list.Values.size() * sizeof(TypeParam)) == 0);
    }
  }
}

TYPED_TEST(Exceptions, EqualValuesCostNearlyNothing)
{
  ExceptionList<TypeParam> list;
  std::mt19937 random(8);
  list.Values.assign(4096, AnyBits<TypeParam>(random));
  for (std::uint32_t i = 0; i < 4096; ++i)
  {
    list.Positions.push_back(i);
  }
  EXPECT_LT(PackExceptions(list, 4096, 3).size(), 64u);
}

TYPED_TEST(Exceptions, DamageGivesAnErrorOrAListThatFits)
{
  std::mt19937 random(6);
  for (const unsigned share : { 1u, 60u, 256u })
  {
    const std::uint32_t samples = 512;
    const Bytes good = PackExceptions(MakeList<TypeParam>(samples, share, 3), samples, 3);
    for (std::size_t bytes = 0; bytes < good.size(); ++bytes)
    {
      EXPECT_THROW(UnpackExceptions<TypeParam>(good.data(), bytes, samples), Error) << bytes;
    }
    for (int i = 0; i < 300; ++i)
    {
      Bytes bad = good;
      for (int change = 0; change < 2; ++change)
      {
        bad[i % 2 == 0 ? random() % std::min<std::size_t>(8, bad.size()) : random() % bad.size()] =
          static_cast<std::uint8_t>(random());
      }
      try
      {
        const auto list = UnpackExceptions<TypeParam>(bad.data(), bad.size(), samples);
        ASSERT_EQ(list.Positions.size(), list.Values.size());
        ASSERT_TRUE(std::is_sorted(list.Positions.begin(), list.Positions.end()));
        ASSERT_TRUE(list.Positions.empty() || list.Positions.back() < samples);
      }
      catch (const Error&)
      {
      }
    }
  }
}

TEST(Exceptions, MoreThanTheBlockHoldsAreRefused)
{
  const auto list = MakeList<float>(512, 256, 1);
  const Bytes payload = PackExceptions(list, 512, 3);
  EXPECT_THROW(UnpackExceptions<float>(payload.data(), payload.size(), 511), Error);
}

/// Found by fuzzing: a distance so great that the position wrapped around to one before.
TEST(ExceptionPositions, DoNotWrapAround)
{
  Bytes payload{ 2, 13, 0, 0, 5 }; // two of them, stored, a list; the first one at 5
  payload.insert(payload.end(), 9, 0xff);
  payload.push_back(1); // 2^64 - 1 further
  payload.insert(payload.end(), { 0, 0 });
  EXPECT_THROW(UnpackExceptions<std::uint8_t>(payload.data(), payload.size(), 512), Error);
}

} // namespace
} // namespace banyan::testing
