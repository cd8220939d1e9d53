#include "Render/BlockInterpolator.h"
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

/// Random values over the whole range of the type, some of them not finite.
template <class T>
std::vector<T> RandomValues(std::size_t count, std::mt19937_64& random)
{
  std::vector<T> values(count);
  for (T& value : values)
  {
    if constexpr (std::is_integral_v<T>)
    {
      value = static_cast<T>(random());
    }
    else
    {
      value = static_cast<T>(static_cast<double>(random() % 2000001) * 1e-3 - 1000.0);
      value = random() % 50 == 0 ? std::numeric_limits<T>::quiet_NaN() : value;
      value = random() % 50 == 0 ? std::numeric_limits<T>::infinity() : value;
    }
  }
  return values;
}

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

#if BANYAN_HAS_BLOCKS

template <class T, bool Pairs>
void ExpectSameBits(const BrickView& view, std::mt19937_64& random)
{
  using Block = BlockInterpolator<T, Pairs>;
  const double low = 12.5;
  ASSERT_TRUE(Block::CanRead(view));
  const Block blocks(view, low);
  const PlainInterpolator<T> plain(view, low);
  for (int i = 0; i < 3000; ++i)
  {
    std::int64_t start[3];
    std::int64_t end[3];
    std::int64_t step[3];
    RandomPosition(start, random);
    RandomPosition(end, random);
    for (int axis = 0; axis < 3; ++axis)
    {
      step[axis] = (end[axis] - start[axis]) / 3;
    }
    const int count = 1 + i % 4;
    alignas(16) float found[4];
    _mm_store_ps(found, blocks.At(PositionBlock(start, step, count)));
    for (int k = 0; k < 4; ++k)
    {
      const int expectedAt = std::min(k, count - 1);
      const std::int64_t position[3] = { start[0] + expectedAt * step[0],
        start[1] + expectedAt * step[1], start[2] + expectedAt * step[2] };
      const float expected = plain.At(position);
      const bool same = std::isnan(expected) ? std::isnan(found[k]) : expected == found[k];
      ASSERT_TRUE(same) << expected << " " << found[k];
    }
  }
}

TYPED_TEST(Interpolators, BlocksGiveTheBitsOfThePlainWay)
{
  using T = TypeParam;
  std::mt19937_64 random(5);
  // Rows with gaps, and an odd start, so that nothing is aligned.
  const std::vector<T> values = RandomValues<T>(3 * 11 * 11 * 11 + 1, random);
  BrickView view{ values.data() + 1, ScalarTypeOf<T>(), { 1, 11, 11 * 11 }, {} };
  ExpectSameBits<T, false>(view, random);
  if constexpr (!IsRelative<T>)
  {
    ExpectSameBits<T, true>(view, random);
  }
  view = { values.data() + 1, ScalarTypeOf<T>(), { 3, 33, 3 * 11 * 11 }, {} };
  ExpectSameBits<T, false>(view, random);
  EXPECT_FALSE((BlockInterpolator<T, true>::CanRead(view)));
  view.Stride[1] = -33;
  EXPECT_FALSE((BlockInterpolator<T, false>::CanRead(view)));
}

#endif

/// Strides that only the plain way can read draw the same bits.
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
