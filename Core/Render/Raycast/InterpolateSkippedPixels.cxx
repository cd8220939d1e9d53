// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/InterpolateSkippedPixels.h"

#include "Base/ThreadPool.h"
#include "Render/Raycast/TileGrid.h"
#include "Render/Scene/RayScene.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// Fills the pixels of one tile between its rays. It writes no pixel that has a ray, and reads
/// others only of its own rays and of its neighbours to the right and above.
class TileFiller
{
public:
  TileFiller(FloatImage& picture, const PixelRect& tile, int stride)
    : Picture(picture)
    , Tile(tile)
    , Stride(stride)
  {
  }

  void Fill()
  {
    const glm::ivec2 first = this->Tile.Lo / this->Stride * this->Stride;
    for (int y = first.y; y < this->Tile.Hi.y; y += this->Stride)
    {
      for (int x = first.x; x < this->Tile.Hi.x; x += this->Stride)
      {
        this->FillBetween({ x, y });
      }
    }
  }

private:
  glm::vec4 At(const glm::ivec2& pixel) const
  {
    const PixelRect& rect = this->Picture.Rect;
    const bool inside =
      pixel.x >= rect.Lo.x && pixel.y >= rect.Lo.y && pixel.x < rect.Hi.x && pixel.y < rect.Hi.y;
    return inside ? this->Picture.At(pixel.x, pixel.y) : glm::vec4(0.0f);
  }

  /// @param corner the lower left one of four rays
  void FillBetween(const glm::ivec2& corner)
  {
    const int stride = this->Stride;
    const glm::vec4 low[2] = { this->At(corner), this->At(corner + glm::ivec2(stride, 0)) };
    const glm::vec4 high[2] = { this->At(corner + glm::ivec2(0, stride)),
      this->At(corner + glm::ivec2(stride)) };
    const glm::vec4 nothing(0.0f);
    if (low[0] == nothing && low[1] == nothing && high[0] == nothing && high[1] == nothing)
    {
      return;
    }
    const PixelRect cell = Intersection({ corner, corner + stride }, this->Tile);
    const float part = 1.0f / static_cast<float>(stride);
    for (int y = cell.Lo.y; y < cell.Hi.y; ++y)
    {
      const float up = part * static_cast<float>(y - corner.y);
      const glm::vec4 left = low[0] + (high[0] - low[0]) * up;
      const glm::vec4 slope = (low[1] + (high[1] - low[1]) * up - left) * part;
      glm::vec4* const row = &this->Picture.At(cell.Lo.x, y);
      for (int x = cell.Lo.x + (y == corner.y && cell.Lo.x == corner.x ? 1 : 0); x < cell.Hi.x; ++x)
      {
        row[x - cell.Lo.x] = left + slope * static_cast<float>(x - corner.x);
      }
    }
  }

  FloatImage& Picture;
  const PixelRect Tile;
  const int Stride;
};

} // namespace

void InterpolateSkippedPixels(const RayScene& scene, FloatImage& picture, ThreadPool& pool)
{
  if (!scene.Samplings || picture.Rect.Empty() || picture.Pixels.empty())
  {
    return;
  }
  const TileGrid grid(picture.Rect);
  const std::vector<RaySampling>& samplings = scene.Samplings->Samplings();
  const std::vector<bool> used = scene.Samplings->Used();
  // Wide gaps first: between them and narrower ones, pixels of the wide ones are taken as they are.
  for (int stride = RaySampling::LargestStride; stride > 1; stride /= 2)
  {
    bool any = false;
    for (std::size_t i = 0; i < samplings.size(); ++i)
    {
      any = any || (used[i] && samplings[i].PixelStride == stride);
    }
    if (!any)
    {
      continue;
    }
    pool.ParallelFor(static_cast<std::int64_t>(grid.Count()),
      [&](std::int64_t number)
      {
        const auto tile = static_cast<std::size_t>(number);
        if (scene.Samplings->At(grid.PositionOf(tile)).PixelStride == stride)
        {
          TileFiller(picture, grid.RectOf(tile), stride).Fill();
        }
      });
  }
}

PixelRect WithMargin(const RayScene& scene, const PixelRect& rect)
{
  const int stride = scene.Samplings ? scene.Samplings->LargestStride() : 1;
  const int margin = stride > 1 ? stride : 0;
  return Intersection(scene.Viewport, { rect.Lo - margin, rect.Hi + margin });
}

} // namespace banyan
