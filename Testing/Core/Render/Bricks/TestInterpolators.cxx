// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/Interpolators.h"
#include "Render/Scenes.h"

#include <gtest/gtest.h>

#include <cstring>
#include <random>

namespace
{

using namespace banyan;

using AllTypes = testing::Types<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t,
  std::int32_t, std::uint32_t, std::int64_t, std::uint64_t, float, double>;

constexpr int Size = 7;

void RandomPosition(std::int64_t (&position)[3], std::mt19937_64& random)
{
  for (std::int64_t& p : position)
  {
    p = static_cast<std::int64_t>(random() % static_cast<std::uint64_t>(ToFixed(Size - 1)));
    p = random() % 9 == 0 ? p >> FractionBits << FractionBits : p; // on a sample
  }
}

template <class T>
class Interpolators : public testing::Test
{
};
TYPED_TEST_SUITE(Interpolators, AllTypes);

TYPED_TEST(Interpolators, TrilinearInDouble)
{
  using T = TypeParam;
  std::mt19937_64 random(21);
  std::vector<T> values(Size * Size * Size);
  for (T& value : values)
  {
    value = static_cast<T>(random() % 120); // small: float is exact enough
  }
  BrickView view{ values.data(), ScalarTypeOf<T>(), { 1, Size, Size * Size }, {} };
  const double low = 37.0;
  const PlainInterpolator<T> plain(view, low);
  for (int i = 0; i < 2000; ++i)
  {
    std::int64_t position[3];
    RandomPosition(position, random);
    double sum = IsRelative<T> ? -low : 0.0;
    for (int corner = 0; corner < 8; ++corner)
    {
      double weight = 1.0;
      std::ptrdiff_t index = 0;
      for (int axis = 0; axis < 3; ++axis)
      {
        const double p = static_cast<double>(position[axis]) / static_cast<double>(ToFixed(1));
        const bool upper = corner >> axis & 1;
        weight *= upper ? p - std::floor(p) : 1.0 - (p - std::floor(p));
        index += (static_cast<int>(p) + upper) * view.Stride[axis];
      }
      sum += weight * static_cast<double>(values[index]);
    }
    ASSERT_NEAR(plain.At(position), sum, 1e-4);
  }
}

/// Whatever the strides, the same bits are drawn.
TEST(Strides, MirroredAndInterleavedArraysDrawTheSame)
{
  const glm::ivec3 n(23, 18, 20);
  const std::vector<float> values = scenes::Sampled(scenes::Standard, n);
  RayScene scene = scenes::Scene(n, { 50, 40 });
  scene.OpacityLimit = 0.1f; // rays end in the middle of blocks
  scene.SampleDistance = 0.41;
  const SampleArray plain = scenes::ArrayOf(values, n);
  const scenes::Drawn expected = scenes::Draw(scene, plain);
  EXPECT_GT(expected.Image.At(25, 20).a, 0.1f);

  std::vector<float> mirrored(values.size());
  std::vector<float> interleaved(2 * values.size(), NAN);
  for (int z = 0; z < n.z; ++z)
  {
    for (int y = 0; y < n.y; ++y)
    {
      for (int x = 0; x < n.x; ++x)
      {
        const std::size_t at = x + std::size_t(n.x) * (y + std::size_t(n.y) * z);
        mirrored[x + n.x * (n.y - 1 - y + std::size_t(n.y) * z)] = values[at];
        interleaved[2 * at + 1] = values[at];
      }
    }
  }
  SampleArray array = plain;
  array.Values = mirrored.data() + n.x * (n.y - 1);
  array.Stride[1] = -n.x;
  const scenes::Drawn fromMirrored = scenes::Draw(scene, array);
  EXPECT_EQ(MaxDifference(fromMirrored.Image, expected.Image), 0.0);
  EXPECT_EQ(fromMirrored.Statistics.SamplesTaken, expected.Statistics.SamplesTaken);

  array = plain;
  array.Values = interleaved.data();
  array.Components = 2;
  array.Component = 1;
  for (std::ptrdiff_t& stride : array.Stride)
  {
    stride *= 2;
  }
  const scenes::Drawn fromInterleaved = scenes::Draw(scene, array);
  EXPECT_EQ(MaxDifference(fromInterleaved.Image, expected.Image), 0.0);
  EXPECT_EQ(fromInterleaved.Statistics.SamplesTaken, expected.Statistics.SamplesTaken);
}

} // namespace
