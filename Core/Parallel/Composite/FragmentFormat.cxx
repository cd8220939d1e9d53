// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/FragmentFormat.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <vector>

namespace banyan
{
namespace
{

constexpr float Most = 65535.0f;
constexpr double Covering = 0.7; ///< the part of a step's weight that is due to opacity

/// Steps of colours per unit, times the weight below.
float ColorScale(const FragmentFormat& format)
{
  return 172.0f * static_cast<float>(format.Shares);
}

float WeightOf(const FragmentFormat& format, float alpha)
{
  return static_cast<float>(Covering) * alpha +
         static_cast<float>(1.0 - Covering) / static_cast<float>(format.Meeting);
}

/// q = Scale * log(1 + PerOpacity * a)
struct AlphaCode
{
  double Scale;
  double PerOpacity;

  explicit AlphaCode(const FragmentFormat& format)
    : Scale(255.0 * format.Brightest * format.Shares / Covering)
    , PerOpacity(Covering / (1.0 - Covering) * format.Meeting)
  {
  }
  double OfOpaque() const { return this->Scale * std::log1p(this->PerOpacity); }
};

/// The opacities of all numbers up to that of opacity 1; few formats occur in a frame.
const std::vector<float>& OpacitiesOf(const FragmentFormat& format)
{
  using Key = std::tuple<int, int, float>;
  thread_local std::map<Key, std::vector<float>> tables;
  constexpr std::size_t most = 256;
  if (tables.size() > most)
  {
    tables.clear();
  }
  std::vector<float>& table = tables[Key{ format.Meeting, format.Shares, format.Brightest }];
  if (table.empty())
  {
    const AlphaCode code(format);
    const int last = static_cast<int>(std::ceil(std::min(code.OfOpaque(), double{ Most })));
    for (int q = 0; q <= last; ++q)
    {
      const double opacity = std::expm1(q / code.Scale) / code.PerOpacity;
      table.push_back(static_cast<float>(std::min(opacity, 1.0)));
    }
  }
  return table;
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
  format.Kind = FragmentFormat::Fragment;
  format.Shares = static_cast<std::uint8_t>(shares);
  format.Meeting = static_cast<std::uint16_t>(std::clamp(meeting, 1, 65535));
  format.Brightest = std::max(brightest, 1.0f);
  return AlphaCode(format).OfOpaque() < Most ? format : FragmentFormat{};
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
  const std::vector<float>& opacities = OpacitiesOf(format);
  const AlphaCode code(format);
  const float codeScale = static_cast<float>(code.Scale);
  const float perOpacity = static_cast<float>(code.PerOpacity);
  const float last = static_cast<float>(opacities.size() - 1);
  const float scale = ColorScale(format);
  const float half = 0.5f * format.Brightest;
  for (std::size_t i = 0; i < count; ++i)
  {
    const glm::vec4& pixel = pixels[i];
    const float wanted = codeScale * std::log(1.0f + perOpacity * std::max(pixel.a, 0.0f));
    const std::uint16_t alpha = Rounded(std::min(wanted, last));
    const float written = opacities[alpha];
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
  const std::vector<float>& opacities = OpacitiesOf(format);
  const float scale = ColorScale(format);
  for (std::size_t i = 0; i < count; ++i)
  {
    const std::uint16_t* from = numbers + 4 * i;
    const float alpha = opacities[std::min<std::size_t>(from[3], opacities.size() - 1)];
    const float step = WeightOf(format, alpha) / scale;
    pixels[i] = glm::vec4(from[0] * step, from[1] * step, from[2] * step, alpha);
  }
}

} // namespace banyan
