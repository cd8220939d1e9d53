// SPDX-License-Identifier: BSD-3-Clause
#include "vtkBanyanVolume.h"

#include "CoarseMark.h"
#include "FramebufferExchange.h"
#include "PicturesAtHand.h"
#include "WallBox.h"
#include "WallOfRanks.h"
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
#include "vtkProcessModule.h"
#include "vtkPropCollection.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"

#include <algorithm>
#include <utility>

namespace
{

/// The visible ones.
std::vector<vtkBanyanVolume*> VolumesOf(vtkRenderer* renderer)
{
  std::vector<vtkBanyanVolume*> volumes;
  vtkPropCollection* const all = renderer->GetViewProps();
  vtkCollectionSimpleIterator at;
  all->InitTraversal(at);
  while (vtkProp* const prop = all->GetNextProp(at))
  {
    auto* const volume = vtkBanyanVolume::SafeDownCast(prop);
    if (volume && volume->GetVisibility() != 0)
    {
      volumes.push_back(volume);
    }
  }
  return volumes;
}

} // namespace

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

bool vtkBanyanVolume::IsOnWall() const
{
  return banyan::IsWall(this->View);
}

void vtkBanyanVolume::ShowBox(vtkDataObject* corners)
{
  if (!this->Box)
  {
    this->Box = std::make_unique<banyan::WallBox>();
  }
  this->Box->Set(corners);
}

void vtkBanyanVolume::DrawWhenEnded(vtkRenderer* renderer)
{
  // ParaView puts the picture of other data into the window at 0.
  constexpr float beforeParaView = 1.0f;
  constexpr float afterParaView = -1.0f;
  for (const unsigned long observer : this->OfWatched)
  {
    if (this->Watched)
    {
      this->Watched->RemoveObserver(observer);
    }
  }
  this->Watched = renderer;
  if (renderer)
  {
    this->OfWatched = { renderer->AddObserver(
                          vtkCommand::EndEvent, this, &vtkBanyanVolume::ReadDepths, beforeParaView),
      renderer->AddObserver(
        vtkCommand::EndEvent, this, &vtkBanyanVolume::DrawOnWall, afterParaView) };
  }
}

/// On ranks of a server: the same on all of them.
bool vtkBanyanVolume::DrawsOnWall(vtkRenderer* renderer)
{
  return this->IsOnWall() && this->BanyanMapper && this->GetVisibility() != 0 &&
         !renderer->GetSelector() &&
         vtkProcessModule::GetProcessType() != vtkProcessModule::PROCESS_CLIENT;
}

/// The first volume does that.
bool vtkBanyanVolume::DrawsForAll(vtkRenderer* renderer)
{
  const std::vector<vtkBanyanVolume*> volumes = VolumesOf(renderer);
  const auto first = std::find_if(volumes.begin(), volumes.end(),
    [&](vtkBanyanVolume* volume) { return volume->DrawsOnWall(renderer); });
  if (first == volumes.end() || *first != this)
  {
    return false;
  }
  if (!this->Framebuffer)
  {
    this->Framebuffer = std::make_unique<banyan::FramebufferExchange>();
  }
  return true;
}

/// Ranks are called for tiles that they have something for: as often as that is, without the
/// others.
void vtkBanyanVolume::KeepDrawnPart(vtkRenderer* renderer)
{
  if (banyan::NeedsDrawnParts(this->View) && this->DrawsForAll(renderer))
  {
    this->Drawn.push_back(banyan::DepthsOfCall(renderer, *this->Framebuffer));
  }
}

void vtkBanyanVolume::ReadDepths(vtkObject* caller, unsigned long, void*)
{
  auto* const renderer = vtkRenderer::SafeDownCast(caller);
  this->Depths.reset();
  if (this->DrawsForAll(renderer))
  {
    this->Depths =
      std::make_unique<banyan::DepthPicture>(banyan::DepthsInCave(this->View, *this->Framebuffer));
  }
}

/// Collective over the ranks of a server. The first volume that is called draws all.
void vtkBanyanVolume::DrawOnWall(vtkObject* caller, unsigned long, void*)
{
  auto* const renderer = vtkRenderer::SafeDownCast(caller);
  const std::vector<banyan::DrawnPart> drawn = std::move(this->Drawn);
  this->Drawn.clear();
  if (!this->DrawsOnWall(renderer) || !this->Depths)
  {
    return;
  }
  vtkMultiProcessController* const ranks = this->BanyanMapper->GetController();
  const banyan::WallOfRanks wall = banyan::LookAtWall(this->View, ranks, *this->Depths, drawn);
  if (wall.Note != this->WallNote)
  {
    this->WallNote = wall.Note;
    if (!wall.Note.empty() && ranks->GetLocalProcessId() == 0)
    {
      vtkWarningMacro(<< wall.Note);
    }
  }
  this->BanyanMapper->RenderOnWall(renderer, this, wall.Pictures, wall.Own);
}

int vtkBanyanVolume::RenderOpaqueGeometry(vtkViewport* viewport)
{
  // VTK smooths edges (FXAA) before volumes are drawn, ParaView on several ranks after everything
  // is. For one picture on any number of ranks, a single rank does as many do.
  auto* renderer = vtkOpenGLRenderer::SafeDownCast(viewport);
  if (renderer && this->Box && this->IsOnWall() && !renderer->GetSelector())
  {
    this->Box->Render(renderer, this->GetMatrix());
    return 1;
  }
  if (renderer && renderer->GetUseFXAA() && !renderer->GetSelector() && !this->IsOnWall())
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
  if (!renderer || !this->BanyanMapper || renderer->GetSelector())
  {
    return 0;
  }
  if (this->IsOnWall())
  {
    this->KeepDrawnPart(renderer);
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

/// Of all volumes of the view, together: the first one shows them.
void vtkBanyanVolume::ShowPictures(vtkRenderer* renderer)
{
  std::vector<banyan::PicturesAtHand*> pictures;
  std::vector<vtkVolume*> props;
  for (vtkBanyanVolume* const volume : VolumesOf(renderer))
  {
    if (volume->Pictures)
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
  // Where several processes render, ParaView puts together what lies in the bounds of data.
  const bool isPart = this->View && this->View->GetUseDistributedRenderingForRender();
  this->Mark->Write(renderer, isPart ? this->GetBounds() : nullptr);
}

double* vtkBanyanVolume::GetBounds()
{
  if (this->Pictures)
  {
    return nullptr; // data are elsewhere; bounds that are none would have the prop left out
  }
  vtkMath::UninitializeBounds(this->Bounds);
  const double* const box = this->Box            ? this->Box->Bounds().data()
                            : this->BanyanMapper ? this->BanyanMapper->GetBounds()
                                                 : nullptr;
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
  if (this->Framebuffer)
  {
    this->Framebuffer->ReleaseGraphicsResources(window);
  }
  if (this->Box)
  {
    this->Box->ReleaseGraphicsResources(window);
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
