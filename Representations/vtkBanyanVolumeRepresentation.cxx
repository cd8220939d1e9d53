#include "vtkBanyanVolumeRepresentation.h"

#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanVolume.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkAbstractMapper.h"
#include "vtkAppendFilter.h"
#include "vtkColorTransferFunction.h"
#include "vtkCommunicator.h"
#include "vtkCompositeDataIterator.h"
#include "vtkCompositeDataSet.h"
#include "vtkDataArray.h"
#include "vtkImageData.h"
#include "vtkInformation.h"
#include "vtkInformationVector.h"
#include "vtkMath.h"
#include "vtkMultiProcessController.h"
#include "vtkObjectFactory.h"
#include "vtkPVRenderView.h"
#include "vtkPiecewiseFunction.h"
#include "vtkRenderer.h"
#include "vtkUnstructuredGrid.h"
#include "vtkVolumeProperty.h"

namespace
{

/// A data set, or the blocks of one as one grid; null if there is none.
vtkSmartPointer<vtkDataSet> DataOf(vtkDataObject* data)
{
  vtkCompositeDataSet* const blocks = vtkCompositeDataSet::SafeDownCast(data);
  if (!blocks)
  {
    return vtkDataSet::SafeDownCast(data);
  }
  vtkNew<vtkAppendFilter> append;
  const auto visit = vtkSmartPointer<vtkCompositeDataIterator>::Take(blocks->NewIterator());
  for (visit->InitTraversal(); !visit->IsDoneWithTraversal(); visit->GoToNextItem())
  {
    vtkDataSet* const block = vtkDataSet::SafeDownCast(visit->GetCurrentDataObject());
    if (block && block->GetNumberOfPoints() > 0)
    {
      append->AddInputData(block);
    }
  }
  if (append->GetNumberOfInputConnections(0) == 0)
  {
    return nullptr;
  }
  append->Update();
  return append->GetOutput();
}

} // namespace

vtkStandardNewMacro(vtkBanyanVolumeRepresentation);

vtkBanyanVolumeRepresentation::vtkBanyanVolumeRepresentation()
  : Prop(vtkSmartPointer<vtkBanyanVolume>::New())
  , Piece(vtkSmartPointer<vtkImageData>::New().GetPointer())
{
  // The superclass has made a prop of ParaView's own: ours takes its place.
  this->Actor = this->Prop;
  this->Actor->SetProperty(this->Property);
  this->Prop->SetMapper(this->Mapper);
  this->Prop->SetBanyanMapper(this->Mapper);
  vtkMath::UninitializeBounds(this->DataBounds);
}

vtkBanyanVolumeRepresentation::~vtkBanyanVolumeRepresentation() = default;

int vtkBanyanVolumeRepresentation::FillInputPortInformation(int, vtkInformation* info)
{
  info->Remove(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE());
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkImageData");
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkUnstructuredGrid");
  // Blocks of hexahedra are drawn as one mesh.
  info->Append(vtkAlgorithm::INPUT_REQUIRED_DATA_TYPE(), "vtkCompositeDataSet");
  info->Set(vtkAlgorithm::INPUT_IS_OPTIONAL(), 1);
  return 1;
}

