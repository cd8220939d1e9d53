// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/RaysBesideDepths.h"

#include "Render/Raycast/TileGrid.h"

#include <glm/common.hpp>

#include <algorithm>
#include <map>
#include <vector>

namespace banyan
{
namespace
{

/// Tiles of the picture in which something opaque is.
std::vector<glm::ivec2> OpaqueTiles(const RayScene& scene)
{
  std::vector<glm::ivec2> tiles;
  const TileGrid grid(scene.Viewport);
  const auto width = static_cast<std::ptrdiff_t>(scene.Viewport.Size().x);
  for (std::size_t tile = 0; tile < grid.Count(); ++tile)
  {
    const PixelRect rect = grid.RectOf(tile);
    bool any = false;
    for (int y = rect.Lo.y; y < rect.Hi.y && !any; ++y)
    {
      const auto row =
        scene.Depth.begin() + (y - scene.Viewport.Lo.y) * width + (rect.Lo.x - scene.Viewport.Lo.x);
      any = std::any_of(row, row + rect.Size().x, [](float depth) { return depth < 1.0f; });
    }
    if (any)
    {
      tiles.push_back(grid.PositionOf(tile));
    }
  }
  return tiles;
}

} // namespace

std::shared_ptr<const TileSamplings> WithRaysBesideDepths(
  const std::shared_ptr<const TileSamplings>& samplings, const RayScene& scene)
{
  if (!samplings || scene.Depth.empty())
  {
    return samplings;
  }
  const glm::ivec2 last = samplings->Tiles() - 1;
  std::map<int, int> withAll; // by the number of a sampling with fewer rays
  auto result = std::make_shared<TileSamplings>(*samplings);
  for (const glm::ivec2& tile : OpaqueTiles(scene))
  {
    const glm::ivec2 low = glm::max(tile - 1, 0);
    const glm::ivec2 high = glm::min(tile + 1, last);
    for (int y = low.y; y <= high.y; ++y)
    {
      for (int x = low.x; x <= high.x; ++x)
      {
        RaySampling sampling = samplings->At({ x, y });
        if (sampling.PixelStride > 1)
        {
          sampling.PixelStride = 1;
          const auto added = withAll.emplace(samplings->NumberAt({ x, y }), 0);
          if (added.second)
          {
            added.first->second = result->Add(sampling);
          }
          result->SetNumber({ x, y }, added.first->second);
        }
      }
    }
  }
  return result;
}

} // namespace banyan
