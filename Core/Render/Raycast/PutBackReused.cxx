// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Raycast/PutBackReused.h"

#include "Base/ThreadPool.h"
#include "Render/Raycast/TileGrid.h"
#include "Render/Scene/RayScene.h"
#include "Render/Scene/ReusedRays.h"

#include <atomic>

namespace banyan
{

double PutBackReused(const RayScene& scene, FloatImage& picture, ThreadPool& pool)
{
  const ReusedRays* const reused = scene.Reused.get();
  if (!reused || !reused->Picture)
  {
    return 0.0;
  }
  const TileGrid grid(picture.Rect);
  std::atomic<std::int64_t> shown{ 0 };
  std::atomic<std::int64_t> kept{ 0 };
  pool.ParallelFor(static_cast<std::int64_t>(grid.Count()),
    [&](std::int64_t number)
    {
      const auto tile = static_cast<std::size_t>(number);
      const glm::ivec2 position = grid.PositionOf(tile);
      const PixelRect rect = grid.RectOf(tile);
      const std::uint64_t cast = reused->At(position);
      const int stride = scene.Samplings ? scene.Samplings->At(position).PixelStride : 1;
      const glm::ivec2 first = (rect.Lo + (stride - 1)) / stride * stride;
      int shownHere = 0;
      int keptHere = 0;
      for (int y = first.y; y < rect.Hi.y; y += stride)
      {
        for (int x = first.x; x < rect.Hi.x; x += stride)
        {
          glm::vec4& pixel = picture.At(x, y);
          const bool keeps = (cast & ReusedRays::BitOf(x, y)) == 0;
          if (keeps)
          {
            pixel = reused->Picture->At(x, y);
          }
          const int shows = pixel.a > 0.0f ? 1 : 0;
          shownHere += shows;
          keptHere += keeps ? shows : 0;
        }
      }
      shown += shownHere;
      kept += keptHere;
    });
  return shown > 0 ? static_cast<double>(kept) / static_cast<double>(shown) : 0.0;
}

} // namespace banyan
