// SPDX-License-Identifier: BSD-3-Clause
#include "ServedWindow.h"

#include "LineToClient.h"
#include "vtkBanyanVolumeRepresentation.h"
#include "vtkSMBanyanVolumeProxy.h"

#include "Parallel/Composite/PackedDepths.h"
#include "Parallel/Composite/PackedPicture.h"

#include "vtkCommand.h"
#include "vtkMultiProcessController.h"
#include "vtkPVRenderView.h"
#include "vtkPVSession.h"
#include "vtkRenderWindowInteractor.h"
#include "vtkRenderer.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionClient.h"
#include "vtkSetGet.h"

#include <set>
#include <utility>

namespace banyan
{
namespace
{

constexpr double PumpSeconds = 0.006; ///< that messages are read for at a time
constexpr double GoOnSeconds = 0.04;  ///< from ticket to ticket, while a picture is missing
constexpr double CreditSeconds = 0.1; ///< that a ticket gives credit for, at most
constexpr double CoarseSeconds = 0.1; ///< that a coarse picture may be on the line, a byte a pixel
constexpr double StillSeconds = 0.1;  ///< without a move, until depths of all pixels are sent
constexpr double DrawSeconds = 0.05;  ///< from one better picture to the next, at least
constexpr int MostUnseen = 3;         ///< tickets that the server has not answered
constexpr unsigned long LookEvery = 10; ///< milliseconds
constexpr float BeforeParaView = 1.0f;  ///< priority of an observer

/// Those that there are: a picture may come for one that is gone.
std::set<void*>& Windows()
{
  static std::set<void*> windows;
  return windows;
}

int NextNumber()
{
  static int last = 0;
  return ++last;
}

} // namespace

ServedWindow::ServedWindow(vtkSMBanyanVolumeProxy* proxy, vtkSMRenderViewProxy* view)
  : Proxy(proxy)
  , View(view)
  , Server(SessionOf(view)->GetController(vtkPVSession::RENDER_SERVER_ROOT))
  , Display(NextNumber())
  , Steps(OfClient(view)->GetViewTime())
  , Functions([this] { this->FunctionsHaveChanged(); })
{
  Windows().insert(this);
  this->Observe();
  this->OfView = { view->AddObserver(vtkCommand::StartEvent, this, &ServedWindow::BeforeRender),
    view->AddObserver(vtkCommand::EndEvent, this, &ServedWindow::AfterRender) };
  this->OfDisplay = proxy->GetTrueParentProxy()->AddObserver(
    vtkCommand::PropertyModifiedEvent, this, &ServedWindow::TryAgain);
  this->Messages =
    this->Server->AddRMICallback(&ServedWindow::TakeMessage, this, PictureParcel::Tag);
}

ServedWindow::~ServedWindow()
{
  Windows().erase(this);
  this->Ignore();
  if (this->View)
  {
    for (const unsigned long observer : this->OfView)
    {
      this->View->RemoveObserver(observer);
    }
  }
  if (vtkSMProxy* const display = this->Proxy->GetTrueParentProxy())
  {
    display->RemoveObserver(this->OfDisplay);
  }
  if (this->Server)
  {
    this->Server->RemoveRMICallback(this->Messages);
  }
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
      vtkCommand::EndInteractionEvent, this, &ServedWindow::EndMoves, BeforeParaView),
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

void ServedWindow::BeforeRender()
{
  this->Observe();
  const bool plays = this->Steps.Plays(OfClient(this->View)->GetViewTime());
  const bool serves = !plays && this->Failure.empty() && IsServable(this->Proxy, this->View);
  if (serves != this->Served)
  {
    this->Served = serves;
    this->Proxy->SetServed(serves, this->View);
    this->Pictures = this->Proxy->GetPictures();
  }
  if (!serves)
  {
    this->StopTimer();
  }
}

/// After a picture of ParaView's, for which anything may have changed.
void ServedWindow::AfterRender(vtkObject*, unsigned long, void* interactive)
{
  const bool moves = interactive && *static_cast<int*>(interactive) != 0;
  this->HasLod = moves;
  this->HasOtherFunctions = false;
  if (this->IsServed())
  {
    this->Functions.Watch(this->Proxy->GetTrueParentProxy());
    this->Want(moves, /*mayHaveChanged=*/true);
    this->StartTimer();
  }
}

/// In place of a picture of ParaView's while the camera moves, which would wait for the server.
bool ServedWindow::Move(vtkObject*, unsigned long, void*)
{
  if (!this->IsServed() || !this->Moving || this->Busy || this->View->GetNeedsUpdate() ||
      !IsIdle(this->Proxy) || IsLinked(this->View))
  {
    return false;
  }
  vtkPVRenderView* const view = OfClient(this->View);
  if (view->GetUseLODForInteractiveRender() && !this->HasLod)
  {
    return false; // ParaView delivers coarse data for this picture, which the next ones show
  }
  view->ResetCameraClippingRange();
  this->DrawAlone(/*exact=*/false);
  this->Want(/*moves=*/true, /*mayHaveChanged=*/false);
  this->StartTimer();
  return true;
}

void ServedWindow::Want(bool moves, bool mayHaveChanged)
{
  const ScreenView view = ViewOf(this->View->GetRenderer());
  if (mayHaveChanged || !IsSameView(view, this->Wanted))
  {
    this->Wanted = view;
    this->WantsMoves = moves;
    this->IsNew = true;
    // Whether other data are where they were nobody knows.
    const vtkMTimeType stamp = this->Proxy->GetPictureMTime();
    const bool mayBeOther = mayHaveChanged && this->Pictures->HasOthersInView();
    this->Content += mayBeOther || stamp != this->Stamp ? 1 : 0;
    this->Stamp = stamp;
  }
  if (this->IsNew && this->Number - this->Seen < MostUnseen)
  {
    this->SendTicket();
  }
}

void ServedWindow::SendTicket()
{
  PictureTicket ticket;
  ticket.Number = ++this->Number;
  if (std::exchange(this->IsNew, false))
  {
    this->Scene = this->Number;
    this->Views.push_back({ this->Scene, this->Content, this->Wanted });
    this->SinceScene = banyan::Timer();
  }
  ticket.Display = this->Display;
  ticket.Scene = this->Scene;
  ticket.Moves = this->WantsMoves;
  ticket.CoarseEvery = this->CoarseEvery();
  // What was sent before has come: the line is free.
  const double seconds = std::max(this->SinceTicket.Seconds(), GoOnSeconds);
  ticket.Credit = this->Rate.Credit(std::min(seconds, CreditSeconds));
  ticket.Shown = this->ToldScene;
  ticket.View = this->Wanted;
  this->AddDepths(ticket);
  this->Proxy->SendTicket(ticket);
  this->SinceTicket = banyan::Timer();
}

/// Adds what the window has of other data: it was drawn with the view of the ticket.
void ServedWindow::AddDepths(PictureTicket& ticket)
{
  const bool isStill = !this->WantsMoves || this->SinceScene.Seconds() > StillSeconds;
  if (ticket.IsNew())
  {
    this->Sent = PictureTicket::Nothing;
  }
  else if (this->Sent != PictureTicket::OfCoarse || !isStill)
  {
    return;
  }
  const DepthPicture others = this->Pictures->OthersInView();
  if (!others.Rect.Empty())
  {
    this->Sent = isStill ? PictureTicket::OfAll : PictureTicket::OfCoarse;
    ticket.Depths = PackDepths(isStill ? others : others.Coarser(ticket.CoarseEvery));
  }
  ticket.Others = this->Sent;
}

/// How coarse a picture has to be so that it comes soon.
int ServedWindow::CoarseEvery() const
{
  const double most = this->Rate.Credit(CoarseSeconds);
  const double pixels = static_cast<double>(this->Wanted.Size.x) * this->Wanted.Size.y;
  int every = 2;
  while (every < 8 && pixels / (every * every) > most)
  {
    every *= 2;
  }
  return every;
}

void ServedWindow::TakeMessage(void* window, void* message, int bytes, int)
{
  if (Windows().count(window) > 0)
  {
    static_cast<ServedWindow*>(window)->Take(message, static_cast<std::size_t>(bytes));
  }
}

void ServedWindow::Take(const void* message, std::size_t bytes)
{
  const std::optional<PictureParcel> head = ParcelAssembly::HeadOf(message, bytes);
  if (!head)
  {
    this->Fail("The server has another version of Banyan");
    return;
  }
  if (head->Display != this->Display)
  {
    return;
  }
  this->Seen = std::max(this->Seen, head->Ticket);
  const bool isCut = head->Begin + (bytes - sizeof(PictureParcel)) < head->Bytes;
  this->Rate.Came({ head->Burst, bytes, this->HadNone, this->Clock.Seconds(), isCut });
  try
  {
    if (std::optional<ParcelAssembly::Whole> whole = this->Parts.Take(message, bytes))
    {
      this->Take(std::move(*whole));
    }
  }
  catch (const std::exception& error)
  {
    this->Fail(error.what());
  }
}

void ServedWindow::Take(ParcelAssembly::Whole whole)
{
  const PictureParcel& head = whole.Head;
  while (!this->Views.empty() && this->Views.front().Scene < head.Scene)
  {
    this->Views.pop_front();
  }
  const bool isKnown = !this->Views.empty() && this->Views.front().Scene == head.Scene;
  if (head.Kind == PictureParcel::Failure)
  {
    this->Fail(std::string(whole.Content.begin(), whole.Content.end()));
  }
  else if (head.Kind == PictureParcel::Same && isKnown)
  {
    const Asked& asked = this->Views.front();
    this->Pictures->PutSame(asked.Scene, asked.Content, asked.View);
    this->ExactScene = head.Scene;
    this->HasBetter = !this->Pictures->LastShown().Exact;
  }
  else if ((head.Kind == PictureParcel::Coarse || head.Kind == PictureParcel::Exact) && isKnown)
  {
    const bool exact = head.Kind == PictureParcel::Exact;
    const Asked& asked = this->Views.front();
    this->Pictures->Put(
      { head.Scene, asked.Content, exact, asked.View, UnpackPicture(whole.Content) });
    this->ExactScene = exact ? head.Scene : this->ExactScene;
    this->HasBetter = true;
  }
}

/// Says it once, and has the window wait as it did.
void ServedWindow::Fail(const std::string& sentence)
{
  if (this->Failure.empty() && !sentence.empty())
  {
    this->Failure = sentence + (sentence.back() == '.' ? "" : ".");
    vtkErrorWithObjectMacro(
      this->Proxy, << "The volume was not drawn while the window went on. " << this->Failure
                   << " Until a property of the display changes, the window waits for the server.");
  }
}

void ServedWindow::DrawAlone(bool exact)
{
  vtkPVRenderView* const view = OfClient(this->View);
  this->Busy = true;
  this->HasBetter = false;
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
  this->SinceDrawn = banyan::Timer();
}

/// Now and then: takes pictures that have come, shows them, and has the server go on.
void ServedWindow::Look(vtkObject*, unsigned long, void* timer)
{
  if (*static_cast<int*>(timer) != this->Timer || this->Busy || !IsIdle(this->Proxy))
  {
    return;
  }
  const vtkSmartPointer<vtkSMBanyanVolumeProxy> stays(this->Proxy);
  this->Busy = true;
  this->HadNone = ReadMessages(PumpSeconds) ? this->Clock.Seconds() : this->HadNone;
  this->Busy = false;
  if (!this->Served || !this->View || !IsIdle(this->Proxy))
  {
    return;
  }
  if (!this->Failure.empty())
  {
    this->StopTimer();
    this->Interactor->InvokeEvent(vtkCommand::RenderEvent);
    return;
  }
  const bool exact = !this->IsMissing() && !this->Moving && !this->IsNew;
  const bool waits = !exact && this->SinceDrawn.Seconds() < DrawSeconds;
  if (this->HasBetter && !waits && !this->View->GetNeedsUpdate())
  {
    this->DrawAlone(exact);
  }
  this->GoOn();
}

/// Somebody drags a point of a function, or ParaView has changed it, and will render.
void ServedWindow::FunctionsHaveChanged()
{
  this->HasOtherFunctions = this->IsServed();
  if (this->HasOtherFunctions)
  {
    this->StartTimer();
  }
}

void ServedWindow::ShowFunctions()
{
  this->HasOtherFunctions = false;
  this->Proxy->SendFunctions();
  this->Want(/*moves=*/true, /*mayHaveChanged=*/true);
}

void ServedWindow::GoOn()
{
  if (this->Number - this->Seen >= MostUnseen)
  {
    return;
  }
  if (this->HasOtherFunctions && !this->View->GetNeedsUpdate())
  {
    this->ShowFunctions();
  }
  // The rest of a picture is asked for when the first part has come.
  const bool waits = this->SinceTicket.Seconds() < GoOnSeconds &&
                     !(this->Parts.HasBegun() && this->Seen == this->Number);
  if (this->IsNew || (this->IsMissing() && !waits))
  {
    this->SendTicket();
  }
  else if (!this->IsMissing() && !this->HasBetter)
  {
    if (this->ToldScene != this->Scene)
    {
      this->ToldScene = this->Scene;
      this->SendTicket();
      this->Proxy->FetchStatistics();
    }
    this->StopTimer();
  }
}

} // namespace banyan
