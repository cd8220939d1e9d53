// SPDX-License-Identifier: BSD-3-Clause
#include "vtkSMBanyanVolumeProxy.h"

#include "LiveFunctions.h"
#include "OptionsWithoutEffect.h"
#include "PictureTicket.h"
#include "RendererCamera.h"
#include "ServableView.h"
#include "ServedVolume.h"
#include "vtkBanyanVolumeRepresentation.h"

#include "Render/Raycast/DepthOrder.h"

#include "vtkClientServerStream.h"
#include "vtkCommand.h"
#include "vtkDataObject.h"
#include "vtkMath.h"
#include "vtkMultiProcessController.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkPVDataInformation.h"
#include "vtkPVSession.h"
#include "vtkSMArrayListDomain.h"
#include "vtkSMPVRepresentationProxy.h"
#include "vtkSMProperty.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMProxyManager.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionProxyManager.h"
#include "vtkSMTransferFunctionManager.h"
#include "vtkSMViewProxy.h"

#include <set>
#include <string>

vtkStandardNewMacro(vtkSMBanyanVolumeProxy);

namespace
{

/// Point arrays come first: cells of images are not drawn.
unsigned int FirstArray(vtkSMArrayListDomain* arrays)
{
  for (unsigned int i = 0; i < arrays->GetNumberOfStrings(); ++i)
  {
    if (arrays->GetFieldAssociation(i) == vtkDataObject::POINT)
    {
      return i;
    }
  }
  return 0;
}

bool IsUsedByAnother(vtkSMProxy* map, vtkSMProxy* display)
{
  for (unsigned int i = 0; i < map->GetNumberOfConsumers(); ++i)
  {
    vtkSMProxy* const consumer = map->GetConsumerProxy(i);
    vtkSMProxy* const whole = consumer ? consumer->GetTrueParentProxy() : nullptr;
    if (whole != display && vtkSMPVRepresentationProxy::SafeDownCast(whole))
    {
      return true;
    }
  }
  return false;
}

/// Only the window keeps what can be undone.
bool IsInWindow()
{
  return vtkSMProxyManager::GetProxyManager()->GetUndoStackBuilder() != nullptr;
}

std::set<vtkSMProxy*> ViewsOf(vtkSMProxy* display)
{
  std::set<vtkSMProxy*> views;
  for (unsigned int i = 0; i < display->GetNumberOfConsumers(); ++i)
  {
    vtkSMProxy* const consumer = display->GetConsumerProxy(i);
    if (vtkSMViewProxy::SafeDownCast(consumer))
    {
      views.insert(consumer);
    }
  }
  return views;
}

} // namespace

vtkSMBanyanVolumeProxy::vtkSMBanyanVolumeProxy() = default;

vtkSMBanyanVolumeProxy::~vtkSMBanyanVolumeProxy()
{
  if (this->View)
  {
    this->View->RemoveObserver(this->ViewObserver);
  }
}

void vtkSMBanyanVolumeProxy::PrintSelf(ostream& os, vtkIndent indent)
{
  this->Superclass::PrintSelf(os, indent);
}

void vtkSMBanyanVolumeProxy::CreateVTKObjects()
{
  const bool existed = this->ObjectsCreated != 0;
  this->Superclass::CreateVTKObjects();
  vtkSMPVRepresentationProxy* const display = this->Display();
  vtkSMProperty* const type = display ? display->GetProperty("Representation") : nullptr;
  if (!existed && type)
  {
    type->AddObserver(vtkCommand::ModifiedEvent, this, &vtkSMBanyanVolumeProxy::TypeChanged);
    for (const char* const name : { "ColorArrayName", "LookupTable" })
    {
      if (vtkSMProperty* const colors = display->GetProperty(name))
      {
        colors->AddObserver(
          vtkCommand::ModifiedEvent, this, &vtkSMBanyanVolumeProxy::ColorsChanged);
      }
    }
  }
}

vtkSMPVRepresentationProxy* vtkSMBanyanVolumeProxy::Display()
{
  return vtkSMPVRepresentationProxy::SafeDownCast(this->GetTrueParentProxy());
}

bool vtkSMBanyanVolumeProxy::IsShown()
{
  vtkSMPVRepresentationProxy* const display = this->Display();
  const char* const type =
    display ? vtkSMPropertyHelper(display, "Representation").GetAsString() : nullptr;
  return type && std::string(type) == "Banyan Volume";
}

void vtkSMBanyanVolumeProxy::ViewUpdated(vtkSMProxy* view)
{
  this->Superclass::ViewUpdated(view);
  if (this->View != view)
  {
    if (this->View)
    {
      this->View->RemoveObserver(this->ViewObserver);
    }
    this->View = view;
    auto* const window = vtkSMRenderViewProxy::SafeDownCast(view);
    this->Served =
      banyan::HasServer(window) ? std::make_unique<banyan::ServedVolume>(this, window) : nullptr;
    this->ViewObserver =
      view->AddObserver(vtkCommand::EndEvent, this, &vtkSMBanyanVolumeProxy::FrameDrawn);
  }
  // Where each rank runs the script, each has this proxy.
  vtkMultiProcessController* const ranks = vtkMultiProcessController::GetGlobalController();
  if (!this->IsShown() || (ranks && ranks->GetLocalProcessId() != 0))
  {
    return;
  }
  for (const auto& [property, sentence] : banyan::OptionsWithoutEffect(this->Display(), view))
  {
    if (this->Said.insert(property).second)
    {
      vtkWarningMacro(<< sentence);
    }
  }
}

