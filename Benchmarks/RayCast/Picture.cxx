// SPDX-License-Identifier: BSD-3-Clause
#include "Picture.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>

namespace banyan::bench
{
namespace
{

bool Holds(const PixelRect& rect, int x, int y)
{
  return x >= rect.Lo.x && x < rect.Hi.x && y >= rect.Lo.y && y < rect.Hi.y;
}

/// @param channel gives channel c in [0, 1] of the picture's pixel (x, y)
template <class Channel>
PictureError Compare(const FloatImage& reference, Channel&& channel)
{
  double largest = 0.0;
  double squares = 0.0;
  for (int y = reference.Rect.Lo.y; y < reference.Rect.Hi.y; ++y)
  {
    for (int x = reference.Rect.Lo.x; x < reference.Rect.Hi.x; ++x)
    {
      const glm::vec4& truth = reference.At(x, y);
      for (int c = 0; c < 3; ++c)
      {
        const double difference = std::abs(channel(x, y, c) - double(truth[c]));
        // Not std::max: a NaN has to come through.
        largest = difference <= largest ? largest : difference;
        squares += difference * difference;
      }
    }
  }
  if (std::isnan(squares))
  {
    return { -std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity() };
  }
  const double mean = squares / (3.0 * static_cast<double>(reference.Rect.Count()));
  return { -10.0 * std::log10(mean), 255.0 * largest };
}

} // namespace

Picture Rounded(const FloatImage& image, int size)
{
  Picture picture;
  picture.Size = size;
  picture.Rgb.assign(static_cast<std::size_t>(size) * size * 3, 0);
  for (int y = image.Rect.Lo.y; y < image.Rect.Hi.y; ++y)
  {
    for (int x = image.Rect.Lo.x; x < image.Rect.Hi.x; ++x)
    {
      const glm::vec4& pixel = image.At(x, y);
      for (int c = 0; c < 3; ++c)
      {
        const float full = std::clamp(pixel[c], 0.0f, 1.0f) * 255.0f + 0.5f;
        // What is no number shows as white: it must not hide.
        picture.Rgb[(static_cast<std::size_t>(y) * size + x) * 3 + c] =
          full <= 255.5f ? static_cast<std::uint8_t>(full) : 255;
      }
    }
  }
  return picture;
}

PictureError ErrorOf(const Picture& picture, const FloatImage& reference)
{
  return Compare(reference, [&](int x, int y, int c)
    { return picture.Rgb[(static_cast<std::size_t>(y) * picture.Size + x) * 3 + c] / 255.0; });
}

PictureError ErrorOf(const FloatImage& picture, const FloatImage& reference)
{
  return Compare(reference, [&](int x, int y, int c)
    { return Holds(picture.Rect, x, y) ? static_cast<double>(picture.At(x, y)[c]) : 0.0; });
}

void WritePicture(const Picture& picture, const std::string& path)
{
  std::ofstream file(path, std::ios::binary);
  file << "P6\n" << picture.Size << " " << picture.Size << "\n255\n";
  const std::size_t row = static_cast<std::size_t>(picture.Size) * 3;
  for (int y = picture.Size - 1; y >= 0; --y)
  {
    file.write(reinterpret_cast<const char*>(picture.Rgb.data() + y * row),
      static_cast<std::streamsize>(row));
  }
  if (!file)
  {
    throw Error("The picture cannot be written.", { path });
  }
}

} // namespace banyan::bench
