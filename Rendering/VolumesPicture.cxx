// SPDX-License-Identifier: BSD-3-Clause
#include "VolumesPicture.h"

#include "RendererCamera.h"
#include "VolumesInDepth.h"
#include "vtkBanyanVolumeMapper.h"

#include "Base/Progress.h"
#include "Base/Timer.h"

#include "vtkCollection.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkSetGet.h"
#include "vtkVolume.h"

#include <algorithm>
#include <iterator>

namespace banyan
{

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

void VolumesPicture::WarnNotInDepth(vtkBanyanVolumeMapper* first, vtkRenderer* renderer,
  const std::vector<VolumeFrame*>& frames, const std::vector<VolumeOnScreen>& volumes,
  const DepthOrder& order)
{
  Communicator& communicator = *first->State->Communicator;
  const std::vector<unsigned char> bits = FindNotInDepth(communicator, renderer, volumes, order);
  unsigned char fresh = 0;
  for (std::size_t i = 0; i < frames.size(); ++i)
  {
    fresh |= NotToldYet(bits[i], frames[i]->Mapper()->State->ToldNotInDepth);
  }
  const std::string note = TellNotInDepth(fresh);
  if (!note.empty() && communicator.Rank() == 0)
  {
    vtkWarningWithObjectMacro(first, << note);
  }
}

VolumesPicture::VolumesPicture(
  vtkRenderer* renderer, vtkBanyanVolumeMapper* mapper, vtkVolume* volume)
  : Renderer(renderer)
  , Called(mapper)
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
  const auto shows = [this](VolumeFrame& frame)
  {
    return frame.Mapper()->Attempt(
      [&]
      {
        frame.Mapper()->UpdateField(frame.Volume());
        return frame.Prepare(ViewOf(this->Renderer));
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
  const std::vector<VolumeOnScreen> volumes = OnScreen(frames);
  const DepthOrder order = OrderInDepth(volumes, ViewOf(this->Renderer));
  WarnNotInDepth(first, this->Renderer, frames, volumes, order);
  CompositeStatistics geometry;
  state.Backdrop.Read(
    *state.Communicator, this->Renderer, props, rect, state.RankOrderBehind, geometry);
  Pictures pictures(this->Frames.size());
  const std::vector<VolumeFrame*> drawn = this->Cast(state.Backdrop, pictures);
  if (drawn.empty())
  {
    return;
  }
  const Timer writing;
  if (this->HasSeveral() && state.Communicator->Rank() == 0)
  {
    pictures.front() = std::make_shared<const FloatImage>(BlendInDepth(pictures, order, rect));
  }
  static const FloatImage none;
  state.Backdrop.Write(
    *state.Communicator, this->Renderer, pictures.front() ? *pictures.front() : none);
  const double seconds = writing.Seconds() / static_cast<double>(drawn.size());
  for (VolumeFrame* const frame : drawn)
  {
    frame->Finish(geometry, seconds);
  }
}

/// @param pictures of the frames, on rank 0
/// @return frames that could be drawn
std::vector<VolumeFrame*> VolumesPicture::Cast(const Backdrop& backdrop, Pictures& pictures)
{
  std::vector<VolumeFrame*> drawn;
  for (std::size_t i = 0; i < this->Frames.size(); ++i)
  {
    VolumeFrame& frame = this->Frames[i];
    const auto cast = [&]
    {
      // One mapper may draw several volumes, each with a component of its own.
      const auto same = [&](const VolumeFrame& other) { return other.Mapper() == frame.Mapper(); };
      const VolumeFrame::Together together{ static_cast<int>(this->Frames.size()),
        static_cast<int>(std::count_if(this->Frames.begin(), this->Frames.end(), same)) };
      if (together.OfMapper > 1)
      {
        frame.Mapper()->UpdateField(frame.Volume());
      }
      pictures[i] = frame.Cast(this->Renderer, backdrop, together);
      return true;
    };
    if (frame.Mapper()->Attempt(cast))
    {
      drawn.push_back(&frame);
    }
  }
  return drawn;
}

} // namespace banyan
