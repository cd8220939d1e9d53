#include "Backdrop.h"

#include "OthersOnScreen.h"
#include "PixelsBehind.h"

#include "Parallel/Communicator.h"

#include <algorithm>

namespace banyan
{
namespace
{

constexpr OpaquePixel Blank{ 1.0f, { 0, 0, 0, 0 } };

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

/// Calls with the positions, in the pixels of both rectangles, where rows of the inner one begin.
template <class Function>
void ForRows(const PixelRect& outer, const PixelRect& inner, const Function& function)
{
  const auto width = static_cast<std::ptrdiff_t>(inner.Size().x);
  for (int y = 0; y < inner.Size().y; ++y)
  {
    const glm::ivec2 place = inner.Lo - outer.Lo + glm::ivec2(0, y);
    function(std::ptrdiff_t{ place.y } * outer.Size().x + place.x, y * width, width);
  }
}

FloatImage Part(const FloatImage& picture, const PixelRect& rect)
{
  FloatImage part;
  part.Rect = rect;
  part.Pixels.resize(static_cast<std::size_t>(rect.Count()));
  ForRows(picture.Rect, rect,
    [&](std::ptrdiff_t from, std::ptrdiff_t to, std::ptrdiff_t count)
    { std::copy_n(picture.Pixels.begin() + from, count, part.Pixels.begin() + to); });
  return part;
}

} // namespace

void Backdrop::Read(Communicator& communicator, vtkRenderer* renderer, vtkProp* self,
  const PixelRect& rect, const std::vector<int>& rankOrder, CompositeStatistics& statistics)
{
  this->Rect = rect;
  this->BehindRect = {};
  this->Inner = UnionOfAll(communicator, OthersOnScreen(renderer, self, rect));
  this->InnerPixels.clear();
  if (!this->Inner.Empty())
  {
    this->Framebuffer.Read(renderer, this->Inner, this->InnerPixels);
    this->BehindRect =
      CombineBehind(communicator, rankOrder, this->Inner, this->InnerPixels, statistics);
  }
}

std::vector<float> Backdrop::Depths() const
{
  const std::vector<float> inner = DepthsOf(this->InnerPixels);
  if (inner.empty() || this->Inner == this->Rect)
  {
    return inner;
  }
  std::vector<float> depths(static_cast<std::size_t>(this->Rect.Count()), 1.0f);
  ForRows(this->Rect, this->Inner,
    [&](std::ptrdiff_t to, std::ptrdiff_t from, std::ptrdiff_t count)
    { std::copy_n(inner.begin() + from, count, depths.begin() + to); });
  return depths;
}

void Backdrop::Write(
  const Communicator& communicator, vtkRenderer* renderer, const FloatImage& picture)
{
  if (communicator.Rank() > 0)
  {
    if (!this->Inner.Empty())
    {
      this->Pixels.assign(static_cast<std::size_t>(this->Inner.Count()), Blank);
      this->Framebuffer.Write(renderer, this->Inner, this->Pixels, /*blend=*/false);
    }
    return;
  }
  // The picture goes over the background that is there, in 8 bit, where nothing else is, and of one
  // rank everywhere: as the compositor blends it over a background that comes last. Of several
  // ranks what was read has become what all of them show, and replaces what the first one does.
  const bool alone = communicator.Size() == 1;
  if (alone || !(this->Inner == this->Rect))
  {
    this->Pixels.assign(static_cast<std::size_t>(this->Rect.Count()), Blank);
    if (alone)
    {
      ClearWithoutGeometry(this->InnerPixels);
      ForRows(this->Rect, this->Inner,
        [this](std::ptrdiff_t to, std::ptrdiff_t from, std::ptrdiff_t count)
        { std::copy_n(this->InnerPixels.begin() + from, count, this->Pixels.begin() + to); });
    }
    BlendOver(picture, this->Pixels);
    if (!alone)
    {
      ForRows(this->Rect, this->Inner,
        [this](std::ptrdiff_t to, std::ptrdiff_t, std::ptrdiff_t n)
        { std::fill_n(this->Pixels.begin() + to, n, Blank); });
    }
    this->Framebuffer.Write(renderer, this->Rect, this->Pixels, /*blend=*/true);
  }
  if (!alone && !this->Inner.Empty())
  {
    BlendOver(Part(picture, this->Inner), this->InnerPixels);
    this->Framebuffer.Write(renderer, this->Inner, this->InnerPixels, /*blend=*/false);
  }
}

void Backdrop::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Framebuffer.ReleaseGraphicsResources(window);
}

} // namespace banyan
