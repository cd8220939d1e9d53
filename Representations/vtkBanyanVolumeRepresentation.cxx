// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanVolumeRepresentation.h"

#include "BlocksAsOne.h"
#include "DefaultFunctions.h"
#include "FunctionWatch.h"
#include "HeldPiece.h"
#include "LeafParts.h"
#include "LineToClient.h"
#include "MergedBlocks.h"
#include "PictureServer.h"
#include "PicturesAtHand.h"
#include "StepWindow.h"
#include "WallOfRanks.h"
#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanVolume.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkCamera.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommand.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPVDataDeliveryManager.h"
#include "vtkPVRenderView.h"
#include "vtkPVSession.h"
#include "vtkPiecewiseFunction.h"
#include "vtkProcessModule.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkVolumeProperty.h"

#include <algorithm>
#include <utility>

namespace
{

/// Only VTK's cameras set it.
struct StereoOfCamera : vtkCamera
{
  static void Set(vtkCamera* camera, int stereo) { camera->*(&StereoOfCamera::Stereo) = stereo; }
};

/// ParaView's render passes do not tell cameras that stereo was switched on or off: the first
/// picture, which may be the left eye's, would be that of the camera before.
void TellStereo(vtkPVRenderView* view)
{
  vtkCamera* const camera = view ? view->GetActiveCamera() : nullptr;
  if (camera && camera->GetStereo() != view->GetRenderWindow()->GetStereoRender())
  {
    StereoOfCamera::Set(camera, view->GetRenderWindow()->GetStereoRender());
    camera->Modified();
  }
}

bool IsClient()
{
  return vtkProcessModule::GetProcessType() == vtkProcessModule::PROCESS_CLIENT;
}

/// While progress is pending, ParaView's windows turn their event loop, but must not render.
bool HasPendingProgress()
{
  auto* const session =
    vtkPVSession::SafeDownCast(vtkProcessModule::GetProcessModule()->GetSession());
  return session && session->GetPendingProgress();
}

} // namespace

vtkStandardNewMacro(vtkBanyanVolumeRepresentation);

vtkBanyanVolumeRepresentation::vtkBanyanVolumeRepresentation()
  : Prop(vtkSmartPointer<vtkBanyanVolume>::New())
  , Piece(vtkSmartPointer<vtkImageData>::New().GetPointer())
  , Blocks(std::make_unique<banyan::MergedBlocks>())
  , Defaults(std::make_unique<banyan::DefaultFunctions>())
  , Steps(std::make_unique<banyan::StepWindow>())
  , Colors(std::make_unique<banyan::FunctionWatch>([this] { this->FunctionChanged(); }))
  , Opacity(std::make_unique<banyan::FunctionWatch>([this] { this->FunctionChanged(); }))
  , Pictures(std::make_shared<banyan::PicturesAtHand>())
  , Server(std::make_unique<banyan::PictureServer>(this->Mapper, this->Prop))
{
  // The superclass has made a prop of ParaView's own: ours takes its place.
  this->Actor = this->Prop;
  this->Actor->SetProperty(this->Property);
  this->Prop->SetMapper(this->Mapper);
  this->Prop->SetBanyanMapper(this->Mapper);
  this->Mapper->AddObserver(
    vtkCommand::ProgressEvent, this, &vtkBanyanVolumeRepresentation::ShowProgress);
  this->Mapper->SetIsBusy(HasPendingProgress);
  this->Mapper->DecoupledOn();
  vtkMath::UninitializeBounds(this->DataBounds);
}

vtkBanyanVolumeRepresentation::~vtkBanyanVolumeRepresentation() = default;

int vtkBanyanVolumeRepresentation::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkStructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkRectilinearGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkExplicitStructuredGrid");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkHyperTreeGrid");
  // AMR, and blocks of cells, which are drawn as one mesh.
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkBanyanVolumeRepresentation::RequestUpdateExtent(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const int done = this->Superclass::RequestUpdateExtent(request, inputVector, outputVector);
  if (done && this->Mapper->GetTemporalEnhancement() > 0.0 &&
      inputVector[0]->GetNumberOfInformationObjects() == 1)
  {
    const bool timed = this->GetUpdateTimeValid();
    this->Steps->Request(
      this, timed ? std::optional<double>(this->GetUpdateTime()) : std::nullopt, {});
  }
  return done;
}

/// The steps to compare with, as far as they can be read: what others lack, no rank compares with.
void vtkBanyanVolumeRepresentation::TakeSteps()
{
  try
  {
    this->Steps->Take(this);
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< "'Temporal Enhancement' has no effect: " << error.what());
  }
}

/// Adds what the drawn array is compared with to the piece.
void vtkBanyanVolumeRepresentation::AddSteps(vtkDataArray* array)
{
  vtkDataSet* const piece = vtkDataSet::SafeDownCast(this->Piece);
  const int others = piece ? banyan::AddNeighbours(array, *this->Steps, piece, *this->Blocks)
                           : banyan::AddNeighboursToLeaves(array, *this->Steps, this->Piece);
  if (others > 0)
  {
    vtkWarningMacro(<< "'Temporal Enhancement' leaves out steps that have other cells, hyper trees "
                       "or AMR blocks than this one.");
  }
}

int vtkBanyanVolumeRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  const bool hasInput = inputVector[0]->GetNumberOfInformationObjects() == 1;
  const bool enhanced = hasInput && this->Mapper->GetTemporalEnhancement() > 0.0;
  if (enhanced)
  {
    this->TakeSteps();
  }
  vtkMath::UninitializeBounds(this->DataBounds);
  this->Piece = vtkSmartPointer<vtkImageData>::New().GetPointer();
  // While steps around it are read, what the input has is another one.
  vtkDataObject* now = enhanced ? this->Steps->Now() : nullptr;
  if (hasInput && !now)
  {
    now = vtkDataObject::GetData(inputVector[0], 0);
  }
  vtkSmartPointer<vtkDataObject> input;
  try
  {
    input = banyan::BlocksAsOne(now, *this->Blocks);
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< "The volume was not drawn. " << error.what());
  }
  if (input)
  {
    this->Piece = banyan::CopyOfLeaves(input);
    if (enhanced)
    {
      this->SelectArray();
      this->AddSteps(this->Mapper->GetArrayToDraw(this->Piece));
    }
    banyan::BoundsOf(this->Piece, this->DataBounds);
  }
  return this->Superclass::RequestData(request, inputVector, outputVector);
}

int vtkBanyanVolumeRepresentation::ProcessViewRequest(
  vtkInformationRequestKey* request, vtkInformation* inInfo, vtkInformation* outInfo)
{
  if (!this->Superclass::ProcessViewRequest(request, inInfo, outInfo))
  {
    return 0;
  }
  if (request == vtkPVView::REQUEST_UPDATE())
  {
    this->Prop->SetView(vtkPVRenderView::SafeDownCast(this->GetView()));
    // Data stay where they are, and ParaView does not count them when it decides who renders.
    const double* const box = this->Prop->IsOnWall() ? this->DataBounds : nullptr;
    vtkPVRenderView::SetPiece(inInfo, this, banyan::HeldPiece::Of(this->Piece, box));
    // Placed as it is drawn: a client without data takes its clipping planes from here.
    vtkPVRenderView::SetGeometryBounds(inInfo, this, this->DataBounds, this->Actor->GetMatrix());
    if (!this->Served)
    {
      vtkPVRenderView::SetRequiresDistributedRendering(inInfo, this, true);
    }
    // Ranks whose bounds are off screen must draw all the same, or the others wait for ever. Never
    // together with NEED_ORDERED_COMPOSITING: the view then forgets this one.
    outInfo->Set(vtkPVRenderView::RENDER_EMPTY_IMAGES(), 1);
  }
  else if (request == vtkPVView::REQUEST_UPDATE_LOD() && !this->Served)
  {
    vtkPVRenderView::SetRequiresDistributedRenderingLOD(inInfo, this, true);
  }
  else if (request == vtkPVView::REQUEST_RENDER() && !this->Prop->HasPictures())
  {
    this->PrepareRender(this->PieceIn(vtkPVRenderView::SafeDownCast(this->GetView())));
  }
  return 1;
}

void vtkBanyanVolumeRepresentation::SetServed(bool served)
{
  this->Server->Serve(served);
  this->Served = served;
  this->Prop->SetPictures(served && IsClient() ? this->Pictures : nullptr);
}

void vtkBanyanVolumeRepresentation::TakeTicket(
  double* numbers, unsigned int words, unsigned int* depths)
{
  auto* const view = vtkPVRenderView::SafeDownCast(this->GetView());
  if (!view || !this->Served)
  {
    return; // ParaView has taken the display away meanwhile
  }
  const banyan::PictureTicket ticket = banyan::PictureTicket::Of(numbers, words, depths);
  if (ticket.IsNew())
  {
    this->PrepareRender(this->PieceIn(view));
  }
  this->Server->Take(ticket, banyan::LineToClient());
}

vtkMTimeType vtkBanyanVolumeRepresentation::GetPictureMTime()
{
  return std::max({ this->GetMTime(), this->Actor->GetMTime(), this->Property->GetMTime(),
    this->Mapper->GetMTime() });
}

/// Shows the progress of what takes long before a picture: ParaView shows progress of
/// representations, not of mappers.
void vtkBanyanVolumeRepresentation::ShowProgress()
{
  this->UpdateProgress(this->Mapper->GetProgress());
  if (this->GetAbortExecute())
  {
    this->Mapper->SetAbortExecute(1);
  }
}

/// The piece that this rank has given the view: wherever that moves or copies it, ours draws it.
vtkSmartPointer<vtkDataObject> vtkBanyanVolumeRepresentation::PieceIn(vtkPVRenderView* view)
{
  return banyan::HeldPiece::In(view->GetDeliveryManager()->GetPiece(this, /*low_res=*/false));
}

