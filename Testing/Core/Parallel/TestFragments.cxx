// SPDX-License-Identifier: BSD-3-Clause
#include "ScalarPacking.h"

#include "Base/Error.h"
#include "Parallel/Composite/FragmentFormat.h"
#include "Parallel/Composite/FragmentMessage.h"
#include "Parallel/Composite/PixelPacking.h"

#include <gtest/gtest.h>

#include <random>

namespace banyan::testing
{
namespace
{

/// Numbers of `bits` bits that change by up to `step` from pixel to pixel.
std::vector<std::uint16_t> Walk(std::size_t count, int bits, int step, unsigned seed)
{
  std::mt19937 random(seed);
  std::vector<std::uint16_t> numbers(4 * count);
  const int most = (1 << bits) - 1;
  int value[4] = { most / 2, 0, most, most / 3 };
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    int& v = value[i % 4];
    v = std::clamp(v + static_cast<int>(random() % (2 * step + 1)) - step, 0, most);
    numbers[i] = static_cast<std::uint16_t>(v);
  }
  return numbers;
}

std::vector<std::uint8_t> Packed(const std::vector<std::uint16_t>& numbers)
{
  const std::size_t count = numbers.size() / 4;
  std::vector<std::uint8_t> packed(PackedBytesAtMost(count));
  packed.resize(PackPixels(numbers.data(), count, packed.data()));
  return packed;
}

TEST(PixelPacking, GivesEveryNumberBack)
{
  for (const std::size_t count : { 0, 1, 2, 7, 8, 9, 15, 16, 17, 1021 })
  {
    for (const int bits : { 1, 3, 8, 9, 14, 15, 16 })
    {
      for (const int step : { 0, 1, 5, 300, 65535 })
      {
        const auto numbers = Walk(count, bits, step, static_cast<unsigned>(bits * step));
        const auto packed = Packed(numbers);
        std::vector<std::uint16_t> back(numbers.size());
        // Memory of exactly the right size: reading beyond the end is an error of the sanitizers.
        const std::vector<std::uint8_t> exact(packed.begin(), packed.end());
        UnpackPixels(exact.data(), exact.size(), count, back.data());
        EXPECT_EQ(back, numbers) << count << " pixels of " << bits << " bits, step " << step;
        EXPECT_EQ(packed, PackedSlowly(numbers, { packed.begin(), packed.begin() + 5 }));

        std::vector<std::uint8_t> plain(PackedBytesAtMost(count));
        plain.resize(WritePlain(numbers.data(), count, plain.data()));
        std::fill(back.begin(), back.end(), std::uint16_t{ 7 });
        ReadPlain(plain.data(), plain.size(), count, back.data());
        EXPECT_EQ(back, numbers);
      }
    }
  }
}

TEST(PixelPacking, MakesSmoothPixelsSmall)
{
  EXPECT_LT(Packed(Walk(1024, 8, 1, 1)).size() * 2, 4 * 1024u);
  EXPECT_LE(Packed(Walk(1024, 8, 0, 1)).size(), 1024u / 8 + 64);
}

TEST(PixelPacking, RefusesWhatEndsTooEarlyOrTooLate)
{
  const auto numbers = Walk(61, 10, 20, 3);
  auto packed = Packed(numbers);
  std::vector<std::uint16_t> back(numbers.size());
  for (std::size_t bytes = 0; bytes < packed.size(); ++bytes)
  {
    const std::vector<std::uint8_t> cut(packed.begin(), packed.begin() + bytes);
    EXPECT_THROW(UnpackPixels(cut.data(), cut.size(), 61, back.data()), Error);
    EXPECT_THROW(ReadPlain(cut.data(), std::min<std::size_t>(bytes, 3), 61, back.data()), Error);
  }
  packed.push_back(0);
  EXPECT_THROW(UnpackPixels(packed.data(), packed.size(), 61, back.data()), Error);
}

/// The worst that n fragments do to a picture of 8 bits, blended over black and over white.
double WorstOf(int meeting, int shares, int kind, unsigned seed)
{
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  double worst = 0.0;
  for (int trial = 0; trial < 400; ++trial)
  {
    const FragmentFormat format = FormatOfFragments(meeting, shares, 1.0f);
    const double most = kind == 0 ? 1.0 : std::min(1.0, 2.0 / meeting);
    const double backdrop = trial % 2;
    glm::dvec4 exact(0.0);
    glm::dvec4 rounded(0.0);
    for (int i = 0; i < meeting; ++i)
    {
      const double alpha = most * unit(random) * (kind == 2 ? 1.0 : unit(random));
      // Colours at the ends of what is possible deviate most.
      const glm::vec4 pixel(static_cast<float>(alpha),
        static_cast<float>(kind == 2 ? 0.0 : alpha * unit(random)), 0.0f,
        static_cast<float>(alpha));
      std::uint16_t numbers[4];
      glm::vec4 read;
      QuantizePixels(format, &pixel, 1, numbers);
      RestorePixels(format, numbers, 1, &read);
      exact += (1.0 - exact.a) * glm::dvec4(pixel);
      rounded += (1.0 - rounded.a) * glm::dvec4(read);
    }
    const glm::dvec4 white(backdrop);
    exact += (1.0 - exact.a) * white;
    rounded += (1.0 - rounded.a) * white;
    for (int c = 0; c < 3; ++c)
    {
      worst = std::max(worst, std::abs(exact[c] - rounded[c]));
    }
  }
  return 255.0 * shares * worst;
}

TEST(FragmentFormat, KeepsThePictureWithinItsShare)
{
  double most = 0.0;
  for (const int meeting : { 1, 2, 3, 4, 8, 16, 64, 128 })
  {
    for (const int shares : { 1, 2 })
    {
      for (const int kind : { 0, 1, 2 })
      {
        const double worst = WorstOf(meeting, shares, kind, static_cast<unsigned>(meeting));
        EXPECT_LT(worst, 1.0) << meeting << " fragments, share 1/" << shares << ", kind " << kind;
        most = std::max(most, worst);
      }
    }
  }
  // So few bits that the limit is really near.
  EXPECT_GT(most, 0.5);
}

TEST(FragmentFormat, OfBytesIsWhatAScreenGets)
{
  FragmentFormat format;
  format.Kind = FragmentFormat::Bytes;
  for (int i = 0; i < 256; ++i)
  {
    const glm::vec4 pixel(static_cast<float>(i) / 255.0f);
    std::uint16_t numbers[4];
    glm::vec4 read;
    QuantizePixels(format, &pixel, 1, numbers);
    RestorePixels(format, numbers, 1, &read);
    EXPECT_EQ(numbers[0], i);
    EXPECT_EQ(read, pixel);
  }
}

TEST(FragmentFormat, DoesNoHarmWithPixelsOutOfRange)
{
  const float infinity = std::numeric_limits<float>::infinity();
  for (const glm::vec4& pixel : { glm::vec4(-1.0f), glm::vec4(1e30f), glm::vec4(infinity),
         glm::vec4(std::numeric_limits<float>::quiet_NaN()), glm::vec4(2.0f, 3.0f, 4.0f, 0.0f) })
  {
    for (const FragmentFormat& format :
      { FormatOfFragments(64, 2, 1.0f), FormatOfFragments(1, 1, 1.0f) })
    {
      std::uint16_t numbers[4];
      glm::vec4 read;
      QuantizePixels(format, &pixel, 1, numbers);
      RestorePixels(format, numbers, 1, &read);
      for (int c = 0; c < 4; ++c)
      {
        EXPECT_TRUE(std::isfinite(read[c]) && read[c] >= 0.0f);
      }
    }
  }
  EXPECT_EQ(FormatOfFragments(2, 1, 1e6f).Kind, FragmentFormat::Floats);
}

TEST(FragmentMessages, RefuseWhatDoesNotFit)
{
  const CompositePlan::Region region{ { 0, 0, 9, false }, { 1, 2, 7, true } };
  FloatImage image{ { { 0, 0 }, { 9, 2 } }, PixelVector(18, glm::vec4(0.25f)) };
  image.At(4, 0) = glm::vec4(0.0f);
  for (const FragmentFormat& format : { FragmentFormat{}, FormatOfFragments(2, 1, 1.0f) })
  {
    FragmentWriter writer;
    writer.Append(region, image, format, true);
    EXPECT_LE(writer.Bytes.size(), FragmentBytesAtMost(region));
    const auto read = [&](const std::vector<std::uint8_t>& bytes, const CompositePlan::Region& into)
    {
      FloatImage target{ image.Rect, PixelVector(18, glm::vec4(0.0f)) };
      FragmentReader reader(bytes.data(), bytes.size());
      reader.Blend(into, target, FragmentReader::Place::Behind, Combination::Over);
      return target;
    };
    const FloatImage target = read(writer.Bytes, region);
    EXPECT_NEAR(target.At(2, 1).r, 0.25f, 1e-2f);
    EXPECT_EQ(target.At(4, 0), glm::vec4(0.0f));
    EXPECT_EQ(target.At(1, 1), glm::vec4(0.0f));
    EXPECT_THROW(read(writer.Bytes, { { 0, 0, 5, false } }), Error);
    for (std::size_t bytes = 0; bytes < writer.Bytes.size(); ++bytes)
    {
      const std::vector<std::uint8_t> cut(writer.Bytes.begin(), writer.Bytes.begin() + bytes);
      EXPECT_THROW(read(cut, region), Error);
    }
  }
}

} // namespace
} // namespace banyan::testing
