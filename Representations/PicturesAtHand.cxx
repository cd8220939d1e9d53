// SPDX-License-Identifier: BSD-3-Clause
#include "PicturesAtHand.h"

#include "OthersOnScreen.h"
#include "PixelsBehind.h"
#include "VolumesInDepth.h"

#include "Base/ThreadPool.h"

#include "vtkCamera.h"
#include "vtkRenderer.h"

#include <algorithm>
#include <cstring>
#include <iterator>
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

/// One picture of several volumes.
BytePicture Blended(const std::vector<std::shared_ptr<const BytePicture>>& pictures,
  const DepthOrder& order, const glm::ivec2& size)
{
  std::vector<std::shared_ptr<const FloatImage>> floats;
  PixelRect rect;
  for (const std::shared_ptr<const BytePicture>& picture : pictures)
  {
    floats.push_back(std::make_shared<const FloatImage>(ToFloats(*picture)));
    rect = Union(rect, picture->Rect);
  }
  return RoundToBytes(BlendInDepth(floats, order, rect), size);
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
  std::shared_ptr<const Picture>& place = picture.Exact ? this->Exact : this->Coarse;
  place = std::make_shared<const Picture>(std::move(picture));
}

void PicturesAtHand::PutSame(int scene, int content, const ScreenView& view)
{
  if (this->Exact)
  {
    Picture same = *this->Exact;
    same.Scene = scene;
    same.Content = content;
    same.View = view;
    this->Put(std::move(same));
  }
}

const PicturesAtHand::Picture* PicturesAtHand::Best(const ScreenView& view) const
{
  const Picture* const exact = this->Exact.get();
  const Picture* const coarse = this->Coarse.get();
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

/// Reads what is drawn besides the volumes.
std::shared_ptr<const DepthPicture> PicturesAtHand::ReadOthers(
  vtkRenderer* renderer, const std::vector<vtkVolume*>& props, const PixelRect& all)
{
  auto others = std::make_shared<DepthPicture>(DepthPicture{ all.Hi, {}, {} });
  const PixelRect rect = OthersOnScreen(renderer, props, all);
  if (!rect.Empty())
  {
    this->Framebuffer.Read(renderer, rect, this->Pixels);
    std::vector<float> depths = DepthsOf(this->Pixels);
    if (!depths.empty())
    {
      *others = { all.Hi, rect, std::move(depths) };
    }
  }
  return others;
}

/// The best picture of the volume, as the view sees it.
PicturesAtHand::Choice PicturesAtHand::Choose(vtkRenderer* renderer, const ScreenView& view)
{
  this->Last = Shown{};
  this->Body.clear();
  const Picture* const best = this->Best(view);
  if (!best)
  {
    return nullptr;
  }
  const bool same = IsSameView(best->View, view);
  this->Last = { best->Scene, best->Exact && same, same };
  this->Body = best->Body;
  if (best->Bytes.Rect.Empty())
  {
    return nullptr;
  }
  if (same && best->Bytes.Size == view.Size)
  {
    return { best == this->Exact.get() ? this->Exact : this->Coarse, &best->Bytes };
  }
  glm::dmat3 toOld(1.0);
  if (!same)
  {
    glm::dvec3 point;
    renderer->GetActiveCamera()->GetFocalPoint(&point.x);
    toOld = OldPictureOfPlane(best->View.WorldToClip, view.WorldToClip, point);
  }
  return std::make_shared<const BytePicture>(
    SeenAnew(best->Bytes, toOld, view.Size, ThreadPool::Process()));
}

std::string PicturesAtHand::Show(vtkRenderer* renderer, const std::vector<PicturesAtHand*>& all,
  const std::vector<vtkVolume*>& props)
{
  const ScreenView view = ViewOf(renderer);
  PicturesAtHand& first = *all.front();
  const auto others = first.ReadOthers(renderer, props, { glm::ivec2(0), view.Size });
  std::vector<PicturesAtHand*> shown;
  std::vector<Choice> pictures;
  std::vector<VolumeOnScreen> volumes;
  for (PicturesAtHand* const volume : all)
  {
    volume->Others = others;
    const Choice picture = volume->Choose(renderer, view);
    if (picture && !picture->Rect.Empty() && !volume->Body.empty())
    {
      shown.push_back(volume);
      pictures.push_back(picture);
      volumes.push_back({ volume->Body, picture->Rect });
    }
  }
  if (shown.empty())
  {
    return {};
  }
  std::vector<PlacedBody> bodies;
  std::transform(volumes.begin(), volumes.end(), std::back_inserter(bodies),
    [](const VolumeOnScreen& volume) { return volume.Body; });
  const RayCamera camera = CameraOf(renderer, glm::dvec3(0.0));
  const DepthOrder order(bodies, camera);
  first.Write(
    renderer, pictures.size() == 1 ? *pictures.front() : Blended(pictures, order, view.Size));
  return TellOnce(shown, FindNotInDepth(*MakeSelfCommunicator(), renderer, camera, volumes, order));
}

/// @param bits of NotInDepth
/// @return sentences that were not told before
std::string PicturesAtHand::TellOnce(
  const std::vector<PicturesAtHand*>& volumes, const std::vector<unsigned char>& bits)
{
  unsigned char fresh = 0;
  for (std::size_t i = 0; i < volumes.size(); ++i)
  {
    fresh |= NotToldYet(bits[i], volumes[i]->Told);
  }
  return TellNotInDepth(fresh);
}

void PicturesAtHand::Write(vtkRenderer* renderer, const BytePicture& bytes)
{
  if (bytes.Rect.Empty())
  {
    return;
  }
  this->Pixels.resize(static_cast<std::size_t>(bytes.Rect.Count()));
  const std::uint8_t* color = bytes.Pixels.data();
  const std::vector<float> depths = this->Others->In(bytes.Rect);
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
