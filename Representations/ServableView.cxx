// SPDX-License-Identifier: BSD-3-Clause
#include "ServableView.h"

#include "PictureTicket.h"
#include "RenderWhenDrawn.h"

#include "vtkPVRenderView.h"
#include "vtkPVSession.h"
#include "vtkPVXMLElement.h"
#include "vtkRenderWindow.h"
#include "vtkSMCameraLink.h"
#include "vtkSMPropertyHelper.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionClient.h"
#include "vtkSMSessionProxyManager.h"

#include <string>

namespace banyan
{
namespace
{

bool IsOn(vtkSMProxy* proxy, const char* property)
{
  vtkSMProperty* const found = proxy ? proxy->GetProperty(property) : nullptr;
  return found && vtkSMPropertyHelper(found).GetAsInt() != 0;
}

} // namespace

std::set<vtkSMProxy*> VolumesIn(vtkSMRenderViewProxy* view)
{
  std::set<vtkSMProxy*> volumes;
  const vtkSMPropertyHelper all(view, "Representations");
  for (unsigned int i = 0; i < all.GetNumberOfElements(); ++i)
  {
    vtkSMProxy* const display = all.GetAsProxy(i);
    vtkSMProperty* const kind = display ? display->GetProperty("Representation") : nullptr;
    if (kind && IsOn(display, "Visibility") &&
        std::string(vtkSMPropertyHelper(kind).GetAsString()) == "Banyan Volume")
    {
      volumes.insert(display);
    }
  }
  return volumes;
}

bool KnowsTickets(vtkSMProxy* volume)
{
  vtkPVXMLElement* const hints = volume->GetHints();
  vtkPVXMLElement* const tickets =
    hints ? hints->FindNestedElementByName("BanyanTickets") : nullptr;
  int version = 0;
  return tickets && tickets->GetScalarAttribute("version", &version) &&
         version == PictureTicket::Version;
}

vtkPVRenderView* OfClient(vtkSMRenderViewProxy* view)
{
  return view ? vtkPVRenderView::SafeDownCast(view->GetClientSideObject()) : nullptr;
}

vtkSMSessionClient* SessionOf(vtkSMProxy* proxy)
{
  return proxy ? vtkSMSessionClient::SafeDownCast(proxy->GetSession()) : nullptr;
}

bool HasServer(vtkSMRenderViewProxy* view)
{
  vtkSMSessionClient* const session = SessionOf(view);
  if (!session || !OfClient(view) || session->IsMultiClients())
  {
    return false;
  }
  vtkMultiProcessController* const server =
    session->GetController(vtkPVSession::RENDER_SERVER_ROOT);
  return server && server == session->GetController(vtkPVSession::DATA_SERVER_ROOT);
}

bool IsServable(vtkSMRenderViewProxy* view)
{
  vtkPVRenderView* const drawn = OfClient(view);
  vtkRenderWindow* const window = view->GetRenderWindow();
  // A window that does not swap its buffers is one that somebody wants to save. A threshold of 0
  // says that the server is to render whatever there is.
  return HasServer(view) && window && window->GetSwapBuffers() != 0 &&
         window->GetStereoRender() == 0 && RenderWhenDrawn::CanWatch(window) &&
         !drawn->InTileDisplayMode() && !drawn->InCaveDisplayMode() &&
         drawn->GetRemoteRenderingThreshold() > 0.0;
}

bool IsIdle(vtkSMProxy* proxy)
{
  vtkSMSessionClient* const session = SessionOf(proxy);
  return session && session->GetIsAlive() && !session->GetPendingProgress();
}

bool IsRemote(vtkSMRenderViewProxy* view)
{
  vtkPVRenderView* const drawn = OfClient(view);
  return !drawn || drawn->GetUseDistributedRenderingForRender() ||
         (drawn->GetUseLODForInteractiveRender() &&
           drawn->GetUseDistributedRenderingForLODRender());
}

bool IsLinked(vtkSMRenderViewProxy* view)
{
  vtkSMSessionProxyManager* const all = view->GetSessionProxyManager();
  for (int i = 0; i < all->GetNumberOfLinks(); ++i)
  {
    auto* const link = vtkSMCameraLink::SafeDownCast(all->GetRegisteredLink(all->GetLinkName(i)));
    for (int k = 0; link && k < static_cast<int>(link->GetNumberOfLinkedObjects()); ++k)
    {
      if (link->GetLinkedProxy(k) == view)
      {
        return true;
      }
    }
  }
  return false;
}

bool StepWatch::Plays(double time)
{
  constexpr double soon = 1.0; // seconds
  const bool isSoon = this->SinceStep.Seconds() < soon;
  if (time != this->Time)
  {
    this->Playing = isSoon;
    this->Time = time;
    this->SinceStep = Timer();
  }
  return this->Playing && isSoon;
}

} // namespace banyan
