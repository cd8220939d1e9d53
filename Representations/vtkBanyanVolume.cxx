#include "vtkBanyanVolume.h"

#include "vtkBanyanVolumeMapper.h"

#include "vtkBoundingBox.h"
#include "vtkMath.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOrderedCompositingHelper.h"
#include "vtkPVRenderView.h"
#include "vtkPVRenderViewDataDeliveryManager.h"
#include "vtkRenderer.h"

vtkStandardNewMacro(vtkBanyanVolume);

void vtkBanyanVolume::SetBanyanMapper(vtkBanyanVolumeMapper* mapper)
{
  this->BanyanMapper = mapper;
}

void vtkBanyanVolume::SetView(vtkPVRenderView* view)
{
  this->View = view;
}

int vtkBanyanVolume::RenderOpaqueGeometry(vtkViewport*)
{
  return 0;
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
  std::vector<int> order;
  if (this->View)
  {
    if (this->View->InTileDisplayMode())
    {
      if (!this->TileDisplayReported)
      {
        vtkErrorMacro(<< "'Banyan Volume' cannot draw on tile displays: use 'Volume' there.");
        this->TileDisplayReported = true;
      }
      return 0;
    }
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
  return 1;
}

double* vtkBanyanVolume::GetBounds()
{
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
  this->Superclass::ReleaseGraphicsResources(window);
}

void vtkBanyanVolume::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
  os << indent << "BanyanMapper: " << this->BanyanMapper.GetPointer() << "\n"
     << indent << "View: " << this->View.GetPointer() << "\n";
}
