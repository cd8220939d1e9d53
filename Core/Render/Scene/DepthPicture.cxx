// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/DepthPicture.h"

#include <glm/common.hpp>

#include <algorithm>

namespace banyan
{
namespace
{

const float* RowOf(const DepthPicture& picture, int y)
{
  return &picture.Depths[static_cast<std::size_t>(y - picture.Rect.Lo.y) *
                         static_cast<std::size_t>(picture.Rect.Size().x)];
}

} // namespace

glm::ivec2 CoarserSize(const glm::ivec2& size, int every)
{
  return (size + (every - 1)) / every;
}

std::vector<float> DepthPicture::In(const PixelRect& part) const
{
  const PixelRect common = Intersection(this->Rect, part);
  if (common.Empty())
  {
    return {};
  }
  std::vector<float> depths(static_cast<std::size_t>(part.Count()), 1.0f);
  for (int y = common.Lo.y; y < common.Hi.y; ++y)
  {
    std::copy_n(RowOf(*this, y) + (common.Lo.x - this->Rect.Lo.x), common.Size().x,
      depths.begin() + std::ptrdiff_t{ y - part.Lo.y } * part.Size().x + (common.Lo.x - part.Lo.x));
  }
  return depths;
}

DepthPicture DepthPicture::Trimmed() const
{
  PixelRect around;
  for (int y = this->Rect.Lo.y; y < this->Rect.Hi.y; ++y)
  {
    const float* const begin = RowOf(*this, y);
    const float* const end = begin + this->Rect.Size().x;
    const auto is = [](float depth) { return depth < 1.0f; };
    const float* const first = std::find_if(begin, end, is);
    if (first != end)
    {
      const auto last = std::find_if(std::reverse_iterator(end), std::reverse_iterator(first), is);
      const int low = this->Rect.Lo.x + static_cast<int>(first - begin);
      const int high = this->Rect.Lo.x + static_cast<int>(last.base() - begin);
      around = Union(around, { { low, y }, { high, y + 1 } });
    }
  }
  return { this->Size, around, this->In(around) };
}

DepthPicture DepthPicture::Coarser(int every) const
{
  DepthPicture coarser{ CoarserSize(this->Size, every), {}, {} };
  const glm::dvec2 scale = glm::dvec2(this->Size) / glm::dvec2(glm::max(coarser.Size, 1));
  const auto middle = [&scale](int pixel, int axis)
  { return static_cast<int>((pixel + 0.5) * scale[axis]); };
  coarser.Rect = Intersection(
    { this->Rect.Lo / every, this->Rect.Hi / every + 2 }, { glm::ivec2(0), coarser.Size });
  for (int y = coarser.Rect.Lo.y; y < coarser.Rect.Hi.y; ++y)
  {
    const int row = middle(y, 1);
    for (int x = coarser.Rect.Lo.x; x < coarser.Rect.Hi.x; ++x)
    {
      const int column = middle(x, 0);
      const bool isIn = column >= this->Rect.Lo.x && column < this->Rect.Hi.x &&
                        row >= this->Rect.Lo.y && row < this->Rect.Hi.y;
      coarser.Depths.push_back(isIn ? RowOf(*this, row)[column - this->Rect.Lo.x] : 1.0f);
    }
  }
  return coarser;
}

DepthPicture NearestOf(const std::vector<DepthPicture>& parts)
{
  DepthPicture nearest;
  for (const DepthPicture& part : parts)
  {
    nearest.Rect = Union(nearest.Rect, part.Rect);
  }
  nearest.Size = parts.empty() ? glm::ivec2(0) : parts.front().Size;
  nearest.Depths.assign(static_cast<std::size_t>(nearest.Rect.Count()), 1.0f);
  const auto closer = [](float a, float b) { return std::min(a, b); };
  for (const DepthPicture& part : parts)
  {
    for (int y = part.Rect.Lo.y; y < part.Rect.Hi.y && !part.Rect.Empty(); ++y)
    {
      const float* const row = RowOf(part, y);
      const auto to = nearest.Depths.begin() +
                      std::ptrdiff_t{ y - nearest.Rect.Lo.y } * nearest.Rect.Size().x +
                      (part.Rect.Lo.x - nearest.Rect.Lo.x);
      std::transform(row, row + part.Rect.Size().x, to, to, closer);
    }
  }
  return nearest;
}

} // namespace banyan
