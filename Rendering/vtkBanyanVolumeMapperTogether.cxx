// SPDX-License-Identifier: BSD-3-Clause
// Work of a mapper together with other ranks, and with the other volumes of a picture.

#include "CommunicatorOf.h"
#include "RendererCamera.h"
#include "VolumeMapperInternals.h"
#include "VolumesInDepth.h"
#include "vtkBanyanVolumeMapper.h"

#include "Base/Progress.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"

#include "vtkCollection.h"
#include "vtkCommand.h"
#include "vtkMultiProcessController.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>

void vtkBanyanVolumeMapper::SetController(vtkMultiProcessController* controller)
{
  if (this->Controller == controller)
  {
    return;
  }
  this->Controller = controller;
  this->Self->Field.Reset();
  banyan::MpiTimeout timeout{ banyan::MpiTimeout::DefaultSeconds, {} };
  try
  {
    timeout.Seconds = banyan::MpiTimeout::FromEnvironment();
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< error.what());
  }
  timeout.Tell = [this](const std::string& sentence) { vtkErrorMacro(<< sentence); };
  this->Self->Communicator = banyan::CommunicatorOf(controller, timeout);
  if (this->Self->Communicator->Size() > 1)
  {
    banyan::ThreadPool::SetRanksOnThisNode(this->Self->Communicator->RanksOnThisNode());
  }
  this->Modified();
}

void vtkBanyanVolumeMapper::Render(vtkRenderer* renderer, vtkVolume* volume)
{
  if (renderer->GetSelector() || this->Self->DrawnByOthers.erase(volume) > 0)
  {
    return;
  }
  // Pictures of volumes are blended by depth, and the background is behind all of them: the first
  // one that is called draws all.
  std::vector<Frame> frames;
  for (vtkVolume* const shown : banyan::VolumesDrawnWith(renderer, volume))
  {
    auto* const mapper =
      shown == volume ? this : vtkBanyanVolumeMapper::SafeDownCast(shown->GetMapper());
    frames.emplace_back();
    frames.back().Mapper = mapper;
    frames.back().Volume = shown;
    if (shown != volume)
    {
      mapper->Self->DrawnByOthers.insert(shown);
    }
  }
  if (frames.size() > 1 && this->Self->FrameEnds == 0)
  {
    this->Self->FrameEnds =
      renderer->AddObserver(vtkCommand::EndEvent, this, &vtkBanyanVolumeMapper::EndFrame);
  }
  this->DrawTogether(renderer, frames);
}

/// Volumes that were not called, as they are off the screen, are to be drawn in the next frame.
void vtkBanyanVolumeMapper::EndFrame(vtkObject* caller, unsigned long, void*)
{
  auto* const renderer = vtkRenderer::SafeDownCast(caller);
  renderer->RemoveObserver(this->Self->FrameEnds);
  this->Self->FrameEnds = 0;
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
      mapper->Self->DrawnByOthers.erase(volume);
    }
  }
}

bool vtkBanyanVolumeMapper::Attempt(const std::function<bool()>& work)
{
  try
  {
    return work();
  }
  catch (const std::exception& error)
  {
    this->ReportOnce(error.what());
    this->Self->Communicator->LeaveTogether(error.what());
  }
  return false;
}

/// Says what is not drawn in the order of depth, once. Collective.
void vtkBanyanVolumeMapper::TellNotInDepth(vtkRenderer* renderer, const std::vector<Frame>& frames,
  const std::vector<banyan::VolumeOnScreen>& volumes, const banyan::DepthOrder& order)
{
  const std::vector<unsigned char> bits =
    banyan::FindNotInDepth(*this->Self->Communicator, renderer, volumes, order);
  unsigned char fresh = 0;
  for (std::size_t i = 0; i < frames.size(); ++i)
  {
    unsigned char& told = frames[i].Mapper->Self->ToldNotInDepth;
    fresh = static_cast<unsigned char>(fresh | (bits[i] & ~told));
    told = static_cast<unsigned char>(told | bits[i]);
  }
  const std::string note = banyan::TellNotInDepth(fresh);
  if (!note.empty() && this->Self->Communicator->Rank() == 0)
  {
    vtkWarningMacro(<< note);
  }
}

