// SPDX-License-Identifier: BSD-3-Clause
#include "VolumeFrame.h"

#include "FrameScene.h"
#include "RendererCamera.h"
#include "SceneOptions.h"
#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanVolumeMapper.h"

#include "Base/Progress.h"
#include "Base/ThreadPool.h"
#include "Parallel/Communicate/Collective.h"

#include "vtkCamera.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"

#include <limits>

namespace banyan
{
namespace
{

/// A part of a volume's size that nobody can see.
constexpr double LeastRange = 1e-12;

} // namespace

bool VolumeFrame::Prepare(vtkRenderer* renderer)
{
  const PhaseScope beginning(Phase::Beginning);
  this->Began = Timer();
  const DistributedField& field = this->State->Field;
  if (!field.Problem().empty())
  {
    throw Error(field.Problem());
  }
  // VTK's clipping range has no length where the eye is on a face and looks away.
  const double far = renderer->GetActiveCamera()->GetClippingRange()[1];
  if (field.Empty() || far < LeastRange * this->Prop->GetLength())
  {
    return false;
  }
  const double distance = this->Owner->GetSampleDistanceVoxels();
  Collective(*this->State->Communicator,
    [&]
    {
      this->Wanted.emplace(MakeFrameScene(renderer, this->Prop, this->Owner, field,
        distance > 0.0 ? distance : 1.0, this->State->Function));
    });
  return !this->Wanted->Viewport.Empty();
}

ToleranceControl::Wish VolumeFrame::WishFor(vtkRenderer* renderer, int volumes) const
{
  vtkBanyanVolumeMapper* const mapper = this->Owner;
  ToleranceControl::Wish wish;
  wish.Still = mapper->GetImageErrorTolerance();
  wish.Interactive = mapper->GetInteractiveImageErrorTolerance();
  // Volumes that are drawn one after the other share the time of a frame.
  wish.Seconds = mapper->GetInteractiveFrameSeconds() / volumes;
  // More than one frame per second: somebody moves the camera. All ranks are told the same rate.
  wish.Interacting = renderer->GetRenderWindow()->GetDesiredUpdateRate() > 1.0;
  wish.Passes = mapper->GetRefineInPasses();
  wish.MaxElementsPerPixel = mapper->GetMaxElementsPerPixel();
  wish.ScreenErrorPixels = mapper->GetScreenErrorPixels();
  wish.FixedDistance = mapper->GetSampleDistanceVoxels() > 0.0;
  wish.KeepsTolerance = CanKeepTolerance(mapper, this->Prop->GetProperty()) &&
                        (!wish.FixedDistance || wish.ScreenErrorPixels > 0.0);
  wish.Eye = EyeOf(renderer);
  return wish;
}

void VolumeFrame::PlanSampling(std::uint64_t budgetBytes)
{
  vtkBanyanFrameStatistics* const out = this->Owner->GetStatistics();
  DistributedField& field = this->State->Field;
  ToleranceControl& tolerance = this->State->Tolerance;
  out->SetEstimatedImageError(tolerance.Plan(
    *this->State->Communicator, field, *this->Wanted, this->Wish, budgetBytes, this->Statistics));
  out->SetImageErrorLimit(tolerance.Limit().c_str());
  out->SetEncodingErrorOfValues(
    field.Drawn().IsMesh() ? std::numeric_limits<double>::quiet_NaN() : field.EncodingError());
  out->SetMeshDeviation(field.Drawn().Deviation());
}

CompositeOptions VolumeFrame::Compositing(const Backdrop& backdrop, int volumes)
{
  CompositeOptions compositing;
  compositing.Behind = backdrop.Behind();
  // Errors of few bits add up where volumes are blended over each other.
  compositing.Transport = this->Owner->GetCompositeInFewBits() && volumes == 1
                            ? PixelTransport::WithinOne
                            : PixelTransport::Floats;
  compositing.Plans = &this->State->Plans;
  // The other eye's picture is no step of a camera that moves.
  if (this->Owner->GetReadAhead() && this->Wish.Eye == 0)
  {
    compositing.AfterCasting = [this]
    { this->State->Field.Drawn().ReadAhead(*this->Wanted, this->State->Communicator->Rank()); };
  }
  return compositing;
}

FloatImage VolumeFrame::Cast(vtkRenderer* renderer, const Backdrop& backdrop, int volumes)
{
  Communicator& communicator = *this->State->Communicator;
  DistributedField& field = this->State->Field;
  DrawnField& drawn = field.Drawn();
  RayScene& scene = *this->Wanted;
  scene.Depth = backdrop.Depths(scene.Viewport);
  this->Owner->GetStatistics()->SetPixelsReadBehind(static_cast<vtkIdType>(backdrop.PixelsRead()));
  this->Figures = FrameFigures(drawn);
  this->Wish = this->WishFor(renderer, volumes);
  const Timer drawing;
  {
    const PhaseScope fetching(Phase::Fetching);
    drawn.BeginFrame(communicator, scene);
  }
  const std::uint64_t budget = field.DrawingBudget();
  const PhaseScope sampling(Phase::Sampling);
  this->PlanSampling(budget);
  const FrameStatistics probes = this->Statistics;
  FloatImage picture = DrawDistributed(communicator, scene,
    { drawn.Source(), drawn.Zones(), budget, ThreadPool::Process() }, this->Statistics,
    this->Compositing(backdrop, volumes));
  this->Statistics.SamplesTaken += probes.SamplesTaken;
  this->Statistics.BytesComposited += probes.BytesComposited;
  this->Statistics.MessagesComposited += probes.MessagesComposited;
  const PhaseScope balancing(Phase::Balancing);
  drawn.EndFrame(communicator);
  // Putting the picture on the screen takes about what it took the last time.
  this->State->Tolerance.FrameTook(
    this->Wish, AllMax(communicator, drawing.Seconds() + this->State->WriteSeconds));
  return picture;
}

void VolumeFrame::Finish(const CompositeStatistics& geometry, double writeSeconds)
{
  this->State->WriteSeconds = writeSeconds;
  this->State->LastProblem.clear();
  vtkBanyanFrameStatistics* const out = this->Owner->GetStatistics();
  out->SetTotalSeconds(this->Began.Seconds());
  this->Figures.Publish(*this->State->Communicator, this->State->Field.Drawn(), this->Statistics,
    geometry.BytesSent, out);
}

} // namespace banyan
