#include "Parallel/FragmentFormat.h"

#include <algorithm>

namespace banyan
{
namespace
{

constexpr float Most = 65535.0f;

/// Steps of colours per unit, times the weight below.
float ColorScale(const FragmentFormat& format)
{
  return 172.0f * static_cast<float>(format.Shares);
}

float WeightOf(const FragmentFormat& format, float alpha)
{
  return 0.5f * alpha + 0.5f / static_cast<float>(format.Meeting);
}

/// To nearest; what is negative or not a number becomes 0.
std::uint16_t Rounded(float value)
{
  return static_cast<std::uint16_t>(value > 0.0f ? std::min(value + 0.5f, Most) : 0.0f);
}

} // namespace

FragmentFormat FormatOfFragments(int meeting, int shares, float brightest)
{
  FragmentFormat format;
  const double steps = 255.0 * std::max(brightest, 1.0f) * std::max(meeting, 1) * shares;
  if (!(steps <= Most))
  {
    return format;
  }
  format.Kind = FragmentFormat::Fragment;
  format.Shares = static_cast<std::uint8_t>(shares);
  format.Meeting = static_cast<std::uint16_t>(std::max(meeting, 1));
  format.Brightest = std::max(brightest, 1.0f);
  return format;
}

void QuantizePixels(
  const FragmentFormat& format, const glm::vec4* pixels, std::size_t count, std::uint16_t* numbers)
{
  if (format.Kind == FragmentFormat::Bytes)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      for (int c = 0; c < 4; ++c)
      {
        numbers[4 * i + c] = Rounded(255.0f * std::min(pixels[i][c], 1.0f));
      }
    }
    return;
  }
  const float alphaSteps = format.AlphaSteps();
  const float scale = ColorScale(format);
  const float half = 0.5f * format.Brightest;
  for (std::size_t i = 0; i < count; ++i)
  {
    const glm::vec4& pixel = pixels[i];
    const std::uint16_t alpha = Rounded(pixel.a * alphaSteps);
    const float written = static_cast<float>(alpha) / alphaSteps;
    const float perColor = scale / WeightOf(format, written);
    const float shift = (written - pixel.a) * half;
    for (int c = 0; c < 3; ++c)
    {
      numbers[4 * i + c] = Rounded((pixel[c] + shift) * perColor);
    }
    numbers[4 * i + 3] = alpha;
    if (pixel == glm::vec4(0.0f))
    {
      std::fill(numbers + 4 * i, numbers + 4 * i + 4, std::uint16_t{ 0 });
    }
  }
}

void RestorePixels(
  const FragmentFormat& format, const std::uint16_t* numbers, std::size_t count, glm::vec4* pixels)
{
  if (format.Kind == FragmentFormat::Bytes)
  {
    for (std::size_t i = 0; i < count; ++i)
    {
      const std::uint16_t* from = numbers + 4 * i;
      pixels[i] = glm::vec4(from[0], from[1], from[2], from[3]) / 255.0f;
    }
    return;
  }
  const float alphaSteps = format.AlphaSteps();
  const float scale = ColorScale(format);
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::uint16_t* from = numbers + 4 * i;
    const float alpha = static_cast<float>(from[3]) / alphaSteps;
    const float step = WeightOf(format, alpha) / scale;
    pixels[i] = glm::vec4(from[0] * step, from[1] * step, from[2] * step, alpha);
  }
}

} // namespace banyan
