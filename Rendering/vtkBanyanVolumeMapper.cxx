// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanVolumeMapper.h"

#include "CommunicatorOf.h"
#include "Fields/InputOfPiece.h"
#include "IgnoredOptions.h"
#include "MapperState.h"
#include "PieceOfInput.h"
#include "SetNumber.h"
#include "VolumesOnWall.h"
#include "VolumesPicture.h"
#include "vtkBanyanFrameStatistics.h"

#include "Base/ThreadPool.h"

#include "vtkAlgorithm.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkDataSet.h"
#include "vtkHyperTreeGrid.h"
#include "vtkInformation.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkOverlappingAMR.h"
#include "vtkRenderer.h"
#include "vtkVolume.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <utility>

vtkStandardNewMacro(vtkBanyanVolumeMapper);

#define BANYAN_REAL(Name, Unit, Default, Least, Most, ...)                                         \
  banyanSetNumberMacro(vtkBanyanVolumeMapper, Name, Least, Most);
#define BANYAN_NONE(...)
BANYAN_VOLUME_SETTINGS(BANYAN_REAL, BANYAN_NONE, BANYAN_NONE, BANYAN_NONE)
#undef BANYAN_REAL
#undef BANYAN_NONE

vtkBanyanVolumeMapper::vtkBanyanVolumeMapper()
  : Statistics(vtkSmartPointer<vtkBanyanFrameStatistics>::New())
  , State(std::make_unique<banyan::MapperState>())
{
  this->State->Communicator = banyan::MakeSelfCommunicator();
  // Programs may read a window that swaps its buffers, and would save a coarse picture.
  this->Decoupled = false;
}

vtkBanyanVolumeMapper::~vtkBanyanVolumeMapper() = default;

int vtkBanyanVolumeMapper::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkStructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkRectilinearGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkExplicitStructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkHyperTreeGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkOverlappingAMR");
  // A rank without data takes part in drawing all the same.
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

void vtkBanyanVolumeMapper::SetController(vtkMultiProcessController* controller)
{
  if (this->Controller == controller)
  {
    return;
  }
  this->Controller = controller;
  this->State->Late.Stop();
  this->State->Served.Stop();
  this->State->Field.Reset();
  this->State->Frames.Forget();
  this->State->WallFrames.clear();
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
  this->State->Communicator = banyan::CommunicatorOf(controller, timeout);
  if (this->State->Communicator->Size() > 1)
  {
    banyan::ThreadPool::SetRanksOnThisNode(this->State->Communicator->RanksOnThisNode());
  }
  this->Modified();
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
  this->State->RankOrderBehind = frontToBack;
}

void vtkBanyanVolumeMapper::SetIsBusy(const std::function<bool()>& isBusy)
{
  this->State->Again.SetIsBusy(isBusy);
}

void vtkBanyanVolumeMapper::RenderSoon(vtkRenderWindow* window)
{
  if (this->Decoupled && banyan::RenderWhenDrawn::CanWatch(window))
  {
    this->State->Again.Watch(window, [] { return true; });
  }
}

vtkDataArray* vtkBanyanVolumeMapper::GetArrayToDraw(vtkDataObject* data)
{
  return banyan::ArrayToDraw(this, data).Array;
}

bool vtkBanyanVolumeMapper::CanDrawColours(vtkDataObject* data)
{
  return banyan::CanBeColours(this, data, this->GetArrayToDraw(data));
}

bool vtkBanyanVolumeMapper::ShowsCoarsePicture() const
{
  return this->State->ShowsCoarse;
}

void vtkBanyanVolumeMapper::UpdateField(vtkVolume* volume)
{
  if (this->GetNumberOfInputConnections(0) > 0)
  {
    this->GetInputAlgorithm()->Update();
  }
  banyan::MapperState& self = *this->State;
  self.Field.SetLoadBalancing(
    this->LoadBalancing == 0 ? banyan::LoadBalancing::Off : banyan::LoadBalancing::MeasuredCost);
  const bool hasWidth = banyan::ThreadPool::HasProcessWidth(this->NumberOfThreads);
  // What all ranks draw they also stop together.
  if (banyan::LateFramesOfRanks::AnyDraws() &&
      banyan::AllMax(*self.Communicator, hasWidth ? 0.0 : 1.0) > 0.0)
  {
    banyan::LateFramesOfRanks::PauseAll();
  }
  banyan::FieldPiece piece;
  try
  {
    if (!hasWidth)
    {
      banyan::LateFrames::PauseAll();
      banyan::ThreadPool::SetProcessWidth(this->NumberOfThreads);
    }
    piece = banyan::PieceOfInput(this, volume->GetProperty());
  }
  catch (const std::exception& error)
  {
    piece = banyan::FieldPiece();
    piece.Problem = error.what();
  }
  self.Motion.Apply(*self.Communicator, this->TemporalEnhancement, volume->GetProperty(),
    this->GetDataObjectInput(), piece);
  const bool mapped = piece.Array && piece.Array->GetNumberOfComponents() > 1 &&
                      piece.Component != banyan::SampleArray::Colours;
  banyan::InputOfPiece input(std::move(piece), &self.Parts);
  const bool isOther = !self.Field.IsOf(input);
  if (isOther)
  {
    self.Late.Stop();
  }
  if (self.Served.IsComing() && banyan::AllMax(*self.Communicator, isOther ? 1.0 : 0.0) > 0.0)
  {
    self.Served.Stop();
  }
  self.Field.Update(*self.Communicator, input);
  self.Bounds = self.Field.Place().Bounds;
  self.BoundsOf = this->GetDataObjectInput();
  self.BoundsTime = self.BoundsOf ? self.BoundsOf->GetMTime() : 0;
  self.BoundsKnown = true;
  this->WarnOnce(
    self.Motion.Note() + self.Field.Drawn().Note() + this->DivisionNote() + this->CellValuesNote(),
    self.LastNote);
  this->WarnOnce(banyan::IgnoredOptions(this, volume->GetProperty(), mapped), self.LastIgnored);
  if (self.Field.Empty() && !self.Field.Problem().empty())
  {
    // Nothing with bounds is there to be rendered, so this may be the only place to say why.
    this->ReportOnce(self.Field.Problem());
  }
}