/// Collective over the ranks that render.
void vtkBanyanVolumeRepresentation::PrepareRender(vtkDataObject* piece)
{
  auto* const view = vtkPVRenderView::SafeDownCast(this->GetView());
  this->Prop->SetView(view);
  if (IsClient() && banyan::IsWall(view))
  {
    this->Prop->ShowBox(view->GetDeliveryManager()->GetDeliveredPiece(this, /*low_res=*/false));
    if (!std::exchange(this->WallTold, true))
    {
      vtkWarningMacro(<< "The server's displays show the volume; this window shows its box.");
    }
    return;
  }
  TellStereo(view);
  this->Mapper->SetInputDataObject(piece);
  this->SetAbortExecute(0); // what stopped another picture was not meant for this one
  this->Mapper->SetAbortExecute(0);
  this->Mapper->SetController(vtkMultiProcessController::GetGlobalController());
  this->SelectArray();
  this->Property->SetInterpolationType(
    this->NearestPoint ? VTK_NEAREST_INTERPOLATION : this->InterpolationType);
  this->Mapper->SetBlendMode(this->BlendMode != 0 ? this->BlendMode : this->Projection);
  const bool hasColours = !this->MapScalars && this->Mapper->CanDrawColours(piece);
  this->Property->SetIndependentComponents(hasColours ? 0 : 1);
  this->Defaults->Apply(
    this->Mapper, piece, !this->ColorGiven, !this->OpacityGiven, this->Property);
  this->Mapper->UpdateField(this->Prop);
  this->PlaceCroppingBox();
}

void vtkBanyanVolumeRepresentation::PlaceCroppingBox()
{
  const double* bounds = this->Mapper->GetBounds();
  if (!vtkMath::AreBoundsInitialized(bounds))
  {
    return;
  }
  double planes[6];
  for (int i = 0; i < 6; ++i)
  {
    planes[i] = this->CroppingOrigin[i / 2] + bounds[i] * this->CroppingScale[i / 2];
  }
  this->Mapper->SetCroppingRegionPlanes(planes);
}

/// ParaView itself renders when a drag has ended. Functions of a server are others: LiveFunctions.
void vtkBanyanVolumeRepresentation::FunctionChanged()
{
  auto* const view = vtkPVRenderView::SafeDownCast(this->GetView());
  if (view && this->GetVisibility() && !this->Prop->HasPictures() &&
      !view->GetUseDistributedRenderingForRender())
  {
    this->Mapper->RenderSoon(view->GetRenderWindow());
  }
}

void vtkBanyanVolumeRepresentation::SetMapScalars(bool map)
{
  this->Superclass::SetMapScalars(map);
  this->Property->Modified(); // of a client that is served, too
}

void vtkBanyanVolumeRepresentation::SetColor(vtkColorTransferFunction* colors)
{
  this->ColorGiven = colors != nullptr;
  this->Colors->Watch(colors);
  this->Superclass::SetColor(colors);
}

void vtkBanyanVolumeRepresentation::SetScalarOpacity(vtkPiecewiseFunction* opacity)
{
  this->OpacityGiven = opacity != nullptr;
  this->Opacity->Watch(opacity);
  this->Superclass::SetScalarOpacity(opacity);
}

void vtkBanyanVolumeRepresentation::SelectArray()
{
  vtkInformation* info = this->GetInputArrayInformation(0);
  const char* name = info && info->Has(vtkDataObject::FIELD_NAME())
                       ? info->Get(vtkDataObject::FIELD_NAME())
                       : nullptr;
  if (!name || !*name)
  {
    this->Mapper->SetScalarMode(VTK_SCALAR_MODE_DEFAULT);
    return;
  }
  const bool cells =
    info->Get(vtkDataObject::FIELD_ASSOCIATION()) == vtkDataObject::FIELD_ASSOCIATION_CELLS;
  this->Mapper->SetScalarMode(
    cells ? VTK_SCALAR_MODE_USE_CELL_FIELD_DATA : VTK_SCALAR_MODE_USE_POINT_FIELD_DATA);
  this->Mapper->SelectScalarArray(name);
}

bool vtkBanyanVolumeRepresentation::AddToView(vtkView* view)
{
  if (auto* renderView = vtkPVRenderView::SafeDownCast(view))
  {
    renderView->GetRenderer()->AddActor(this->Actor);
    this->Prop->DrawWhenEnded(renderView->GetRenderer());
    return this->Superclass::AddToView(view);
  }
  return false;
}

bool vtkBanyanVolumeRepresentation::RemoveFromView(vtkView* view)
{
  if (auto* renderView = vtkPVRenderView::SafeDownCast(view))
  {
    renderView->GetRenderer()->RemoveActor(this->Actor);
    this->Prop->DrawWhenEnded(nullptr);
    return this->Superclass::RemoveFromView(view);
  }
  return false;
}

void vtkBanyanVolumeRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Mapper:\n";
  this->Mapper->PrintSelf(os, indent.GetNextIndent());
}
