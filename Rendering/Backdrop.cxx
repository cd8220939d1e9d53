// SPDX-License-Identifier: BSD-3-Clause
#include "Backdrop.h"

#include "OthersOnScreen.h"
#include "PixelsBehind.h"

#include "Parallel/Communicate/Communicator.h"
#include "Render/Raycast/CoveredParts.h"
#include "Render/Scene/DepthPicture.h"

#include <algorithm>
#include <iterator>
#include <utility>

namespace banyan
{
namespace
{

constexpr OpaquePixel Blank{ 1.0f, { 0, 0, 0, 0 } };
/// Pixels that are on their way from and to the screen: they take some 24 bytes each.
constexpr long long AtOnce = 1LL << 21;

/// The smallest rectangle around those of all ranks. Collective.
PixelRect UnionOfAll(Communicator& communicator, const PixelRect& mine)
{
  std::vector<PixelRect> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());
  PixelRect around;
  for (const PixelRect& rect : all)
  {
    around = Union(around, rect);
  }
  return around;
}

/// Copies a part of one rectangle of pixels to the same place in another one.
void CopyPart(const PixelRect& part, const PixelRect& fromRect, const OpaquePixels& from,
  const PixelRect& toRect, OpaquePixels& to)
{
  const auto at = [&part](const PixelRect& rect, int y)
  { return std::ptrdiff_t{ y - rect.Lo.y } * rect.Size().x + (part.Lo.x - rect.Lo.x); };
  for (int y = part.Lo.y; y < part.Hi.y; ++y)
  {
    std::copy_n(from.begin() + at(fromRect, y), part.Size().x, to.begin() + at(toRect, y));
  }
}

} // namespace

void Backdrop::Read(Communicator& communicator, vtkRenderer* renderer,
  const std::vector<vtkVolume*>& own, const PixelRect& rect, const std::vector<int>& rankOrder,
  CompositeStatistics& statistics)
{
  this->Rect = rect;
  this->BehindRect = {};
  const PixelRect others = OthersOnScreen(renderer, own, this->InRenderer(rect));
  this->Inner = UnionOfAll(communicator, Moved(others, this->Corner));
  this->InnerPixels.clear();
  this->InnerPixels.reserve(static_cast<std::size_t>(this->Inner.Count()));
  for (const PixelRect& rows : InRows(this->Inner, AtOnce, 1))
  {
    this->Framebuffer.Read(renderer, this->InRenderer(rows), this->Pixels);
    this->BehindRect = Union(
      this->BehindRect, CombineBehind(communicator, rankOrder, rows, this->Pixels, statistics));
    this->InnerPixels.insert(this->InnerPixels.end(), this->Pixels.begin(), this->Pixels.end());
  }
  if (communicator.Size() == 1)
  {
    ClearWithoutGeometry(this->InnerPixels); // the background stays on the screen
  }
}

std::vector<float> Backdrop::Depths(const PixelRect& part) const
{
  const PixelRect seen = Intersection(part, this->Inner);
  OpaquePixels pixels(static_cast<std::size_t>(seen.Count()));
  CopyPart(seen, this->Inner, this->InnerPixels, seen, pixels);
  std::vector<float> depths = DepthsOf(pixels);
  return depths.empty() ? depths : DepthPicture{ {}, seen, std::move(depths) }.In(part);
}

void Backdrop::Write(const Communicator& communicator, vtkRenderer* renderer, const PixelRect& part,
  const FloatImage& picture)
{
  const bool alone = communicator.Size() == 1;
  for (const PixelRect& rows : InRows(part, AtOnce, 1))
  {
    // The picture goes over the background that is there, in 8 bit, where nothing else is, and of
    // one rank everywhere: as the compositor blends it over a background that comes last.
    if (communicator.Rank() == 0 && (alone || !(this->Inner == this->Rect)))
    {
      this->WriteOverBackground(renderer, rows, picture, alone);
    }
    // Of several ranks what was read has become what all of them show, and replaces what the first
    // one does.
    const PixelRect inner = Intersection(this->Inner, rows);
    if (!alone && !inner.Empty())
    {
      this->Pixels.assign(static_cast<std::size_t>(inner.Count()), Blank);
      if (communicator.Rank() == 0)
      {
        CopyPart(inner, this->Inner, this->InnerPixels, inner, this->Pixels);
        BlendOver(picture, Intersection(inner, picture.Rect), inner, this->Pixels);
      }
      this->Put(renderer, inner, { inner }, /*blend=*/false);
    }
  }
}

void Backdrop::WriteOver(vtkRenderer* renderer, const FloatImage& picture)
{
  this->Inner = {};
  this->InnerPixels.clear();
  for (const PixelRect& rows : InRows(picture.Rect, AtOnce, 1))
  {
    this->WriteOverBackground(renderer, rows, picture, /*alone=*/true);
  }
}

void Backdrop::WriteOverBackground(
  vtkRenderer* renderer, const PixelRect& rows, const FloatImage& picture, bool alone)
{
  // Blank pixels change nothing: most of some pictures need not be drawn.
  const std::vector<PixelRect> parts = CoveredParts(picture, Intersection(rows, picture.Rect));
  PixelRect around;
  for (const PixelRect& part : parts)
  {
    around = Union(around, part);
  }
  if (around.Empty())
  {
    return;
  }
  this->Pixels.assign(static_cast<std::size_t>(around.Count()), Blank);
  if (alone)
  {
    const PixelRect inner = Intersection(this->Inner, around);
    CopyPart(inner, this->Inner, this->InnerPixels, around, this->Pixels);
  }
  for (const PixelRect& part : parts)
  {
    BlendOver(picture, part, around, this->Pixels);
  }
  this->Put(renderer, around, parts, /*blend=*/true);
}

/// Writes parts of a rectangle, which this->Pixels are of.
void Backdrop::Put(
  vtkRenderer* renderer, const PixelRect& rect, const std::vector<PixelRect>& parts, bool blend)
{
  std::vector<PixelRect> moved;
  std::transform(parts.begin(), parts.end(), std::back_inserter(moved),
    [this](const PixelRect& part) { return this->InRenderer(part); });
  this->Framebuffer.Write(renderer, this->InRenderer(rect), this->Pixels, moved, blend);
}

PixelRect Backdrop::InRenderer(const PixelRect& rect) const
{
  return Moved(rect, -this->Corner);
}

void Backdrop::Forget()
{
  this->Inner = {};
  OpaquePixels().swap(this->InnerPixels);
}

void Backdrop::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Framebuffer.ReleaseGraphicsResources(window);
}

} // namespace banyan
