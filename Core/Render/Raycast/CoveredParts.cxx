// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/CoveredParts.h"

#include <algorithm>

namespace banyan
{
namespace
{

constexpr int Tile = 32;

bool AnyCovered(const FloatImage& picture, const PixelRect& rect)
{
  const std::ptrdiff_t width = picture.Rect.Size().x;
  for (int y = rect.Lo.y; y < rect.Hi.y; ++y)
  {
    const auto row = picture.Pixels.begin() + (y - picture.Rect.Lo.y) * width;
    if (std::any_of(row + (rect.Lo.x - picture.Rect.Lo.x), row + (rect.Hi.x - picture.Rect.Lo.x),
          [](const glm::vec4& pixel) { return pixel.a > 0.0f; }))
    {
      return true;
    }
  }
  return false;
}

/// Of one row of tiles.
void AddPartsOfBand(const FloatImage& picture, const PixelRect& band, std::vector<PixelRect>& parts)
{
  bool before = false;
  for (int x = band.Lo.x; x < band.Hi.x; x += Tile)
  {
    const PixelRect tile{ { x, band.Lo.y }, { std::min(x + Tile, band.Hi.x), band.Hi.y } };
    const bool covered = AnyCovered(picture, tile);
    if (covered && before)
    {
      parts.back().Hi.x = tile.Hi.x;
    }
    else if (covered)
    {
      parts.push_back(tile);
    }
    before = covered;
  }
}

} // namespace

std::vector<PixelRect> CoveredParts(const FloatImage& picture, const PixelRect& all)
{
  std::vector<PixelRect> parts;
  for (int y = all.Lo.y; y < all.Hi.y; y += Tile)
  {
    AddPartsOfBand(picture, { { all.Lo.x, y }, { all.Hi.x, std::min(y + Tile, all.Hi.y) } }, parts);
  }
  return parts;
}

} // namespace banyan
