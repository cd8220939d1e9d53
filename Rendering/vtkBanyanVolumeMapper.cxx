// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanVolumeMapper.h"

#include "FrameScene.h"
#include "IgnoredOptions.h"
#include "PieceOfInput.h"
#include "RendererCamera.h"
#include "SceneOptions.h"
#include "SetNumber.h"
#include "VolumeMapperInternals.h"
#include "vtkBanyanFrameStatistics.h"

#include "Base/Progress.h"
#include "Base/ThreadPool.h"
#include "Base/Timer.h"
#include "Parallel/Frame/DistributedFrame.h"

#include "vtkAlgorithm.h"
#include "vtkCamera.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <limits>

namespace
{

/// A part of a volume's size that nobody can see.
constexpr double LeastRange = 1e-12;

} // namespace

vtkStandardNewMacro(vtkBanyanVolumeMapper);

#define BANYAN_REAL(Name, Unit, Default, Least, Most, ...)                                         \
  banyanSetNumberMacro(vtkBanyanVolumeMapper, Name, Least, Most);
#define BANYAN_NONE(...)
BANYAN_VOLUME_SETTINGS(BANYAN_REAL, BANYAN_NONE, BANYAN_NONE, BANYAN_NONE)
#undef BANYAN_REAL
#undef BANYAN_NONE

vtkBanyanVolumeMapper::vtkBanyanVolumeMapper()
  : Statistics(vtkSmartPointer<vtkBanyanFrameStatistics>::New())
  , Self(std::make_unique<Internals>())
{
  this->Self->Communicator = banyan::MakeSelfCommunicator();
}

vtkBanyanVolumeMapper::~vtkBanyanVolumeMapper() = default;

int vtkBanyanVolumeMapper::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkHyperTreeGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkOverlappingAMR");
  // A rank without data takes part in drawing all the same.
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

vtkMultiProcessController* vtkBanyanVolumeMapper::GetController()
{
  return this->Controller;
}

void vtkBanyanVolumeMapper::SetStatistics(vtkBanyanFrameStatistics* statistics)
{
  this->Statistics =
    statistics ? statistics : vtkSmartPointer<vtkBanyanFrameStatistics>::New().GetPointer();
}

vtkBanyanFrameStatistics* vtkBanyanVolumeMapper::GetStatistics()
{
  return this->Statistics;
}

void vtkBanyanVolumeMapper::SetRankOrderBehind(const std::vector<int>& frontToBack)
{
  this->Self->RankOrderBehind = frontToBack;
}

vtkDataArray* vtkBanyanVolumeMapper::GetArrayToDraw(vtkDataObject* data)
{
  return banyan::ArrayToDraw(this, data).Array;
}

void vtkBanyanVolumeMapper::UpdateField(vtkVolume* volume)
{
  if (this->GetNumberOfInputConnections(0) > 0)
  {
    this->GetInputAlgorithm()->Update();
  }
  Internals& self = *this->Self;
  self.Field.SetLoadBalancing(
    this->LoadBalancing == 0 ? banyan::LoadBalancing::Off : banyan::LoadBalancing::MeasuredCost);
  banyan::FieldPiece piece;
  try
  {
    banyan::ThreadPool::SetProcessWidth(this->NumberOfThreads);
    piece = banyan::PieceOfInput(this, volume->GetProperty());
  }
  catch (const std::exception& error)
  {
    piece = banyan::FieldPiece();
    piece.Problem = error.what();
  }
  self.Motion.Apply(*self.Communicator, this->TemporalEnhancement, volume->GetProperty(),
    this->GetDataObjectInput(), piece);
  self.Field.Update(*self.Communicator, piece);
  self.Bounds = self.Field.Bounds();
  self.BoundsOf = this->GetDataObjectInput();
  self.BoundsTime = self.BoundsOf ? self.BoundsOf->GetMTime() : 0;
  self.BoundsKnown = true;
  this->WarnOnce(self.Motion.Note() + self.Field.MeshNote(), self.LastNote);
  const int components = piece.Array ? piece.Array->GetNumberOfComponents() : 1;
  this->WarnOnce(banyan::IgnoredOptions(this, volume->GetProperty(), components), self.LastIgnored);
  if (self.Field.Empty())
  {
    // Nothing with bounds is there to be rendered, so this may be the only place to say why.
    const std::string problem = banyan::AgreeOnError(*self.Communicator, self.Field.Problem());
    if (!problem.empty())
    {
      this->ReportOnce(problem);
    }
  }
}