void vtkSMBanyanVolumeProxy::TypeChanged()
{
  vtkSMPVRepresentationProxy* const display = this->Display();
  vtkSMSessionProxyManager* const manager = this->GetSessionProxyManager();
  // A state says itself what is coloured by, "Solid Color" included.
  if (!this->IsShown() || display->GetUsingScalarColoring() || !manager ||
      manager->GetInLoadXMLState())
  {
    return;
  }
  vtkSMProperty* const chosen = display->GetProperty("ColorArrayName");
  auto* const arrays = chosen ? chosen->FindDomain<vtkSMArrayListDomain>() : nullptr;
  if (!arrays || arrays->GetNumberOfStrings() == 0)
  {
    return;
  }
  const unsigned int first = FirstArray(arrays);
  if (!display->SetScalarColoring(arrays->GetString(first), arrays->GetFieldAssociation(first)))
  {
    return;
  }
  vtkSMProxy* const map = vtkSMPropertyHelper(display, "LookupTable").GetAsProxy();
  // The range of a map that was made for this display, by a script, is what the script wants.
  const bool isNew =
    map && vtkSMPropertyHelper(map, "ScalarRangeInitialized", true).GetAsDouble() == 0.0;
  if (map && (isNew || IsUsedByAnother(map, display)))
  {
    display->RescaleTransferFunctionToDataRange(/*extend=*/true, /*force=*/false);
  }
  // The window shows a scalar bar of "Volume", which it knows by name. Scripts get one of neither.
  if (IsInWindow())
  {
    for (vtkSMProxy* const view : ViewsOf(display))
    {
      display->SetScalarBarVisibility(view, true);
    }
    this->MapOfBar = map;
  }
}

void vtkSMBanyanVolumeProxy::ColorsChanged()
{
  if (!this->MapOfBar)
  {
    return;
  }
  vtkNew<vtkSMTransferFunctionManager> bars;
  for (vtkSMProxy* const view : ViewsOf(this->Display()))
  {
    // Where something else has colours of the map, the bar stays.
    bars->HideScalarBarIfNotNeeded(this->MapOfBar, view);
  }
}

void vtkSMBanyanVolumeProxy::FrameDrawn(vtkObject*, unsigned long, void* interactive)
{
  const bool isMoving = interactive && *static_cast<int*>(interactive) != 0;
  // Scripts ask for them themselves.
  const bool isServed = this->Served && this->Served->IsServed();
  if (!isMoving && !isServed && IsInWindow() && this->IsShown())
  {
    this->FetchStatistics();
  }
}

void vtkSMBanyanVolumeProxy::FetchStatistics()
{
  if (vtkSMProxy* const statistics = this->GetSubProxy("Statistics"))
  {
    statistics->UpdatePropertyInformation();
  }
}

bool vtkSMBanyanVolumeProxy::IsDecoupled()
{
  return this->IsShown() && vtkSMPropertyHelper(this, "Decoupled").GetAsInt() != 0;
}

bool vtkSMBanyanVolumeProxy::MixesVolumes()
{
  return vtkSMPropertyHelper(this, "MixVolumes").GetAsInt() != 0;
}

std::vector<banyan::PlacedBox> vtkSMBanyanVolumeProxy::GetBody()
{
  auto* const display = vtkBanyanVolumeRepresentation::SafeDownCast(this->GetClientSideObject());
  vtkPVDataInformation* const data = this->GetRepresentedDataInformation();
  if (!display || !data || !vtkMath::AreBoundsInitialized(data->GetBounds()))
  {
    return {};
  }
  const double* const bounds = data->GetBounds();
  return { banyan::PlaceBox({ bounds[0], bounds[2], bounds[4] },
    { bounds[1], bounds[3], bounds[5] }, banyan::ToGlm(display->GetPlace())) };
}

void vtkSMBanyanVolumeProxy::SetServed(bool served, vtkSMProxy* view)
{
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(this) << "SetServed" << (served ? 1 : 0)
         << vtkClientServerStream::End;
  this->ExecuteStream(stream);
  view->MarkDirty(this);
}

void vtkSMBanyanVolumeProxy::SendTicket(const banyan::PictureTicket& ticket)
{
  const auto numbers = ticket.ToNumbers();
  const std::vector<unsigned int> words = ticket.DepthWords();
  vtkClientServerStream stream;
  stream << vtkClientServerStream::Invoke << VTKOBJECT(this) << "TakeTicket"
         << vtkClientServerStream::InsertArray(numbers.data(), static_cast<int>(numbers.size()))
         << static_cast<unsigned int>(words.size())
         << vtkClientServerStream::InsertArray(words.data(), static_cast<int>(words.size()))
         << vtkClientServerStream::End;
  this->ExecuteStream(stream, /*ignore_errors=*/false, vtkPVSession::RENDER_SERVER);
}

void vtkSMBanyanVolumeProxy::SendFunctions()
{
  vtkClientServerStream stream;
  banyan::LiveFunctions::AppendPoints(this->GetTrueParentProxy(), stream);
  this->ExecuteStream(stream, /*ignore_errors=*/false, vtkPVSession::RENDER_SERVER);
}

vtkMTimeType vtkSMBanyanVolumeProxy::GetPictureMTime()
{
  auto* const display = vtkBanyanVolumeRepresentation::SafeDownCast(this->GetClientSideObject());
  return display ? display->GetPictureMTime() : 0;
}

std::shared_ptr<banyan::PicturesAtHand> vtkSMBanyanVolumeProxy::GetPictures()
{
  auto* const display = vtkBanyanVolumeRepresentation::SafeDownCast(this->GetClientSideObject());
  return display ? display->GetPictures() : nullptr;
}
