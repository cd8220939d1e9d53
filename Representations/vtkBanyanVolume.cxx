// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanVolume.h"

#include "CoarseMark.h"
#include "PicturesAtHand.h"
#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanVolumeMapper.h"

#include "vtkBoundingBox.h"
#include "vtkCommand.h"
#include "vtkFXAAOptions.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOpenGLFXAAFilter.h"
#include "vtkOpenGLRenderer.h"
#include "vtkOpenGLState.h"
#include "vtkOrderedCompositingHelper.h"
#include "vtkPVRenderView.h"
#include "vtkPVRenderViewDataDeliveryManager.h"
#include "vtkPropCollection.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

vtkStandardNewMacro(vtkBanyanVolume);

vtkBanyanVolume::vtkBanyanVolume() = default;
vtkBanyanVolume::~vtkBanyanVolume() = default;

void vtkBanyanVolume::SetBanyanMapper(vtkBanyanVolumeMapper* mapper)
{
  this->BanyanMapper = mapper;
}

void vtkBanyanVolume::SetView(vtkPVRenderView* view)
{
  this->View = view;
}

void vtkBanyanVolume::SetPictures(const std::shared_ptr<banyan::PicturesAtHand>& pictures)
{
  this->Pictures = pictures;
}

bool vtkBanyanVolume::CanDrawInView()
{
  return !this->View || !(this->View->InTileDisplayMode() || this->View->InCaveDisplayMode());
}

int vtkBanyanVolume::RenderOpaqueGeometry(vtkViewport* viewport)
{
  // VTK smooths edges (FXAA) before volumes are drawn, ParaView on several ranks after everything
  // is. For one picture on any number of ranks, a single rank does as many do.
  auto* renderer = vtkOpenGLRenderer::SafeDownCast(viewport);
  if (renderer && renderer->GetUseFXAA() && !renderer->GetSelector() && this->CanDrawInView())
  {
    renderer->SetUseFXAA(false);
    this->SmoothAtEnd =
      renderer->AddObserver(vtkCommand::EndEvent, this, &vtkBanyanVolume::SmoothEdges);
  }
  return 0;
}

void vtkBanyanVolume::SmoothEdges(vtkObject* caller, unsigned long, void*)
{
  auto* renderer = vtkOpenGLRenderer::SafeDownCast(caller);
  renderer->RemoveObserver(this->SmoothAtEnd);
  renderer->SetUseFXAA(true);
  if (this->BanyanMapper && this->BanyanMapper->ShowsCoarsePicture() &&
      renderer->GetRenderWindow()->GetDesiredUpdateRate() > 1.0)
  {
    return; // it takes as long as the picture, and nobody sees it while the camera moves
  }
  if (!this->EdgeFilter)
  {
    this->EdgeFilter = vtkSmartPointer<vtkOpenGLFXAAFilter>::New();
  }
  if (renderer->GetFXAAOptions())
  {
    this->EdgeFilter->UpdateConfiguration(renderer->GetFXAAOptions());
  }
  int width = 0;
  int height = 0;
  int x = 0;
  int y = 0;
  renderer->GetTiledSizeAndOrigin(&width, &height, &x, &y);
  vtkOpenGLState* state = renderer->GetState();
  vtkOpenGLState::ScopedglViewport viewport(state);
  vtkOpenGLState::ScopedglScissor scissor(state);
  state->vtkglViewport(x, y, width, height);
  state->vtkglScissor(x, y, width, height);
  this->EdgeFilter->Execute(renderer);
}

int vtkBanyanVolume::RenderVolumetricGeometry(vtkViewport*)
{
  return 0;
}

int vtkBanyanVolume::RenderTranslucentPolygonalGeometry(vtkViewport*)
{
  return 0;
}

vtkTypeBool vtkBanyanVolume::HasTranslucentPolygonalGeometry()
{
  return 0;
}

