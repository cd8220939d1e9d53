// SPDX-License-Identifier: BSD-3-Clause
#include "ServedWindow.h"

#include "LineToClient.h"
#include "ServedVolume.h"

#include "vtkCamera.h"
#include "vtkCommand.h"
#include "vtkPVRenderView.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkSMRenderViewProxy.h"

#include <glm/matrix.hpp>

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

namespace banyan
{
namespace
{

constexpr double PumpSeconds = 0.006;   ///< that messages are read for at a time
constexpr double DrawSeconds = 0.05;    ///< from one better picture to the next, at least
constexpr double RestSeconds = 0.1;     ///< without a move, until the camera counts as at rest
constexpr unsigned long LookEvery = 10; ///< milliseconds
constexpr float BeforeParaView = 1.0f;  ///< priority of an observer

} // namespace

std::shared_ptr<ServedWindow> ServedWindow::Of(vtkSMRenderViewProxy* view)
{
  static std::map<vtkSMRenderViewProxy*, std::weak_ptr<ServedWindow>> windows;
  for (auto at = windows.begin(); at != windows.end();)
  {
    at = at->second.expired() ? windows.erase(at) : std::next(at);
  }
  std::weak_ptr<ServedWindow>& place = windows[view];
  std::shared_ptr<ServedWindow> window = place.lock();
  if (!window || window->View != view) // a view that is gone may have been at this address
  {
    window = std::make_shared<ServedWindow>(view);
    place = window;
  }
  return window;
}

ServedWindow::ServedWindow(vtkSMRenderViewProxy* view)
  : View(view)
  , Steps(OfClient(view)->GetViewTime())
{
  this->Observe();
  this->OfView = { view->AddObserver(vtkCommand::StartEvent, this, &ServedWindow::BeforeRender),
    view->AddObserver(vtkCommand::EndEvent, this, &ServedWindow::AfterRender) };
}

ServedWindow::~ServedWindow()
{
  this->Ignore();
  if (this->View)
  {
    for (const unsigned long observer : this->OfView)
    {
      this->View->RemoveObserver(observer);
    }
  }
}

void ServedWindow::Remove(ServedVolume* volume)
{
  this->Volumes.erase(
    std::remove(this->Volumes.begin(), this->Volumes.end(), volume), this->Volumes.end());
}

/// Observes the interactor that the window has now.
void ServedWindow::Observe()
{
  vtkRenderWindowInteractor* const interactor = this->View->GetInteractor();
  if (interactor == this->Interactor)
  {
    return;
  }
  this->Ignore();
  this->Interactor = interactor;
  if (!interactor)
  {
    return;
  }
  this->OfInteractor = { interactor->AddObserver(
                           vtkCommand::RenderEvent, this, &ServedWindow::Move, BeforeParaView),
    interactor->AddObserver(vtkCommand::StartInteractionEvent, this, &ServedWindow::BeginMoves),
    interactor->AddObserver(
      vtkCommand::EndInteractionEvent, this, &ServedWindow::Release, BeforeParaView),
    interactor->AddObserver(vtkCommand::TimerEvent, this, &ServedWindow::Look) };
}

void ServedWindow::Ignore()
{
  this->StopTimer();
  if (this->Interactor)
  {
    for (const unsigned long observer : this->OfInteractor)
    {
      this->Interactor->RemoveObserver(observer);
    }
  }
  this->Interactor = nullptr;
}

void ServedWindow::StartTimer()
{
  if (this->Timer < 0 && this->Interactor)
  {
    this->Timer = this->Interactor->CreateRepeatingTimer(LookEvery);
  }
}

void ServedWindow::StopTimer()
{
  if (this->Timer >= 0 && this->Interactor)
  {
    this->Interactor->DestroyTimer(this->Timer);
  }
  this->Timer = -1;
}

/// Volumes that ParaView is to draw; none while somebody's is not yet known here.
std::vector<ServedVolume*> ServedWindow::InView() const
{
  const std::set<vtkSMProxy*> seen = VolumesIn(this->View);
  std::vector<ServedVolume*> volumes;
  std::copy_if(this->Volumes.begin(), this->Volumes.end(), std::back_inserter(volumes),
    [&](const ServedVolume* volume) { return seen.count(volume->OfUser()) > 0; });
  return volumes.size() == seen.size() ? volumes : std::vector<ServedVolume*>();
}

/// Volumes that the last picture of ParaView's has shown, if their pictures come as messages.
std::vector<ServedVolume*> ServedWindow::InUse() const
{
  std::vector<ServedVolume*> volumes;
  std::copy_if(this->Volumes.begin(), this->Volumes.end(), std::back_inserter(volumes),
    [](const ServedVolume* volume) { return volume->IsServed(); });
  return volumes;
}

bool ServedWindow::HasFailed() const
{
  return std::any_of(this->Volumes.begin(), this->Volumes.end(),
    [](const ServedVolume* volume) { return volume->IsServed() && volume->HasFailed(); });
}

void ServedWindow::BeforeRender()
{
  this->Observe();
  const bool plays = this->Steps.Plays(OfClient(this->View)->GetViewTime());
  const std::vector<ServedVolume*> seen = this->InView();
  const auto servable = [](const ServedVolume* volume) { return volume->IsServable(); };
  this->Served = !plays && !seen.empty() && banyan::IsServable(this->View) &&
                 std::all_of(seen.begin(), seen.end(), servable) && !ServedVolume::AnyMixed(seen);
  for (ServedVolume* const volume : this->Volumes)
  {
    const bool isSeen = std::find(seen.begin(), seen.end(), volume) != seen.end();
    volume->Serve(this->Served && isSeen, std::max(1, static_cast<int>(seen.size())));
  }
  if (!this->Served)
  {
    this->StopTimer();
  }
}

/// After a picture of ParaView's, for which anything may have changed.
void ServedWindow::AfterRender(vtkObject*, unsigned long, void* interactive)
{
  const bool moves = interactive && *static_cast<int*>(interactive) != 0;
  this->HasLod = moves;
  this->IsDrawn = !moves;
  this->DrawnToEye = this->WorldToEye();
  this->Ahead = false;
  if (this->EndsAtRest && !moves)
  {
    this->EndMoves();
  }
  if (this->IsServed())
  {
    const ScreenView view = ViewOf(this->View->GetRenderer());
    for (ServedVolume* const volume : this->InUse())
    {
      volume->WantAnew(view, moves);
    }
    this->StartTimer();
  }
  else if (this->IsLate())
  {
    this->WaitForExact(!moves);
  }
}

/// The server has drawn what could be had at once, and works on the exact picture.
void ServedWindow::WaitForExact(bool waits)
{
  for (ServedVolume* const volume : this->Volumes)
  {
    volume->WaitForExact(waits && volume->Serves());
  }
  waits ? this->StartTimer() : this->StopTimer();
}

/// Once all exact pictures are there, ParaView asks for its own once more.
void ServedWindow::LookForExact()
{
  bool comes = false;
  bool isThere = false;
  for (ServedVolume* const volume : this->Volumes)
  {
    comes = volume->GoOnWithExact() || comes;
    isThere = isThere || volume->HasExactNews() || (volume->Serves() && volume->HasFailed());
  }
  if (!comes)
  {
    this->StopTimer();
  }
  if (!comes && isThere && !this->View->GetNeedsUpdate())
  {
    this->View->StillRender();
  }
}

/// Whether the window may have the server draw, outside of a picture of ParaView's.
bool ServedWindow::MayAsk() const
{
  return this->IsServed() && !this->HasFailed() && !this->Busy && !this->View->GetNeedsUpdate() &&
         IsIdle(this->View) && !IsLinked(this->View);
}

/// In place of a picture of ParaView's while the camera moves, which would wait for the server.
bool ServedWindow::Move(vtkObject*, unsigned long, void*)
{
  if (!this->MayAsk())
  {
    return false;
  }
  const bool byWidget = !this->Moving && this->WorldToEye() != this->DrawnToEye;
  if (!this->Moving && !byWidget)
  {
    return false;
  }
  vtkPVRenderView* const view = OfClient(this->View);
  if (view->GetUseLODForInteractiveRender() && !this->HasLod)
  {
    return false; // ParaView delivers coarse data for this picture, which the next ones show
  }
  if (byWidget)
  {
    this->BeginMoves();
    this->EndsAtRest = true;
  }
  view->ResetCameraClippingRange();
  this->DrawAlone(/*exact=*/false);
  this->SinceMove = banyan::Timer();
  this->Want(this->Soon(ViewOf(this->View->GetRenderer())), /*moves=*/true);
  this->StartTimer();
  return true;
}

void ServedWindow::BeginMoves()
{
  this->Moving = true;
  this->EndsAtRest = false;
  this->Path.Begin();
}

/// The mouse is released: ranks begin with the picture before ParaView asks for its own, which
/// takes a round trip. Depths of other data are sent once, after that.
void ServedWindow::Release()
{
  this->EndMoves();
  if (this->MayAsk() && !this->HasOthersInView())
  {
    this->ReadPictures(); // until these are read, no other may be asked for
    this->Want(ViewOf(this->View->GetRenderer()), /*moves=*/false);
  }
}

glm::dmat4 ServedWindow::WorldToEye() const
{
  return ToGlm(this->View->GetRenderer()->GetActiveCamera()->GetViewTransformMatrix());
}

void ServedWindow::Want(const ScreenView& view, bool moves)
{
  for (ServedVolume* const volume : this->InUse())
  {
    volume->Want(view, moves, /*mayHaveChanged=*/false);
  }
}

/// What will be seen when a picture of it is here, if the camera goes on as it does.
ScreenView ServedWindow::Soon(const ScreenView& now)
{
  const glm::dmat4 toEye = this->WorldToEye();
  this->Path.Add(toEye, this->Clock.Seconds());
  double seconds = 0.0;
  for (const ServedVolume* const volume : this->InUse())
  {
    seconds = std::max(seconds, volume->Lag());
  }
  const glm::dmat4 then = this->Path.After(seconds);
  this->Ahead = !this->HasOthersInView() && then != toEye;
  ScreenView soon = now;
  if (this->Ahead)
  {
    // What is before the near plane now may be behind it then: that plane goes half-way to the eye.
    glm::dmat4 nearer(1.0);
    nearer[2][2] = 0.5;
    nearer[3][2] = 0.5;
    soon.WorldToClip = nearer * now.WorldToClip * glm::inverse(toEye) * then;
  }
  return soon;
}

/// Whether some may be: their depths are those of the view as it is.
bool ServedWindow::HasOthersInView() const
{
  return std::any_of(this->Volumes.begin(), this->Volumes.end(),
    [](const ServedVolume* volume) { return volume->IsServed() && volume->HasOthersInView(); });
}

void ServedWindow::DrawAlone(bool exact)
{
  vtkPVRenderView* const view = OfClient(this->View);
  this->Busy = true;
  for (ServedVolume* const volume : this->Volumes)
  {
    volume->WillBeShown();
  }
  if (exact)
  {
    view->StillRender();
  }
  else
  {
    // Smoothing edges takes as long as all the rest, and nobody sees it in motion.
    const bool smooths = view->GetUseFXAA();
    view->SetUseFXAA(false);
    view->InteractiveRender();
    view->SetUseFXAA(smooths);
  }
  this->Busy = false;
  this->IsDrawn = exact;
  this->DrawnToEye = this->WorldToEye();
  this->SinceDrawn = banyan::Timer();
}

/// Now and then: takes pictures that have come, shows them, and has the server go on.
void ServedWindow::Look(vtkObject*, unsigned long, void* timer)
{
  if (*static_cast<int*>(timer) != this->Timer || this->Busy)
  {
    return;
  }
  const std::shared_ptr<ServedWindow> stays = this->shared_from_this();
  if ((this->IsServed() || this->IsLate()) && IsIdle(this->View))
  {
    this->ReadPictures();
  }
  if (this->IsLate())
  {
    if (IsIdle(this->View))
    {
      this->LookForExact();
    }
    return;
  }
  if (!this->IsServed())
  {
    this->StopTimer(); // a picture of ParaView's starts it again
    return;
  }
  if (!IsIdle(this->View))
  {
    return;
  }
  if (this->HasFailed())
  {
    this->StopTimer();
    this->Interactor->InvokeEvent(vtkCommand::RenderEvent);
    return;
  }
  if (this->EndsAtRest && this->SinceMove.Seconds() > RestSeconds)
  {
    this->View->StillRender(); // as ParaView does when the mouse is released
    return;
  }
  this->ShowPictures();
}

void ServedWindow::ReadPictures()
{
  this->Busy = true;
  const bool all = ReadMessages(PumpSeconds);
  this->Busy = false;
  for (ServedVolume* const volume : this->Volumes)
  {
    if (all)
    {
      volume->NoteAllRead();
    }
  }
}

void ServedWindow::ShowPictures()
{
  if (this->Ahead && (this->SinceMove.Seconds() > RestSeconds || this->HasOthersInView()))
  {
    this->Ahead = false;
    this->Want(ViewOf(this->View->GetRenderer()), /*moves=*/true);
  }
  const std::vector<ServedVolume*> volumes = this->InUse();
  for (ServedVolume* const volume : volumes)
  {
    if (volume->HasNews())
    {
      volume->GoOn(); // the server works on it while the window draws
    }
  }
  const auto hasBetter = [](const ServedVolume* volume) { return volume->HasBetter(); };
  const auto isExact = [](const ServedVolume* volume) { return volume->HasExact(); };
  const bool exact = !this->Moving && std::all_of(volumes.begin(), volumes.end(), isExact);
  const bool waits = !exact && this->SinceDrawn.Seconds() < DrawSeconds;
  const bool better = std::any_of(volumes.begin(), volumes.end(), hasBetter);
  const bool isDrawn = this->IsDrawn || !exact;
  if ((better || !isDrawn) && !waits && !this->View->GetNeedsUpdate())
  {
    this->DrawAlone(exact);
  }
  bool goesOn = this->Ahead || this->EndsAtRest;
  for (ServedVolume* const volume : volumes)
  {
    goesOn = volume->GoOn() || goesOn;
  }
  if (!goesOn)
  {
    this->StopTimer();
  }
}

} // namespace banyan