/// All volumes of a picture, in the order of the renderer's list: the same calls on all ranks.
void vtkBanyanVolumeMapper::DrawTogether(vtkRenderer* renderer, std::vector<Frame>& frames)
{
  const auto shows = [renderer](Frame& frame)
  {
    return frame.Mapper->Attempt(
      [&]
      {
        frame.Mapper->UpdateField(frame.Volume);
        frame.Began = banyan::Timer();
        return frame.Mapper->PrepareFrame(renderer, frame);
      });
  };
  frames.erase(
    std::remove_if(frames.begin(), frames.end(), [&](Frame& frame) { return !shows(frame); }),
    frames.end());
  if (!frames.empty())
  {
    vtkBanyanVolumeMapper* const first = frames.front().Mapper;
    first->Self->RankOrderBehind = this->Self->RankOrderBehind;
    first->Attempt(
      [&]
      {
        first->DrawPrepared(renderer, frames);
        return true;
      });
  }
}

/// Called for the first mapper that shows something, which is the same one on all ranks.
void vtkBanyanVolumeMapper::DrawPrepared(vtkRenderer* renderer, std::vector<Frame>& frames)
{
  const banyan::PhaseScope beginning(banyan::Phase::Beginning);
  Internals& self = *this->Self;
  std::vector<vtkVolume*> props;
  std::vector<banyan::VolumeOnScreen> volumes;
  std::vector<banyan::PlacedBody> bodies;
  banyan::PixelRect rect;
  for (const Frame& frame : frames)
  {
    const banyan::RayScene& scene = frame.Wanted->Scene;
    props.push_back(frame.Volume);
    bodies.push_back(banyan::BodyOf(frame.Volume, frame.Mapper, frame.Mapper->Self->Field, scene));
    volumes.push_back({ bodies.back(), scene.Viewport });
    rect = Union(rect, scene.Viewport);
  }
  const banyan::DepthOrder order(bodies, banyan::CameraOf(renderer, glm::dvec3(0.0)));
  this->TellNotInDepth(renderer, frames, volumes, order);
  banyan::CompositeStatistics geometry;
  self.Backdrop.Read(*self.Communicator, renderer, props, rect, self.RankOrderBehind, geometry);

  std::vector<banyan::FloatImage> pictures(frames.size());
  std::vector<const Frame*> drawn;
  for (std::size_t i = 0; i < frames.size(); ++i)
  {
    const auto cast = [&]
    {
      // One mapper may draw several volumes, each with a component of its own.
      const auto same = [&](const Frame& frame) { return frame.Mapper == frames[i].Mapper; };
      if (std::count_if(frames.begin(), frames.end(), same) > 1)
      {
        frames[i].Mapper->UpdateField(frames[i].Volume);
      }
      pictures[i] = frames[i].Mapper->CastFrame(
        renderer, self.Backdrop, static_cast<int>(frames.size()), frames[i]);
      return true;
    };
    if (frames[i].Mapper->Attempt(cast))
    {
      drawn.push_back(&frames[i]);
    }
  }
  if (drawn.empty())
  {
    return;
  }
  const banyan::Timer writing;
  if (frames.size() > 1 && self.Communicator->Rank() == 0)
  {
    pictures.front() = banyan::BlendInDepth(pictures, order, rect);
  }
  self.Backdrop.Write(*self.Communicator, renderer, pictures.front());
  const double seconds = writing.Seconds() / static_cast<double>(drawn.size());
  for (const Frame* frame : drawn)
  {
    frame->Mapper->FinishFrame(*frame, geometry, seconds);
  }
}