double* vtkBanyanVolumeMapper::GetBounds()
{
  const Internals& self = *this->Self;
  const bool alone = self.Communicator->Size() == 1;
  if (alone && this->GetNumberOfInputConnections(0) > 0)
  {
    this->GetInputAlgorithm()->Update();
  }
  vtkDataObject* const input = this->GetDataObjectInput();
  // Those of the last picture might hide an input that is somewhere else, so that it never came to
  // be drawn.
  const bool changed =
    alone && input && (input != self.BoundsOf || input->GetMTime() != self.BoundsTime);
  if (!self.BoundsKnown || changed)
  {
    return !input || vtkDataSet::SafeDownCast(input) ? this->Superclass::GetBounds()
                                                     : banyan::BoundsOfLeaves(input, this->Bounds);
  }
  std::copy(self.Bounds.begin(), self.Bounds.end(), this->Bounds);
  return this->Bounds;
}

void vtkBanyanVolumeMapper::ReportOnce(const std::string& problem)
{
  if (problem != this->Self->LastProblem)
  {
    this->Self->LastProblem = problem;
    vtkErrorMacro(<< "The volume was not drawn. " << problem);
  }
}

void vtkBanyanVolumeMapper::WarnOnce(const std::string& note, std::string& last)
{
  if (note != last)
  {
    last = note;
    if (!note.empty() && this->Self->Communicator->Rank() == 0)
    {
      vtkWarningMacro(<< note);
    }
  }
}

/// Collective. @return whether the volume is on the screen
bool vtkBanyanVolumeMapper::PrepareFrame(vtkRenderer* renderer, Frame& frame)
{
  const banyan::PhaseScope beginning(banyan::Phase::Beginning);
  Internals& self = *this->Self;
  const std::string problem = banyan::AgreeOnError(*self.Communicator, self.Field.Problem());
  if (!problem.empty())
  {
    throw banyan::Error(problem);
  }
  // VTK's clipping range has no length where the eye is on a face and looks away.
  const double far = renderer->GetActiveCamera()->GetClippingRange()[1];
  if (self.Field.Empty() || far < LeastRange * frame.Volume->GetLength())
  {
    return false;
  }

  const bool fixed = this->SampleDistanceVoxels > 0.0;
  frame.Wanted.emplace(banyan::MakeFrameScene(renderer, frame.Volume, this, self.Field,
    fixed ? this->SampleDistanceVoxels : 1.0, self.Function));
  const std::string unclear = banyan::AgreeOnError(*self.Communicator, frame.Wanted->Problem);
  if (!unclear.empty())
  {
    throw banyan::Error(unclear);
  }
  return !frame.Wanted->Scene.Viewport.Empty();
}

