// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/VisibilityOrder.h"

#include "Render/Bricks/BrickSource.h"

#include <glm/geometric.hpp>

#include <algorithm>

namespace banyan
{

double VisibilityKey(const Viewpoint& view, const Box& cells)
{
  const glm::dvec3 low(cells.Lo);
  const glm::dvec3 high(cells.Hi);
  if (view.Parallel)
  {
    return glm::dot(view.Direction, low);
  }
  const glm::dvec3 away = glm::max(glm::max(low - view.Eye, view.Eye - high), glm::dvec3(0.0));
  return glm::dot(away, away);
}

std::vector<std::int64_t> VisibilityOrder(
  const Viewpoint& view, const BrickSource& source, const Box& cells)
{
  struct Item
  {
    double Key;
    std::int64_t Brick;
  };
  const glm::ivec3 counts = source.Bricks();
  const std::int64_t bricks = std::int64_t{ counts.x } * counts.y * counts.z;
  std::vector<Item> items;
  for (std::int64_t brick = 0; brick < bricks; ++brick)
  {
    const Box part = Intersection(source.CellsOf(brick), cells);
    if (!part.Empty())
    {
      items.push_back({ VisibilityKey(view, source.CellsOf(brick)), brick });
    }
  }
  std::sort(items.begin(), items.end(),
    [](const Item& a, const Item& b)
    { return a.Key < b.Key || (a.Key == b.Key && a.Brick < b.Brick); });
  std::vector<std::int64_t> order;
  order.reserve(items.size());
  for (const Item& item : items)
  {
    order.push_back(item.Brick);
  }
  return order;
}

} // namespace banyan
