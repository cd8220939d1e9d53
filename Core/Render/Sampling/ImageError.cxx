// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/ImageError.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

constexpr double Infinity = std::numeric_limits<double>::infinity();

glm::dvec4 PixelOf(const FloatImage& image, int x, int y)
{
  const PixelRect& rect = image.Rect;
  const bool inside = x >= rect.Lo.x && x < rect.Hi.x && y >= rect.Lo.y && y < rect.Hi.y;
  return inside ? glm::dvec4(image.At(x, y)) : glm::dvec4(0.0);
}

} // namespace

double MaxDifference(const FloatImage& a, const FloatImage& b)
{
  const PixelRect area = Union(a.Rect, b.Rect);
  double largest = 0.0;
  for (int y = area.Lo.y; y < area.Hi.y; ++y)
  {
    for (int x = area.Lo.x; x < area.Hi.x; ++x)
    {
      const glm::dvec4 difference = PixelOf(a, x, y) - PixelOf(b, x, y);
      for (int channel = 0; channel < 4; ++channel)
      {
        const double size = std::abs(difference[channel]);
        largest = std::max(largest, std::isnan(size) ? Infinity : size);
      }
    }
  }
  return largest;
}

double Psnr(const FloatImage& a, const FloatImage& b, const PixelRect& area)
{
  double sum = 0.0;
  for (int y = area.Lo.y; y < area.Hi.y; ++y)
  {
    for (int x = area.Lo.x; x < area.Hi.x; ++x)
    {
      const glm::dvec4 difference = PixelOf(a, x, y) - PixelOf(b, x, y);
      for (int channel = 0; channel < 3; ++channel)
      {
        sum += difference[channel] * difference[channel];
      }
    }
  }
  if (std::isnan(sum))
  {
    return -Infinity;
  }
  const double values = 3.0 * static_cast<double>(area.Count());
  return sum > 0.0 ? -10.0 * std::log10(sum / values) : Infinity;
}

} // namespace banyan