int vtkBanyanVolumeRepresentation::RequestData(
  vtkInformation* request, vtkInformationVector** inputVector, vtkInformationVector* outputVector)
{
  vtkMath::UninitializeBounds(this->DataBounds);
  this->DataSize = 0;
  this->Piece = vtkSmartPointer<vtkImageData>::New().GetPointer();
  if (inputVector[0]->GetNumberOfInformationObjects() == 1)
  {
    if (const vtkSmartPointer<vtkDataSet> input =
          DataOf(vtkDataObject::GetData(inputVector[0], 0)))
    {
      this->Piece = vtkSmartPointer<vtkDataSet>::Take(input->NewInstance());
      this->Piece->ShallowCopy(input);
      if (input->GetNumberOfPoints() > 0)
      {
        input->GetBounds(this->DataBounds);
        this->DataSize = input->GetActualMemorySize();
      }
    }
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
    vtkPVRenderView::SetPiece(inInfo, this, this->Piece, this->DataSize);
    // Placed as it is drawn: a client without data takes its clipping planes from here.
    vtkPVRenderView::SetGeometryBounds(inInfo, this, this->DataBounds, this->Actor->GetMatrix());
    vtkPVRenderView::SetDeliverToClientAndRenderingProcesses(inInfo, this, false, false);
    vtkPVRenderView::SetRequiresDistributedRendering(inInfo, this, true);
    // Ranks whose bounds are off screen must draw all the same, or the others wait for ever. Never
    // together with NEED_ORDERED_COMPOSITING: the view then forgets this one.
    outInfo->Set(vtkPVRenderView::RENDER_EMPTY_IMAGES(), 1);
    this->Mapper->SetRefineInPasses(vtkPVView::GetEnableStreaming());
    vtkPVRenderView::SetStreamable(inInfo, this, this->Mapper->GetRefineInPasses());
  }
  else if (request == vtkPVRenderView::REQUEST_STREAMING_UPDATE())
  {
    // No data has to come: that a piece was set makes the view render again.
    if (this->Mapper->RefineNext())
    {
      vtkNew<vtkImageData> nothing;
      vtkPVRenderView::SetNextStreamedPiece(inInfo, this, nothing);
    }
  }
  else if (request == vtkPVView::REQUEST_UPDATE_LOD())
  {
    vtkPVRenderView::SetRequiresDistributedRenderingLOD(inInfo, this, true);
  }
  else if (request == vtkPVView::REQUEST_RENDER())
  {
    this->PrepareRender(vtkPVView::GetDeliveredPiece(inInfo, this));
  }
  return 1;
}

/// Collective over the ranks that render.
void vtkBanyanVolumeRepresentation::PrepareRender(vtkDataObject* piece)
{
  vtkDataSet* data = vtkDataSet::SafeDownCast(piece);
  this->Mapper->SetInputDataObject(data);
  this->Mapper->SetController(vtkMultiProcessController::GetGlobalController());
  this->SelectArray();
  this->Property->SetIndependentComponents(1);
  this->Property->SetInterpolationType(
    this->NearestPoint ? VTK_NEAREST_INTERPOLATION : this->InterpolationType);
  this->Prop->SetView(vtkPVRenderView::SafeDownCast(this->GetView()));
  if (!this->ColorGiven || !this->OpacityGiven)
  {
    this->UseDefaultFunctions(data);
  }
  this->Mapper->SetBlendMode(this->BlendMode != 0 ? this->BlendMode : this->Projection);
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

/// ParaView gives a colour map only with an array that was chosen by name. Collective.
void vtkBanyanVolumeRepresentation::UseDefaultFunctions(vtkDataSet* piece)
{
  double local[2] = { VTK_DOUBLE_MIN, VTK_DOUBLE_MIN }; // -minimum, maximum
  if (vtkDataArray* array = this->Mapper->GetArrayToDraw(piece))
  {
    double range[2];
    array->GetFiniteRange(range, array->GetNumberOfComponents() > 1 ? -1 : 0);
    local[0] = -range[0];
    local[1] = range[1];
  }
  double all[2] = { local[0], local[1] };
  if (vtkMultiProcessController* controller = vtkMultiProcessController::GetGlobalController())
  {
    controller->AllReduce(local, all, 2, vtkCommunicator::MAX_OP);
  }
  const double low = -all[0] <= all[1] ? -all[0] : 0.0;
  const double high = -all[0] <= all[1] ? all[1] : 1.0;
  if (!this->ColorGiven)
  {
    vtkNew<vtkColorTransferFunction> colors;
    colors->SetVectorModeToMagnitude();
    colors->SetColorSpaceToDiverging();
    colors->AddRGBPoint(low, 0.23, 0.30, 0.75);
    colors->AddRGBPoint(high, 0.71, 0.016, 0.15);
    this->Property->SetColor(colors);
  }
  if (!this->OpacityGiven)
  {
    vtkNew<vtkPiecewiseFunction> opacity;
    opacity->AddPoint(low, 0.0);
    opacity->AddPoint(high, 1.0);
    this->Property->SetScalarOpacity(opacity);
  }
}

void vtkBanyanVolumeRepresentation::SetColor(vtkColorTransferFunction* colors)
{
  this->ColorGiven = colors != nullptr;
  this->Superclass::SetColor(colors);
}

void vtkBanyanVolumeRepresentation::SetScalarOpacity(vtkPiecewiseFunction* opacity)
{
  this->OpacityGiven = opacity != nullptr;
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
    return this->Superclass::AddToView(view);
  }
  return false;
}

