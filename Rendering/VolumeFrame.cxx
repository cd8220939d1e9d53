// SPDX-License-Identifier: BSD-3-Clause
#include "VolumeFrame.h"

#include "FrameScene.h"
#include "SceneOptions.h"
#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanVolumeMapper.h"

#include "Base/Progress.h"
#include "Parallel/Communicate/Collective.h"

#include "Render/Raycast/SegmentsToWorld.h"
#include "Render/Scene/DepthPicture.h"

#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace banyan
{
namespace
{

/// A part of a volume's size that nobody can see.
constexpr double LeastRange = 1e-12;

} // namespace

bool VolumeFrame::Prepare(const ScreenView& view)
{
  const PhaseScope beginning(Phase::Beginning);
  this->Began = this->PicturesDrawn == 0 ? Timer() : this->Began;
  const DistributedField& field = this->State->Field;
  if (!field.Problem().empty())
  {
    throw Error(field.Problem());
  }
  // VTK's clipping range has no length where the eye is on a face and looks away.
  if (field.Empty() || view.Far < LeastRange * this->Prop->GetLength())
  {
    return false;
  }
  const double distance = this->Owner->GetSampleDistanceVoxels();
  Collective(*this->State->Communicator,
    [&]
    {
      this->Wanted.emplace(MakeFrameScene(view, this->Prop, this->Owner, field,
        distance > 0.0 ? distance : 1.0, this->State->Function));
    });
  return !this->Wanted->Viewport.Empty();
}

FieldFrames::Wish VolumeFrame::WishFor(bool interacting, int eye, int volumes) const
{
  vtkBanyanVolumeMapper* const mapper = this->Owner;
  FieldFrames::Wish wish;
  ToleranceControl::Wish& sampling = wish.Sampling;
  sampling.Still = mapper->GetImageErrorTolerance();
  sampling.Interactive = mapper->GetInteractiveImageErrorTolerance();
  // Volumes that are drawn one after the other share the time of a frame.
  sampling.Seconds = mapper->GetInteractiveFrameSeconds() / volumes;
  sampling.Interacting = interacting;
  sampling.MaxElementsPerPixel = mapper->GetMaxElementsPerPixel();
  sampling.ScreenErrorPixels = mapper->GetScreenErrorPixels();
  sampling.FixedDistance = mapper->GetSampleDistanceVoxels() > 0.0;
  sampling.KeepsTolerance =
    CanKeepTolerance(mapper, this->Prop->GetProperty(), this->State->Field.DrawsColours()) &&
    (!sampling.FixedDistance || sampling.ScreenErrorPixels > 0.0);
  sampling.Eye = eye;
  // Errors of few bits add up where volumes are blended over each other.
  const bool few = mapper->GetCompositeInFewBits() && volumes == 1;
  wish.Transport = few ? PixelTransport::WithinOne : PixelTransport::Floats;
  wish.ReadAhead = mapper->GetReadAhead();
  wish.Divides = static_cast<FieldFrames::Division>(mapper->GetDivision());
  wish.Reuse = sampling.PlansOfGroups = mapper->GetReuseFrames();
  // About what it took the last time, for all of them.
  wish.ShowSeconds = this->State->WriteSeconds / volumes;
  return wish;
}

/// Whether the picture may be drawn while somebody goes on in front of the window.
bool VolumeFrame::MayBeLate(vtkRenderer* renderer, const Together& others) const
{
  // A window that does not swap its buffers is one that somebody wants to save. A volume in two
  // renderers would begin the one picture and the other in turns, and so would two of one mapper.
  vtkRenderWindow* const window = renderer->GetRenderWindow();
  const vtkRenderer* const last = this->State->LastRenderer;
  return (!last || last == renderer) && others.OfMapper == 1 && this->Owner->GetDecoupled() &&
         this->State->Communicator->Size() == 1 && window->GetStereoRender() == 0 &&
         window->GetSwapBuffers() != 0 && RenderWhenDrawn::CanWatch(window);
}

/// Whether ParaView's picture on ranks of a server may become exact later: the client asks for it.
bool VolumeFrame::MayBeLateForClient(const Together& others) const
{
  return this->State->ServesWindow && others.OfMapper == 1 && this->Owner->GetDecoupled();
}

/// Nothing of this picture comes later.
void VolumeFrame::DrawsAtOnce(bool exact)
{
  this->State->ShowsCoarse = false;
  this->Owner->GetStatistics()->SetPictureIsExact(exact ? 1 : 0);
  this->State->Served.Stop();
  if (!this->Owner->GetDecoupled())
  {
    this->State->Late.Stop();
    this->State->Again.Stop();
  }
}

FieldFrames::Frame VolumeFrame::Draw(
  vtkRenderer* renderer, const FieldFrames::Wish& wish, const Together& others)
{
  MapperState& state = *this->State;
  Communicator& communicator = *state.Communicator;
  vtkBanyanFrameStatistics* const out = this->Owner->GetStatistics();
  const bool late = this->MayBeLate(renderer, others);
  state.LastRenderer = renderer;
  if (this->MayBeLateForClient(others))
  {
    const RayScene& scene = *this->Wanted;
    if (wish.Sampling.Interacting)
    {
      state.Served.DrawCoarse(communicator, state.Field, scene, wish);
    }
    else
    {
      state.Served.Draw(communicator, state.Field, scene, scene, wish, /*shows=*/true);
    }
    out->SetPictureIsExact(state.Served.Last().Exact ? 1 : 0);
    return state.Served.Last().Frame;
  }
  if (!late)
  {
    state.Late.Settle(state.Field, *this->Wanted, wish);
    this->DrawsAtOnce(!wish.Sampling.Interacting);
    return state.Frames.Draw(communicator, state.Field, *this->Wanted, wish);
  }
  LateFrames::Shown shown = state.Late.Draw(
    communicator, state.Field, *this->Wanted, wish, LateFrames::CoarseSeconds / others.Volumes);
  state.ShowsCoarse = !shown.Exact;
  out->SetPictureIsExact(shown.Exact ? 1 : 0);
  if (shown.Exact)
  {
    state.Again.Stop(); // nothing is still to come
  }
  else
  {
    state.Again.Watch(renderer->GetRenderWindow(), [&state] { return state.Late.GoOn(); });
  }
  return std::move(shown.Frame);
}

std::shared_ptr<const FloatImage> VolumeFrame::CastOnWall(
  vtkRenderer* renderer, const OnWall& wall, const DepthPicture& depths, int volumes)
{
  MapperState& state = *this->State;
  this->BeginOnWall(renderer, wall);
  this->Wanted->Depth = depths.In(this->Wanted->Viewport);
  FieldFrames::Wish wish = this->WishFor(IsInteracting(renderer), EyeOf(renderer), volumes);
  wish.Sampling.Seconds /= static_cast<double>(wall.Pictures);
  for (PicturePlace place : wall.Places)
  {
    place.Behind = Intersection(depths.Rect, place.Rect);
    wish.Places.push_back(place);
  }
  FieldFrames::Frame frame =
    state.WallFrames[wall.Number]->Draw(*state.Communicator, state.Field, *this->Wanted, wish);
  this->TellMore(frame);
  return frame.Picture.Pixels;
}

void VolumeFrame::BeginOnWall(vtkRenderer* renderer, const OnWall& wall)
{
  while (this->State->WallFrames.size() <= wall.Number)
  {
    this->State->WallFrames.push_back(std::make_unique<FieldFrames>());
  }
  this->State->Late.Stop();
  this->DrawsAtOnce(!IsInteracting(renderer));
  if (this->PicturesDrawn == 0)
  {
    this->BeginFigures();
  }
}

bool VolumeFrame::HasSpectator(vtkRenderer* renderer, const Together& others) const
{
  return IsInteracting(renderer) || this->MayBeLate(renderer, others) ||
         this->MayBeLateForClient(others);
}

std::shared_ptr<const FloatImage> VolumeFrame::CastPart(
  vtkRenderer* renderer, const Backdrop& backdrop, const Together& others, const PixelRect& part)
{
  MapperState& state = *this->State;
  this->BeginParts(renderer, backdrop);
  const PixelRect whole = this->Wanted->Viewport;
  const PixelRect own = Intersection(whole, part);
  if (own.Empty())
  {
    return nullptr;
  }
  // Pixels without rays are made from those around them.
  RayScene scene = *this->Wanted;
  scene.Viewport = Intersection(
    whole, { own.Lo - RaySampling::LargestStride, own.Hi + RaySampling::LargestStride });
  scene.Depth = backdrop.Depths(scene.Viewport);
  FieldFrames::Wish wish = this->WishFor(IsInteracting(renderer), EyeOf(renderer), others.Volumes);
  wish.Whole = whole;
  wish.Places = { { own, 0, Intersection(backdrop.Behind(), own) } };
  const FieldFrames::Frame frame = state.Frames.Draw(*state.Communicator, state.Field, scene, wish);
  this->TellMore(frame);
  return frame.Picture.Pixels;
}

float VolumeFrame::CastSegments(vtkRenderer* renderer, const Backdrop& backdrop,
  const Together& others, const PixelRect& part, SegmentPicture& segments)
{
  MapperState& state = *this->State;
  if (this->PicturesDrawn == 0)
  {
    state.Late.Stop();
    state.Again.Stop();
  }
  this->BeginParts(renderer, backdrop);
  RayScene scene = *this->Wanted;
  scene.Viewport = Intersection(scene.Viewport, part);
  scene.Depth = backdrop.Depths(scene.Viewport);
  return this->TakeSegments(state.Frames, scene,
    this->WishFor(IsInteracting(renderer), EyeOf(renderer), others.Volumes), segments);
}

float VolumeFrame::CastSegmentsOnWall(vtkRenderer* renderer, const OnWall& wall,
  const DepthPicture& depths, int volumes, const PixelRect& part, SegmentPicture& segments)
{
  this->BeginOnWall(renderer, wall);
  RayScene scene = *this->Wanted;
  scene.Viewport = Intersection(scene.Viewport, part);
  scene.Depth = depths.In(scene.Viewport);
  return this->TakeSegments(*this->State->WallFrames[wall.Number], scene,
    this->WishFor(IsInteracting(renderer), EyeOf(renderer), volumes), segments);
}

/// @param scene of the part
float VolumeFrame::TakeSegments(
  FieldFrames& frames, RayScene& scene, FieldFrames::Wish wish, SegmentPicture& segments)
{
  if (scene.Viewport.Empty())
  {
    return 1.0f;
  }
  wish.Whole = this->Wanted->Viewport;
  wish.Places = { { scene.Viewport, 0, {} } };
  wish.Reuse = false;
  wish.Segments = &segments;
  this->TellMore(frames.Draw(*this->State->Communicator, this->State->Field, scene, wish));
  std::vector<TileSegments> tiles = segments.Take();
  SegmentsToWorld(tiles, scene.Camera, ToGlm(this->Prop->GetMatrix()));
  for (TileSegments& tile : tiles)
  {
    segments.Add(std::move(tile));
  }
  return 1.0f - scene.OpacityLimit;
}

void VolumeFrame::SegmentsTook(vtkRenderer* renderer, const Mixing& mixing, bool onWall)
{
  Communicator& communicator = *this->State->Communicator;
  FieldFrames& frames = onWall ? *this->State->WallFrames.at(mixing.Picture) : this->State->Frames;
  frames.FrameTook(communicator,
    this->WishFor(IsInteracting(renderer), EyeOf(renderer), mixing.Volumes), mixing.Seconds);
  const auto sumOf = [&](std::uint64_t mine)
  { return static_cast<std::uint64_t>(AllSum(communicator, static_cast<double>(mine))); };
  this->Statistics.BytesComposited += sumOf(mixing.Sent.Bytes);
  this->Statistics.MessagesComposited += sumOf(mixing.Sent.Messages);
}

/// Of a picture that is drawn part by part: nothing of it comes later.
void VolumeFrame::BeginParts(vtkRenderer* renderer, const Backdrop& backdrop)
{
  if (this->PicturesDrawn == 0)
  {
    this->BeginFigures();
    LateFrames::PauseAll();
    this->State->LastRenderer = renderer;
    this->DrawsAtOnce(!IsInteracting(renderer));
  }
  this->Owner->GetStatistics()->SetPixelsReadBehind(static_cast<vtkIdType>(backdrop.PixelsRead()));
}

/// Adds what a picture took to what those before it took.
void VolumeFrame::TellMore(FieldFrames::Frame frame)
{
  if (this->PicturesDrawn++ > 0)
  {
    frame.Picture.Statistics.Add(this->Statistics);
    frame.Picture.EstimatedError = std::max(frame.Picture.EstimatedError, this->WorstError);
    frame.Kept = frame.Kept && this->Kept;
  }
  this->WorstError = frame.Picture.EstimatedError;
  this->Figures.Add(this->State->Field.Drawn(), frame.Kept);
  this->Tell(frame);
}

void VolumeFrame::ForgetPictures(std::size_t pictures)
{
  while (this->State->WallFrames.size() > pictures)
  {
    this->State->WallFrames.pop_back();
  }
}

std::shared_ptr<const FloatImage> VolumeFrame::Cast(
  vtkRenderer* renderer, const Backdrop& backdrop, const Together& others)
{
  RayScene& scene = *this->Wanted;
  scene.Depth = backdrop.Depths(scene.Viewport);
  this->BeginFigures();
  FieldFrames::Wish wish = this->WishFor(IsInteracting(renderer), EyeOf(renderer), others.Volumes);
  wish.Behind = backdrop.Behind();
  const FieldFrames::Frame frame = this->Draw(renderer, wish, others);
  this->Tell(frame);
  this->Owner->GetStatistics()->SetPixelsReadBehind(static_cast<vtkIdType>(backdrop.PixelsRead()));
  return frame.Picture.Pixels;
}

void VolumeFrame::BeginFigures()
{
  this->Figures = FrameFigures(this->State->Field.Drawn());
}

void VolumeFrame::Tell(const FieldFrames::Frame& frame)
{
  DistributedField& field = this->State->Field;
  this->Statistics = frame.Picture.Statistics;
  this->Kept = frame.Kept;
  vtkBanyanFrameStatistics* const out = this->Owner->GetStatistics();
  out->SetReusedFraction(frame.ReusedFraction());
  std::uint64_t kept = this->State->Frames.PictureBytes();
  for (const std::unique_ptr<FieldFrames>& ofWall : this->State->WallFrames)
  {
    kept += ofWall->PictureBytes();
  }
  out->SetPictureBytes(static_cast<vtkIdType>(kept));
  out->SetEstimatedImageError(frame.Picture.EstimatedError);
  out->SetImageErrorLimit(frame.Picture.Limit.c_str());
  out->SetEncodingErrorOfValues(
    field.Drawn().IsMesh() ? std::numeric_limits<double>::quiet_NaN() : field.EncodingError());
}

void VolumeFrame::Finish(const CompositeStatistics& geometry, double writeSeconds)
{
  if (this->PicturesDrawn == 0) // parts say nothing of a picture that is shown at once
  {
    this->State->WriteSeconds = writeSeconds;
    this->Figures.Add(this->State->Field.Drawn(), this->Kept);
  }
  this->State->LastProblem.clear();
  vtkBanyanFrameStatistics* const out = this->Owner->GetStatistics();
  out->SetTotalSeconds(this->Began.Seconds());
  if (this->State->Late.IsDrawing() || this->State->Served.IsDrawing())
  {
    // What the thread does counts with the exact picture.
    FrameFigures::PublishFrame(this->Statistics, geometry.BytesSent, out);
    return;
  }
  this->Figures.Publish(*this->State->Communicator, this->State->Field.Drawn(), this->Statistics,
    geometry.BytesSent, out);
}

} // namespace banyan