int vtkBanyanVolume::RenderOverlay(vtkViewport* viewport)
{
  vtkRenderer* renderer = vtkRenderer::SafeDownCast(viewport);
  if (!renderer || !this->BanyanMapper || renderer->GetSelector() || !this->CanDrawInView())
  {
    return 0;
  }
  if (this->Pictures)
  {
    this->ShowPictures(renderer);
    return 1;
  }
  std::vector<int> order;
  if (this->View)
  {
    auto* delivery =
      vtkPVRenderViewDataDeliveryManager::SafeDownCast(this->View->GetDeliveryManager());
    if (delivery && this->View->GetUseOrderedCompositing())
    {
      vtkNew<vtkOrderedCompositingHelper> helper;
      helper->SetBoundingBoxes(delivery->GetCuts());
      order = helper->ComputeSortOrder(renderer->GetActiveCamera());
    }
  }
  this->BanyanMapper->SetRankOrderBehind(order);
  this->BanyanMapper->Render(renderer, this);
  this->MarkUnless(this->BanyanMapper->GetStatistics()->GetPictureIsExact() != 0, renderer);
  return 1;
}

/// Of all volumes of the view, together: the first one that VTK renders shows them.
void vtkBanyanVolume::ShowPictures(vtkRenderer* renderer)
{
  std::vector<banyan::PicturesAtHand*> pictures;
  std::vector<vtkVolume*> props;
  vtkPropCollection* const all = renderer->GetViewProps();
  vtkCollectionSimpleIterator at;
  all->InitTraversal(at);
  while (vtkProp* const prop = all->GetNextProp(at))
  {
    auto* const volume = vtkBanyanVolume::SafeDownCast(prop);
    if (volume && volume->Pictures && volume->GetVisibility())
    {
      pictures.push_back(volume->Pictures.get());
      props.push_back(volume);
    }
  }
  if (props.empty() || props.front() != this)
  {
    return;
  }
  try
  {
    const std::string note = banyan::PicturesAtHand::Show(renderer, pictures, props);
    if (!note.empty())
    {
      vtkWarningMacro(<< note);
    }
  }
  catch (const std::exception& error)
  {
    vtkErrorMacro(<< "The volume is not shown. " << error.what());
    return;
  }
  for (vtkVolume* const prop : props)
  {
    auto* const volume = static_cast<vtkBanyanVolume*>(prop);
    volume->MarkUnless(volume->Pictures->LastShown().Exact, renderer);
  }
}

void vtkBanyanVolume::MarkUnless(bool exact, vtkRenderer* renderer)
{
  vtkMultiProcessController* const ranks = vtkMultiProcessController::GetGlobalController();
  if (exact || !this->MarksCoarse || (ranks && ranks->GetLocalProcessId() != 0))
  {
    return;
  }
  if (!this->Mark)
  {
    this->Mark = std::make_unique<banyan::CoarseMark>();
  }
  this->Mark->Write(renderer);
}

double* vtkBanyanVolume::GetBounds()
{
  if (this->Pictures)
  {
    return nullptr; // data are elsewhere; bounds that are none would have the prop left out
  }
  vtkMath::UninitializeBounds(this->Bounds);
  const double* box = this->BanyanMapper ? this->BanyanMapper->GetBounds() : nullptr;
  if (!box || !vtkMath::AreBoundsInitialized(box))
  {
    return this->Bounds;
  }
  vtkBoundingBox world;
  for (int corner = 0; corner < 8; ++corner)
  {
    const double point[4] = { box[corner & 1], box[2 + ((corner >> 1) & 1)],
      box[4 + ((corner >> 2) & 1)], 1.0 };
    double moved[4];
    this->GetMatrix()->MultiplyPoint(point, moved);
    world.AddPoint(moved);
  }
  world.GetBounds(this->Bounds);
  return this->Bounds;
}

void vtkBanyanVolume::ReleaseGraphicsResources(vtkWindow* window)
{
  if (this->BanyanMapper)
  {
    this->BanyanMapper->ReleaseGraphicsResources(window);
  }
  if (this->EdgeFilter)
  {
    this->EdgeFilter->ReleaseGraphicsResources();
  }
  if (this->Pictures)
  {
    this->Pictures->ReleaseGraphicsResources(window);
  }
  if (this->Mark)
  {
    this->Mark->ReleaseGraphicsResources(window);
  }
  this->Superclass::ReleaseGraphicsResources(window);
}

void vtkBanyanVolume::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "BanyanMapper: " << this->BanyanMapper.GetPointer() << "\n"
     << indent << "View: " << this->View.GetPointer() << "\n";
}