bool vtkBanyanVolumeRepresentation::RemoveFromView(vtkView* view)
{
  if (auto* renderView = vtkPVRenderView::SafeDownCast(view))
  {
    renderView->GetRenderer()->RemoveActor(this->Actor);
    return this->Superclass::RemoveFromView(view);
  }
  return false;
}

void vtkBanyanVolumeRepresentation::SetImageErrorTolerance(double tolerance)
{
  this->Mapper->SetImageErrorTolerance(tolerance);
}

void vtkBanyanVolumeRepresentation::SetInteractiveImageErrorTolerance(double tolerance)
{
  this->Mapper->SetInteractiveImageErrorTolerance(tolerance);
}

void vtkBanyanVolumeRepresentation::SetInteractiveFrameSeconds(double seconds)
{
  this->Mapper->SetInteractiveFrameSeconds(seconds);
}

void vtkBanyanVolumeRepresentation::SetSampleDistanceVoxels(double voxels)
{
  this->Mapper->SetSampleDistanceVoxels(voxels);
}

void vtkBanyanVolumeRepresentation::SetShade(bool shade)
{
  this->Property->SetShade(shade ? 1 : 0);
}

void vtkBanyanVolumeRepresentation::SetAmbient(double coefficient)
{
  this->Property->SetAmbient(coefficient);
}

void vtkBanyanVolumeRepresentation::SetDiffuse(double coefficient)
{
  this->Property->SetDiffuse(coefficient);
}

void vtkBanyanVolumeRepresentation::SetSpecular(double coefficient)
{
  this->Property->SetSpecular(coefficient);
}

void vtkBanyanVolumeRepresentation::SetSpecularPower(double power)
{
  this->Property->SetSpecularPower(power);
}

void vtkBanyanVolumeRepresentation::SetInterpolationType(int type)
{
  this->InterpolationType = type;
}

void vtkBanyanVolumeRepresentation::SetNearestPoint(bool nearest)
{
  this->NearestPoint = nearest;
}

void vtkBanyanVolumeRepresentation::SetBlendMode(int mode)
{
  this->BlendMode = mode;
}

void vtkBanyanVolumeRepresentation::SetProjection(int mode)
{
  this->Projection = mode;
}

void vtkBanyanVolumeRepresentation::SetCropping(int cropping)
{
  this->Mapper->SetCropping(cropping);
}

void vtkBanyanVolumeRepresentation::SetCroppingOrigin(double x, double y, double z)
{
  this->CroppingOrigin[0] = x;
  this->CroppingOrigin[1] = y;
  this->CroppingOrigin[2] = z;
}

void vtkBanyanVolumeRepresentation::SetCroppingOrigin(double origin[3])
{
  this->SetCroppingOrigin(origin[0], origin[1], origin[2]);
}

void vtkBanyanVolumeRepresentation::SetCroppingScale(double x, double y, double z)
{
  this->CroppingScale[0] = x;
  this->CroppingScale[1] = y;
  this->CroppingScale[2] = z;
}

void vtkBanyanVolumeRepresentation::SetCroppingScale(double scale[3])
{
  this->SetCroppingScale(scale[0], scale[1], scale[2]);
}

void vtkBanyanVolumeRepresentation::SetMeshTolerance(double tolerance)
{
  this->Mapper->SetMeshTolerance(tolerance);
}

void vtkBanyanVolumeRepresentation::SetCompositing(int method)
{
  this->Mapper->SetCompositing(method);
}

void vtkBanyanVolumeRepresentation::SetCompositeInFewBits(bool few)
{
  this->Mapper->SetCompositeInFewBits(few);
}

void vtkBanyanVolumeRepresentation::SetNumberOfThreads(int threads)
{
  this->Mapper->SetNumberOfThreads(threads);
}

void vtkBanyanVolumeRepresentation::SetLoadBalancing(int mode)
{
  this->Mapper->SetLoadBalancing(mode);
}

void vtkBanyanVolumeRepresentation::SetStatistics(vtkBanyanFrameStatistics* statistics)
{
  this->Mapper->SetStatistics(statistics);
}

void vtkBanyanVolumeRepresentation::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Mapper:\n";
  this->Mapper->PrintSelf(os, indent.GetNextIndent());
}
