// SPDX-License-Identifier: BSD-3-Clause
#include "Base/Error.h"
#include "Papers/PaperOctree.h"
#include "Papers/PaperQuantizer.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <set>
#include <vector>

namespace banyan
{
namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr double NotANumber = std::numeric_limits<double>::quiet_NaN();

template <class T>
std::vector<std::uint16_t> Uniform(const PaperQuantizer& quantizer, const std::vector<T>& values)
{
  return QuantizeUniform(
    quantizer, ScalarTypeOf<T>(), values.data(), static_cast<std::int64_t>(values.size()));
}

TEST(PaperQuantizer, LevelsAreEqualAndValuesTheirMiddles)
{
  const PaperQuantizer quantizer{ { 0.0, 4.0 }, 2 };
  EXPECT_EQ(quantizer.LevelWidth(), 1.0);
  EXPECT_EQ(Uniform<float>(quantizer, { 0.0f, 0.99f, 1.0f, 2.5f, 3.0f, 4.0f }),
    (std::vector<std::uint16_t>{ 0, 0, 1, 2, 3, 3 }));
  EXPECT_EQ(quantizer.ValueOf(0), 0.5);
  EXPECT_EQ(quantizer.ValueOf(3), 3.5);
  EXPECT_EQ(quantizer.CodeOf(1.5), 1);
}

TEST(PaperQuantizer, WhatLiesOutsideGetsTheFirstOrLastCode)
{
  const PaperQuantizer quantizer{ { -1.0, 1.0 }, 8 };
  EXPECT_EQ(Uniform<double>(quantizer, { -5.0, 5.0, -Infinity, Infinity, NotANumber }),
    (std::vector<std::uint16_t>{ 0, 255, 0, 255, 0 }));
  const std::vector<double> values{ 3.0, -Infinity, NotANumber };
  EXPECT_EQ(Uniform<double>({ { 3.0, 3.0 }, 8 }, values), (std::vector<std::uint16_t>(3, 0)));
  EXPECT_EQ(Uniform<double>({ {}, 8 }, values), (std::vector<std::uint16_t>(3, 0)));
}

TEST(PaperQuantizer, TheErrorIsAtMostHalfALevel)
{
  std::mt19937_64 random(7);
  for (const auto& range : { ValueRange{ -3.0, 100.0 }, ValueRange{ -1.7e308, 1.7e308 },
         ValueRange{ 1e6, 1e6 + 0.1 }, ValueRange{ 0.0, 1e-300 } })
  {
    for (const int bits : { 1, 8, 16 })
    {
      const PaperQuantizer quantizer{ range, bits };
      const double half = 0.5 * quantizer.LevelWidth();
      // What rounding to doubles of that size may add.
      const double rounding = 4e-16 * std::max(std::abs(range.Low), std::abs(range.High));
      for (int i = 0; i < 200; ++i)
      {
        const double t = std::uniform_real_distribution<>(0, 1)(random);
        const double value = (1 - t) * range.Low + t * range.High;
        EXPECT_LE(std::abs(quantizer.ValueOf(quantizer.CodeOf(value)) - value), half + rounding);
      }
    }
  }
}

TEST(PaperQuantizer, TakesOneComponentOfTuplesOfAnyType)
{
  const PaperQuantizer quantizer{ { 0.0, 256.0 }, 8 };
  const std::vector<std::uint8_t> values{ 9, 17, 9, 255, 9, 0 };
  EXPECT_EQ(QuantizeUniform(quantizer, ScalarType::UInt8, values.data() + 1, 3, 2),
    (std::vector<std::uint16_t>{ 17, 255, 0 }));
}

/// A step of 8 x 8 x 8 voxels: one subdomain of 4^3 has values around a border between levels,
/// the others are rough.
std::vector<float> NearABorder(float shift)
{
  std::vector<float> values;
  std::mt19937 random(3);
  for (int i = 0; i < 512; ++i)
  {
    const int x = i % 8, y = i / 8 % 8, z = i / 64;
    const float noise = std::uniform_real_distribution<float>(0, 1)(random);
    values.push_back(x < 4 && y < 4 && z < 4 ? 99.7f + shift + 0.6f * noise : 256.0f * noise);
  }
  return values;
}

TEST(PaperQuantizer, AdaptiveLevelsLetACalmSubdomainFuse)
{
  const PaperQuantizer quantizer{ { 0.0, 256.0 }, 8 };
  const std::vector<float> values = NearABorder(0.0f);
  const AdaptiveCodes step =
    QuantizeAdaptive(quantizer, ScalarType::Float32, values.data(), glm::ivec3(8), 4, nullptr);
  ASSERT_EQ(step.Origins.size(), 8u);
  EXPECT_GT(step.Origins[0], 0u);
  EXPECT_EQ(std::set<std::uint32_t>(step.Origins.begin() + 1, step.Origins.end()),
    (std::set<std::uint32_t>{ 0 }));
  EXPECT_EQ(step.OriginBits, 8u + 16u);
  const auto uniform = Uniform(quantizer, values);
  const auto macroVoxels = [](const std::vector<std::uint16_t>& codes)
  { return EncodePaperOctree(codes.data(), nullptr, glm::ivec3(8), 8).Counts.MacroVoxels[2]; };
  EXPECT_EQ(macroVoxels(step.Codes), 1);
  EXPECT_EQ(macroVoxels(uniform), 0);
  for (int i = 0; i < 512; ++i)
  {
    const bool calm = i % 8 < 4 && i / 8 % 8 < 4 && i / 64 < 4;
    const double decoded = ValueOfAdaptive(quantizer, calm ? step.Origins[0] : 0, step.Codes[i]);
    EXPECT_LE(std::abs(decoded - values[i]), 0.5);
    EXPECT_TRUE(calm || step.Codes[i] == uniform[i]);
  }
}

TEST(PaperQuantizer, AdaptiveLevelsStayWhileTheyServe)
{
  const PaperQuantizer quantizer{ { 0.0, 256.0 }, 8 };
  const auto next = [&](float shift, const AdaptiveCodes* previous)
  {
    const std::vector<float> values = NearABorder(shift);
    return QuantizeAdaptive(
      quantizer, ScalarType::Float32, values.data(), glm::ivec3(8), 4, previous);
  };
  const AdaptiveCodes first = next(0.0f, nullptr);
  // Still inside the one level: nothing changes, and nothing is told anew.
  const AdaptiveCodes second = next(0.2f, &first);
  EXPECT_EQ(second.Origins, first.Origins);
  EXPECT_EQ(second.Codes, first.Codes);
  EXPECT_EQ(second.OriginBits, 8u);
  // Below it: a new one. Far from any border: those of the whole again.
  const AdaptiveCodes third = next(-0.2f, &second);
  EXPECT_LT(third.Origins[0], first.Origins[0]);
  EXPECT_GT(third.Origins[0], 0u);
  EXPECT_EQ(next(-0.6f, &third).Origins[0], 0u);
}

TEST(PaperQuantizer, AdaptiveLevelsLeaveOddValuesAlone)
{
  const PaperQuantizer quantizer{ { 0.0, 256.0 }, 8 };
  std::vector<float> values = NearABorder(0.0f);
  values[0] = static_cast<float>(NotANumber);
  values[1] = static_cast<float>(Infinity);
  const AdaptiveCodes step =
    QuantizeAdaptive(quantizer, ScalarType::Float32, values.data(), glm::ivec3(8), 4, nullptr);
  EXPECT_EQ(step.Origins, (std::vector<std::uint32_t>(8, 0)));
  EXPECT_EQ(step.Codes, Uniform(quantizer, values));
  const AdaptiveCodes other =
    QuantizeAdaptive(quantizer, ScalarType::Float32, values.data(), glm::ivec3(8), 8, nullptr);
  EXPECT_THROW(
    QuantizeAdaptive(quantizer, ScalarType::Float32, values.data(), glm::ivec3(8), 4, &other),
    Error);
}

} // namespace
} // namespace banyan