/// Why the picture is not divided as wanted; empty if it is. The same on all ranks.
std::string vtkBanyanVolumeMapper::DivisionNote() const
{
  const banyan::MapperState& self = *this->State;
  const bool isElsewhere = this->Division == 2 && self.Communicator->Size() > 1 &&
                           !self.Field.Empty() && !self.Field.Drawn().IsOnEachRank();
  if (!isElsewhere)
  {
    return "";
  }
  return self.Field.Drawn().PieceOfCells()
           ? "'Division' By picture has no effect: cells of a mesh stay on their ranks. Choose "
             "Automatic."
           : "'Division' By picture has no effect: no rank has all values of plain data. Encode "
             "them, or choose By data.";
}

/// Why values of cells are not drawn as they are, if that is wanted.
std::string vtkBanyanVolumeMapper::CellValuesNote()
{
  vtkDataObject* const data = this->GetDataObjectInput();
  const bool isLeaves =
    vtkHyperTreeGrid::SafeDownCast(data) || vtkOverlappingAMR::SafeDownCast(data);
  return this->CellValues == 1 && isLeaves
           ? "'CellValues' As they are has no effect on hyper tree grids and AMR. "
           : "";
}

double* vtkBanyanVolumeMapper::GetBounds()
{
  const banyan::MapperState& self = *this->State;
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

bool vtkBanyanVolumeMapper::Attempt(const std::function<bool()>& work)
{
  try
  {
    return work();
  }
  catch (const std::exception& error)
  {
    this->ReportOnce(error.what());
    this->State->Communicator->LeaveTogether(error.what());
  }
  return false;
}

void vtkBanyanVolumeMapper::ReportOnce(const std::string& problem)
{
  if (problem != this->State->LastProblem)
  {
    this->State->LastProblem = problem;
    vtkErrorMacro(<< "The volume was not drawn. " << problem);
  }
}

void vtkBanyanVolumeMapper::WarnOnce(const std::string& note, std::string& last)
{
  if (note != last)
  {
    last = note;
    if (!note.empty() && this->State->Communicator->Rank() == 0)
    {
      vtkWarningMacro(<< note);
    }
  }
}

void vtkBanyanVolumeMapper::Render(vtkRenderer* renderer, vtkVolume* volume)
{
  if (renderer->GetSelector() || this->State->DrawnByOthers.erase(volume) > 0)
  {
    return;
  }
  banyan::VolumesPicture picture(renderer, this, volume);
  if (picture.HasSeveral() && this->State->FrameEnds == 0)
  {
    this->State->FrameEnds =
      renderer->AddObserver(vtkCommand::EndEvent, this, &vtkBanyanVolumeMapper::EndFrame);
  }
  picture.Draw();
}

void vtkBanyanVolumeMapper::RenderOnWall(vtkRenderer* renderer, vtkVolume* volume,
  const std::vector<banyan::WallPicture>& pictures, const std::vector<banyan::DepthPicture>& own)
{
  banyan::VolumesOnWall(renderer, this, volume).Draw(pictures, own);
}

/// Volumes that were not called, as they are off the screen, are to be drawn in the next frame.
void vtkBanyanVolumeMapper::EndFrame(vtkObject* caller, unsigned long, void*)
{
  auto* const renderer = vtkRenderer::SafeDownCast(caller);
  renderer->RemoveObserver(this->State->FrameEnds);
  this->State->FrameEnds = 0;
  banyan::VolumesPicture::ForgetDrawn(renderer);
}

void vtkBanyanVolumeMapper::ReleaseGraphicsResources(vtkWindow* window)
{
  this->State->Backdrop.ReleaseGraphicsResources(window);
  this->Superclass::ReleaseGraphicsResources(window);
}

void vtkBanyanVolumeMapper::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
#define BANYAN_PRINT(Name, ...) os << indent << #Name ": " << this->Name << "\n";
  BANYAN_VOLUME_SETTINGS(BANYAN_PRINT, BANYAN_PRINT, BANYAN_PRINT, BANYAN_PRINT)
#undef BANYAN_PRINT
  os << indent << "Controller: " << this->Controller.GetPointer() << "\n"
     << indent << "Statistics: " << this->Statistics.GetPointer() << "\n";
}
