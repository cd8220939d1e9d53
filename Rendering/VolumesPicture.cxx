// SPDX-License-Identifier: BSD-3-Clause
#include "VolumesPicture.h"

#include "RendererCamera.h"
#include "VolumesInDepth.h"
#include "vtkBanyanVolumeMapper.h"

#include "Base/Progress.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Composite/MixVolumes.h"

#include "vtkCollection.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkSetGet.h"
#include "vtkVolume.h"

#include <algorithm>
#include <iterator>

namespace banyan
{
namespace
{

/// Surfaces behind less of it are not seen.
constexpr float LeastLight = 1e-3f;

} // namespace

std::vector<VolumeOnScreen> VolumesPicture::OnScreen(const std::vector<VolumeFrame*>& frames)
{
  std::vector<VolumeOnScreen> volumes;
  for (const VolumeFrame* const frame : frames)
  {
    vtkBanyanVolumeMapper* const mapper = frame->Mapper();
    volumes.push_back(
      { BodyOf(frame->Volume(), mapper, mapper->State->Field.Place().Bounds, frame->Scene()),
        frame->Scene().Viewport });
  }
  return volumes;
}

DepthOrder OrderInDepth(const std::vector<VolumeOnScreen>& volumes, const ScreenView& view)
{
  std::vector<PlacedBody> bodies;
  std::transform(volumes.begin(), volumes.end(), std::back_inserter(bodies),
    [](const VolumeOnScreen& volume) { return volume.Body; });
  return DepthOrder(bodies, RayCamera(view.WorldToClip, view.Size, glm::dvec3(0.0)));
}

void VolumesPicture::WarnNotInDepth(vtkBanyanVolumeMapper* first,
  const std::vector<VolumeFrame*>& frames, const std::vector<unsigned char>& bits)
{
  unsigned char fresh = 0;
  for (std::size_t i = 0; i < frames.size(); ++i)
  {
    fresh |= NotToldYet(bits[i], frames[i]->Mapper()->State->ToldNotInDepth);
  }
  const std::string note = TellNotInDepth(fresh);
  if (!note.empty() && first->State->Communicator->Rank() == 0)
  {
    vtkWarningWithObjectMacro(first, << note);
  }
}

VolumesPicture::VolumesPicture(
  vtkRenderer* renderer, vtkBanyanVolumeMapper* mapper, vtkVolume* volume)
  : Renderer(renderer)
  , Called(mapper)
  , CalledVolume(volume)
{
  for (vtkVolume* const shown : VolumesDrawnWith(renderer, volume))
  {
    auto* const its =
      shown == volume ? mapper : vtkBanyanVolumeMapper::SafeDownCast(shown->GetMapper());
    this->Frames.emplace_back(its, *its->State, shown);
    if (shown != volume)
    {
      its->State->DrawnByOthers.insert(shown);
    }
  }
}

void VolumesPicture::ForgetDrawn(vtkRenderer* renderer)
{
  vtkPropCollection* const props = renderer->GetViewProps();
  vtkCollectionSimpleIterator at;
  props->InitTraversal(at);
  while (vtkProp* const prop = props->GetNextProp(at))
  {
    auto* const volume = vtkVolume::SafeDownCast(prop);
    auto* const mapper =
      volume ? vtkBanyanVolumeMapper::SafeDownCast(volume->GetMapper()) : nullptr;
    if (mapper)
    {
      mapper->State->DrawnByOthers.erase(volume);
    }
  }
}

void VolumesPicture::Draw()
{
  if (!this->Called->Attempt([this] { return this->Look(); }))
  {
    return;
  }
  const auto shows = [this](VolumeFrame& frame)
  {
    return frame.Mapper()->Attempt(
      [&]
      {
        frame.Mapper()->UpdateField(frame.Volume());
        return frame.Prepare(this->View.View);
      });
  };
  this->Frames.erase(std::remove_if(this->Frames.begin(), this->Frames.end(),
                       [&](VolumeFrame& frame) { return !shows(frame); }),
    this->Frames.end());
  if (!this->Frames.empty())
  {
    // The first one that shows something is the same on all ranks.
    vtkBanyanVolumeMapper* const first = this->Frames.front().Mapper();
    first->State->RankOrderBehind = this->Called->State->RankOrderBehind;
    first->Attempt(
      [&]
      {
        this->DrawPrepared(first);
        return true;
      });
  }
}

/// Collective: finds the picture, and the part of it that the window shows.
bool VolumesPicture::Look()
{
  const PhaseScope beginning(Phase::Beginning);
  const auto eye = static_cast<std::size_t>(EyeOf(this->Renderer));
  WindowTile tile = TileOf(this->Renderer);
  this->Called->State->Communicator->Broadcast(0, &tile, sizeof(tile));
  this->View = PictureOf(this->Renderer, tile, this->Called->State->LastViews.at(eye));
  for (VolumeFrame& frame : this->Frames)
  {
    frame.Mapper()->State->LastViews.at(eye) = this->View.View.WorldToClip;
  }
  return true;
}

void VolumesPicture::DrawPrepared(vtkBanyanVolumeMapper* first)
{
  const PhaseScope beginning(Phase::Beginning);
  MapperState& state = *first->State;
  std::vector<vtkVolume*> props;
  PixelRect rect;
  std::vector<VolumeFrame*> frames;
  for (VolumeFrame& frame : this->Frames)
  {
    frames.push_back(&frame);
    props.push_back(frame.Volume());
    rect = Union(rect, frame.Scene().Viewport);
  }
  rect = Intersection(rect, this->View.Shown);
  std::vector<VolumeOnScreen> volumes = OnScreen(frames);
  for (VolumeOnScreen& volume : volumes)
  {
    volume.Viewport = Moved(Intersection(volume.Viewport, rect), -this->View.Shown.Lo);
  }
  const DepthOrder order = OrderInDepth(volumes, this->View.View);
  this->FindGroups(first, frames, volumes, order);
  Backdrop& backdrop = state.Backdrop;
  CompositeStatistics geometry;
  backdrop.SetCorner(this->View.Shown.Lo);
  this->TakeSurfaces(first, rect);
  backdrop.Read(*state.Communicator, this->Renderer, props, rect, state.RankOrderBehind, geometry);
  Collective(*state.Communicator, [&] { this->Surfaces.Place(this->View, rect, backdrop); });
  const std::vector<PixelRect> parts = this->PartsOf(rect);
  const bool isWhole = parts.size() == 1 && this->View.ShowsAll();
  std::set<VolumeFrame*> failed;
  double seconds = 0.0;
  for (const PixelRect& part : parts)
  {
    Pictures pictures = this->Cast(backdrop, part, isWhole, failed);
    if (failed.size() == frames.size())
    {
      return;
    }
    const Timer writing;
    if (this->HasSeveral() && state.Communicator->Rank() == 0)
    {
      pictures.front() = std::make_shared<const FloatImage>(BlendInDepth(pictures, order, part));
    }
    static const FloatImage none;
    backdrop.Write(
      *state.Communicator, this->Renderer, part, pictures.front() ? *pictures.front() : none);
    seconds += writing.Seconds();
  }
  if (!isWhole)
  {
    backdrop.Forget();
  }
  for (VolumeFrame* const frame : frames)
  {
    if (failed.count(frame) == 0)
    {
      frame->Finish(geometry, seconds / static_cast<double>(frames.size() - failed.size()));
    }
  }
}

/// Collective: finds what is drawn together, and says what is not in the order of depth.
/// @param volumes of the frames
void VolumesPicture::FindGroups(vtkBanyanVolumeMapper* first,
  const std::vector<VolumeFrame*>& frames, const std::vector<VolumeOnScreen>& volumes,
  const DepthOrder& order)
{
  Communicator& communicator = *first->State->Communicator;
  this->Mixed = GroupsOf(frames, order);
  std::vector<unsigned char> bits = FindNotInDepth(communicator, this->Renderer,
    CameraOf(this->Renderer, glm::dvec3(0.0)), volumes, order, this->Mixed);
  std::vector<int> mixing;
  std::vector<vtkVolume*> own;
  bool wanted = false;
  for (std::size_t i = 0; i < frames.size(); ++i)
  {
    own.push_back(frames[i]->Volume());
    if (CanMix(*frames[i]))
    {
      mixing.push_back(static_cast<int>(i));
      wanted = wanted || (bits[i] & NotInDepth::Surface) != 0;
    }
  }
  this->MixesSurfaces =
    wanted && AllMax(communicator, CanHideSurfaces(this->Renderer, own) ? 0.0 : 1.0) == 0.0;
  if (this->MixesSurfaces)
  {
    // Surfaces may be anywhere: what is before them, and what is behind, is mixed with them.
    const auto mixes = [&](const std::vector<int>& group)
    { return CanMix(*frames[static_cast<std::size_t>(group.front())]); };
    this->Mixed.erase(
      std::remove_if(this->Mixed.begin(), this->Mixed.end(), mixes), this->Mixed.end());
    this->Mixed.push_back(mixing);
    for (const int number : mixing)
    {
      unsigned char& its = bits[static_cast<std::size_t>(number)];
      its = static_cast<unsigned char>(its & ~NotInDepth::Surface);
    }
  }
  WarnNotInDepth(first, frames, bits);
}

/// Collective: takes translucent surfaces off the screen, if they are mixed.
void VolumesPicture::TakeSurfaces(vtkBanyanVolumeMapper* first, const PixelRect& rect)
{
  if (!this->MixesSurfaces)
  {
    return;
  }
  bool all = true;
  Collective(*first->State->Communicator,
    [&] { all = this->Surfaces.Take(this->Renderer, this->View, rect, this->CalledVolume); });
  const unsigned char bits = all ? 0 : NotInDepth::Layers;
  const std::string note = TellNotInDepth(NotToldYet(bits, first->State->ToldNotInDepth));
  if (!note.empty())
  {
    vtkWarningWithObjectMacro(first, << note); // on the rank that has the surface
  }
}

/// What is drawn at once of a rectangle. Somebody in front of a window gets a picture as a whole:
/// that is kept, and parts are not.
std::vector<PixelRect> VolumesPicture::PartsOf(const PixelRect& rect) const
{
  constexpr long long largest = 1LL << 23;
  constexpr long long atOnce = 1LL << 21;
  const auto isWatched = [this](const VolumeFrame& frame)
  { return frame.HasSpectator(this->Renderer, this->TogetherWith(frame)); };
  if (rect.Count() <= largest || std::any_of(this->Frames.begin(), this->Frames.end(), isWatched))
  {
    return { rect };
  }
  return InRows(rect, atOnce, TileSamplings::Edge); // a tile of samplings is in one part
}

/// One mapper may draw several volumes, each with a component of its own.
VolumeFrame::Together VolumesPicture::TogetherWith(const VolumeFrame& frame) const
{
  const auto same = [&](const VolumeFrame& other) { return other.Mapper() == frame.Mapper(); };
  return { static_cast<int>(this->Frames.size()),
    static_cast<int>(std::count_if(this->Frames.begin(), this->Frames.end(), same)) };
}

/// @param failed gets the frame if it cannot be drawn
bool VolumesPicture::Attempt(
  VolumeFrame& frame, const std::function<void()>& cast, std::set<VolumeFrame*>& failed) const
{
  const auto drawn = [&]
  {
    if (this->TogetherWith(frame).OfMapper > 1)
    {
      frame.Mapper()->UpdateField(frame.Volume());
    }
    cast();
    return true;
  };
  if (failed.count(&frame) == 0 && !frame.Mapper()->Attempt(drawn))
  {
    failed.insert(&frame);
  }
  return failed.count(&frame) == 0;
}

/// @param part of the picture
/// @param isWhole whether it is all of it
/// @param failed gets the frames that could not be drawn
/// @return pictures of the frames, on rank 0; of those that share space the first one has it
VolumesPicture::Pictures VolumesPicture::Cast(
  const Backdrop& backdrop, const PixelRect& part, bool isWhole, std::set<VolumeFrame*>& failed)
{
  Pictures pictures(this->Frames.size());
  for (const std::vector<int>& group : this->Mixed)
  {
    VolumeFrame& frame = this->FrameAt(group.front());
    std::shared_ptr<const FloatImage>& picture = pictures[static_cast<std::size_t>(group.front())];
    const auto cast = [&]
    {
      const VolumeFrame::Together together = this->TogetherWith(frame);
      picture = isWhole ? frame.Cast(this->Renderer, backdrop, together)
                        : frame.CastPart(this->Renderer, backdrop, together, part);
    };
    if (group.size() == 1 && !(this->MixesSurfaces && CanMix(frame)))
    {
      this->Attempt(frame, cast, failed);
    }
    else
    {
      picture = this->Mix(group, backdrop, part, failed);
    }
  }
  return pictures;
}

/// Collective: draws volumes that share space, with each other or with surfaces.
/// @return the picture, on rank 0
std::shared_ptr<const FloatImage> VolumesPicture::Mix(const std::vector<int>& group,
  const Backdrop& backdrop, const PixelRect& rect, std::set<VolumeFrame*>& failed)
{
  const Timer timer;
  VolumeFrame::Mixing took;
  took.Volumes = static_cast<int>(this->Frames.size());
  const bool hasSurfaces = this->MixesSurfaces && CanMix(this->FrameAt(group.front()));
  const std::size_t count = group.size() + (hasSurfaces ? 1 : 0);
  const auto castBlock = [&](std::size_t volume, const PixelRect& block, SegmentPicture& segments)
  {
    if (volume == group.size())
    {
      this->Surfaces.AddTo(segments, block);
      return LeastLight;
    }
    VolumeFrame& frame = this->FrameAt(group[volume]);
    float limit = 1.0f;
    const auto cast = [&]
    {
      limit =
        frame.CastSegments(this->Renderer, backdrop, this->TogetherWith(frame), block, segments);
    };
    if (!this->Attempt(frame, cast, failed))
    {
      segments.Take();
    }
    return limit;
  };
  std::shared_ptr<const FloatImage> picture = MixInBlocks(*this->Called->State->Communicator, count,
    rect, /*root=*/0, ThreadPool::Process(), castBlock, took.Sent);
  took.Seconds = timer.Seconds() / static_cast<double>(group.size());
  for (const int number : group)
  {
    VolumeFrame& frame = this->FrameAt(number);
    this->Attempt(
      frame, [&] { frame.SegmentsTook(this->Renderer, took, /*onWall=*/false); }, failed);
    took.Sent = {}; // the first one has them all
  }
  return picture;
}

} // namespace banyan
