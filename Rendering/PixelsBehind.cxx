// SPDX-License-Identifier: BSD-3-Clause
#include "PixelsBehind.h"

#include "Base/ThreadPool.h"
#include "Parallel/Composite/Compositing.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// Where the volume covers opaque geometry, the compositor around us must prefer rank 0's pixel to
/// the blank ones of the other ranks, which have depth 1.
constexpr float CoveredDepth = 0.999999f;

std::uint8_t ToByte(float value)
{
  // As lround does, which loops cannot hold vectors of: sums of doubles are exact here.
  constexpr double half = 0.5;
  return static_cast<std::uint8_t>(double{ std::clamp(value, 0.0f, 1.0f) * 255.0f } + half);
}

/// Replaces the colours on rank 0 by those of all ranks, blended in the given order.
void OverBlendInOrder(Communicator& communicator, const std::vector<int>& rankOrder,
  const PixelRect& rect, OpaquePixels& pixels, CompositeStatistics& statistics)
{
  FloatImage mine;
  mine.Rect = rect;
  mine.Pixels.reserve(pixels.size());
  for (const OpaquePixel& pixel : pixels)
  {
    mine.Pixels.emplace_back(pixel.Color[0] / 255.0f, pixel.Color[1] / 255.0f,
      pixel.Color[2] / 255.0f, pixel.Color[3] / 255.0f);
  }
  // The compositor around us may know fewer ranks than there are: the others have drawn nothing.
  std::vector<int> order = rankOrder;
  for (int rank = 0; rank < communicator.Size(); ++rank)
  {
    if (std::find(order.begin(), order.end(), rank) == order.end())
    {
      order.push_back(rank);
    }
  }
  const FloatImage blended = Composite(communicator, mine, order, rect, {}, statistics);
  for (std::size_t i = 0; i < blended.Pixels.size(); ++i)
  {
    for (int c = 0; c < 4; ++c)
    {
      pixels[i].Color[c] = ToByte(blended.Pixels[i][c]);
    }
  }
}

bool Covers(const OpaquePixel& pixel)
{
  return pixel.Depth < 1.0f;
}

} // namespace

PixelRect CombineBehind(Communicator& communicator, const std::vector<int>& rankOrder,
  const PixelRect& rect, OpaquePixels& pixels, CompositeStatistics& statistics)
{
  if (communicator.Size() == 1)
  {
    return {};
  }
  OpaquePixels nearest = pixels;
  if (!rankOrder.empty())
  {
    OverBlendInOrder(communicator, rankOrder, rect, pixels, statistics);
  }
  // Without geometry on any rank, rank 0's pixels are already what lies behind.
  const PixelRect geometry = ReduceNearestGeometry(communicator, rect, nearest, statistics);
  for (std::size_t i = 0; i < pixels.size() && !geometry.Empty(); ++i)
  {
    pixels[i].Depth = nearest[i].Depth;
    if (rankOrder.empty())
    {
      std::copy(nearest[i].Color, nearest[i].Color + 4, pixels[i].Color);
    }
  }
  PixelRect coloured = RectAround(rect, pixels,
    [](const OpaquePixel& pixel)
    {
      return std::any_of(
        pixel.Color, pixel.Color + 4, [](std::uint8_t value) { return value != 0; });
    });
  communicator.Broadcast(0, &coloured, sizeof(coloured));
  return Union(geometry, coloured);
}

std::vector<float> DepthsOf(const OpaquePixels& pixels)
{
  std::vector<float> depths;
  if (std::any_of(pixels.begin(), pixels.end(), Covers))
  {
    depths.reserve(pixels.size());
    for (const OpaquePixel& pixel : pixels)
    {
      depths.push_back(pixel.Depth);
    }
  }
  return depths;
}

void ClearWithoutGeometry(OpaquePixels& pixels)
{
  for (OpaquePixel& pixel : pixels)
  {
    if (!Covers(pixel))
    {
      std::fill(pixel.Color, pixel.Color + 4, std::uint8_t{ 0 });
    }
  }
}

void BlendOver(
  const FloatImage& picture, const PixelRect& part, const PixelRect& rect, OpaquePixels& pixels)
{
  const auto blendRow = [&](std::int64_t row)
  {
    const int y = part.Lo.y + static_cast<int>(row);
    const glm::vec4* front = &picture.At(part.Lo.x, y);
    const glm::vec4* const end = front + part.Size().x;
    OpaquePixel* pixel =
      &pixels[static_cast<std::size_t>(y - rect.Lo.y) * rect.Size().x + (part.Lo.x - rect.Lo.x)];
    for (; front != end; ++front, ++pixel)
    {
      if (front->a <= 0.0f)
      {
        continue;
      }
      for (int c = 0; c < 4; ++c)
      {
        pixel->Color[c] = ToByte((*front)[c] + (1.0f - front->a) * (pixel->Color[c] / 255.0f));
      }
      pixel->Depth = std::min(pixel->Depth, CoveredDepth);
    }
  };
  if (!part.Empty())
  {
    ThreadPool::Process().ParallelFor(part.Size().y, blendRow);
  }
}

} // namespace banyan
