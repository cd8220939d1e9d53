// SPDX-License-Identifier: BSD-3-Clause
#include "PicturesAtHand.h"

#include "OthersOnScreen.h"
#include "PixelsBehind.h"

#include "Base/ThreadPool.h"

#include "vtkCamera.h"
#include "vtkRenderer.h"

#include <cstring>
#include <utility>

namespace banyan
{

namespace
{

/// A point in the middle of what a view shows.
glm::dvec3 MiddleOf(const ScreenView& view)
{
  const glm::dvec4 point = glm::inverse(view.WorldToClip) * glm::dvec4(0.0, 0.0, 0.0, 1.0);
  return glm::dvec3(point) / point.w;
}

} // namespace

bool IsSameView(const ScreenView& a, const ScreenView& b)
{
  return a.WorldToClip == b.WorldToClip && a.Size == b.Size;
}

/// Whether a picture of another camera needs no better one.
bool PicturesAtHand::IsSharpIn(const ScreenView& view, const Picture& picture)
{
  const glm::dmat4& old = picture.View.WorldToClip;
  return HaveSameEye(old, view.WorldToClip, picture.View.Size) &&
         ShowsAll(picture.Bytes, OldPictureOfPlane(old, view.WorldToClip, MiddleOf(view)));
}

void PicturesAtHand::Put(Picture picture)
{
  std::optional<Picture>& place = picture.Exact ? this->Exact : this->Coarse;
  place = std::move(picture);
}

void PicturesAtHand::PutSame(int scene, int content, const ScreenView& view)
{
  if (this->Exact)
  {
    this->Exact->Scene = scene;
    this->Exact->Content = content;
    this->Exact->View = view;
  }
}

const PicturesAtHand::Picture* PicturesAtHand::Best(const ScreenView& view) const
{
  const Picture* const exact = this->Exact ? &*this->Exact : nullptr;
  const Picture* const coarse = this->Coarse ? &*this->Coarse : nullptr;
  if (!exact || !coarse)
  {
    return exact ? exact : coarse;
  }
  if (exact->Content == coarse->Content && IsSharpIn(view, *exact))
  {
    return exact;
  }
  const bool ofExact = IsSameView(exact->View, view);
  if (ofExact != IsSameView(coarse->View, view))
  {
    return ofExact ? exact : coarse;
  }
  return exact->Scene >= coarse->Scene ? exact : coarse;
}

/// Reads what is drawn besides the volume.
void PicturesAtHand::ReadOthers(vtkRenderer* renderer, vtkVolume* own, const PixelRect& all)
{
  this->Others = { all.Hi, {}, {} };
  const PixelRect rect = OthersOnScreen(renderer, { own }, all);
  if (rect.Empty())
  {
    return;
  }
  this->Framebuffer.Read(renderer, rect, this->Pixels);
  std::vector<float> depths = DepthsOf(this->Pixels);
  if (!depths.empty())
  {
    this->Others = { all.Hi, rect, std::move(depths) };
  }
}

void PicturesAtHand::Show(vtkRenderer* renderer, vtkVolume* own)
{
  const ScreenView view = ViewOf(renderer);
  this->ReadOthers(renderer, own, { glm::ivec2(0), view.Size });
  const Picture* const best = this->Best(view);
  this->Last = Shown{};
  if (!best)
  {
    return;
  }
  const bool same = IsSameView(best->View, view);
  this->Last = { best->Scene, best->Exact && same, same };
  if (same && best->Bytes.Size == view.Size)
  {
    this->Write(renderer, best->Bytes);
    return;
  }
  glm::dmat3 toOld(1.0);
  if (!same)
  {
    glm::dvec3 point;
    renderer->GetActiveCamera()->GetFocalPoint(&point.x);
    toOld = OldPictureOfPlane(best->View.WorldToClip, view.WorldToClip, point);
  }
  this->Write(renderer, SeenAnew(best->Bytes, toOld, view.Size, ThreadPool::Process()));
}

void PicturesAtHand::Write(vtkRenderer* renderer, const BytePicture& bytes)
{
  if (bytes.Rect.Empty())
  {
    return;
  }
  this->Pixels.resize(static_cast<std::size_t>(bytes.Rect.Count()));
  const std::uint8_t* color = bytes.Pixels.data();
  const std::vector<float> depths = this->Others.In(bytes.Rect);
  for (std::size_t i = 0; i < this->Pixels.size(); ++i, color += 4)
  {
    this->Pixels[i].Depth = depths.empty() ? 1.0f : depths[i];
    std::memcpy(this->Pixels[i].Color, color, 4);
  }
  this->Framebuffer.Write(renderer, bytes.Rect, this->Pixels, { bytes.Rect }, /*blend=*/true);
}

void PicturesAtHand::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Framebuffer.ReleaseGraphicsResources(window);
}

} // namespace banyan