/// @return the volume's picture, on rank 0
banyan::FloatImage vtkBanyanVolumeMapper::CastFrame(
  vtkRenderer* renderer, const banyan::Backdrop& backdrop, int volumes, Frame& drawn)
{
  Internals& self = *this->Self;
  banyan::FrameScene& wanted = *drawn.Wanted;
  banyan::RayScene& scene = wanted.Scene;
  const bool fixed = this->SampleDistanceVoxels > 0.0;
  banyan::CompositeOptions compositing;
  compositing.Behind = backdrop.Behind();
  scene.Depth = backdrop.Depths(scene.Viewport);
  this->Statistics->SetPixelsReadBehind(static_cast<vtkIdType>(backdrop.PixelsRead()));

  drawn.Figures = banyan::FrameFigures(self.Field);
  banyan::FrameStatistics& frame = drawn.Statistics;
  // More than one frame per second: somebody moves the camera. All ranks are told the same rate.
  // Volumes that are drawn one after the other share the time of a frame.
  drawn.Wish = { this->ImageErrorTolerance, this->InteractiveImageErrorTolerance,
    this->InteractiveFrameSeconds / volumes,
    renderer->GetRenderWindow()->GetDesiredUpdateRate() > 1.0, this->RefineInPasses,
    this->MaxElementsPerPixel, this->ScreenErrorPixels, fixed,
    banyan::CanKeepTolerance(this, drawn.Volume->GetProperty()) &&
      (!fixed || this->ScreenErrorPixels > 0.0) };
  drawn.Wish.Eye = banyan::EyeOf(renderer);
  const banyan::Timer drawing;
  {
    const banyan::PhaseScope fetching(banyan::Phase::Fetching);
    self.Field.BeginFrame(*self.Communicator, scene);
  }
  const std::uint64_t budget = self.Field.DrawingBudget();
  const banyan::PhaseScope sampling(banyan::Phase::Sampling);
  this->Statistics->SetEstimatedImageError(self.Tolerance.Plan(
    *self.Communicator, self.Field, scene, drawn.Wish, budget, wanted.Problem, frame));
  this->Statistics->SetImageErrorLimit(self.Tolerance.Limit().c_str());
  this->Statistics->SetEncodingErrorOfValues(
    self.Field.IsMesh() ? std::numeric_limits<double>::quiet_NaN() : self.Field.EncodingError());
  this->Statistics->SetMeshDeviation(self.Field.MeshDeviation());
  const banyan::FrameStatistics pilots = frame;
  // Errors of few bits add up where volumes are blended over each other.
  compositing.Transport = this->CompositeInFewBits && volumes == 1
                            ? banyan::PixelTransport::WithinOne
                            : banyan::PixelTransport::Floats;
  compositing.Plans = &self.Plans;
  // The other eye's picture is no step of a camera that moves.
  if (this->ReadAhead && drawn.Wish.Eye == 0)
  {
    compositing.AfterCasting = [&self, &scene]
    { self.Field.ReadAhead(scene, self.Communicator->Rank()); };
  }
  banyan::FloatImage picture = banyan::DrawDistributed(*self.Communicator, scene,
    { self.Field.Source(), self.Field.Zones(), budget, banyan::ThreadPool::Process(),
      wanted.Problem },
    frame, compositing);

  frame.SamplesTaken += pilots.SamplesTaken;
  frame.BytesComposited += pilots.BytesComposited;
  frame.MessagesComposited += pilots.MessagesComposited;
  const banyan::PhaseScope balancing(banyan::Phase::Balancing);
  self.Field.EndFrame(*self.Communicator);
  // Putting the picture on the screen takes about what it took the last time.
  self.Tolerance.FrameTook(
    drawn.Wish, banyan::AllMax(*self.Communicator, drawing.Seconds() + self.WriteSeconds));
  return picture;
}

void vtkBanyanVolumeMapper::FinishFrame(
  const Frame& drawn, const banyan::CompositeStatistics& geometry, double writeSeconds)
{
  Internals& self = *this->Self;
  self.WriteSeconds = writeSeconds;
  self.LastProblem.clear();
  this->Statistics->SetTotalSeconds(drawn.Began.Seconds());
  drawn.Figures.Publish(
    *self.Communicator, self.Field, drawn.Statistics, geometry.BytesSent, this->Statistics);
}

bool vtkBanyanVolumeMapper::RefineNext()
{
  return this->RefineInPasses && this->Self->Tolerance.RefineNext();
}

void vtkBanyanVolumeMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  this->Self->Backdrop.ReleaseGraphicsResources(window);
  this->Superclass::ReleaseGraphicsResources(window);
}

void vtkBanyanVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
#define BANYAN_PRINT(Name, ...) os << indent << #Name ": " << this->Name << "\n";
  BANYAN_VOLUME_SETTINGS(BANYAN_PRINT, BANYAN_PRINT, BANYAN_PRINT, BANYAN_PRINT)
#undef BANYAN_PRINT
  os << indent << "RefineInPasses: " << this->RefineInPasses << "\n"
     << indent << "Controller: " << this->Controller.GetPointer() << "\n"
     << indent << "Statistics: " << this->Statistics.GetPointer() << "\n";
}
