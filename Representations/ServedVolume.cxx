// SPDX-License-Identifier: BSD-3-Clause
#include "ServedVolume.h"

#include "LineToClient.h"
#include "ServableView.h"
#include "ServedWindow.h"
#include "vtkSMBanyanVolumeProxy.h"

#include "Base/ThreadPool.h"
#include "Parallel/Composite/PackedDepths.h"
#include "Parallel/Composite/PackedPicture.h"

#include "vtkCommand.h"
#include "vtkMultiProcessController.h"
#include "vtkPVSession.h"
#include "vtkSMRenderViewProxy.h"
#include "vtkSMSessionClient.h"
#include "vtkSetGet.h"

#include <algorithm>
#include <set>
#include <utility>

namespace banyan
{
namespace
{

constexpr double GoOnSeconds = 0.1;   ///< from ticket to ticket, while a picture is missing
constexpr double CreditSeconds = 0.1; ///< that a ticket gives credit for, at most
constexpr double CoarseSeconds = 0.1; ///< that a coarse picture may be on the line, a byte a pixel
constexpr double StillSeconds = 0.1;  ///< without a move, until depths of all pixels are sent
constexpr int MostUnseen = 2;         ///< tickets that the server has not answered

/// Those that there are: a picture may come for one that is gone.
std::set<void*>& All()
{
  static std::set<void*> all;
  return all;
}

int NextNumber()
{
  static int last = 0;
  return ++last;
}

} // namespace

ServedVolume::ServedVolume(vtkSMBanyanVolumeProxy* proxy, vtkSMRenderViewProxy* view)
  : Proxy(proxy)
  , Window(ServedWindow::Of(view))
  , Server(SessionOf(view)->GetController(vtkPVSession::RENDER_SERVER_ROOT))
  , Display(NextNumber())
  , Functions([this] { this->FunctionsHaveChanged(); })
{
  All().insert(this);
  this->Window->Add(this);
  this->OfDisplay =
    this->OfUser()->AddObserver(vtkCommand::PropertyModifiedEvent, this, &ServedVolume::TryAgain);
  this->Messages =
    this->Server->AddRMICallback(&ServedVolume::TakeMessage, this, PictureParcel::Tag);
}

ServedVolume::~ServedVolume()
{
  All().erase(this);
  this->Window->Remove(this);
  if (vtkSMProxy* const display = this->OfUser())
  {
    display->RemoveObserver(this->OfDisplay);
  }
  if (this->Server)
  {
    this->Server->RemoveRMICallback(this->Messages);
  }
}

vtkSMProxy* ServedVolume::OfUser() const
{
  return this->Proxy->GetTrueParentProxy();
}

bool ServedVolume::IsServed() const
{
  return this->Served && this->Window->IsServed();
}

bool ServedVolume::IsServable() const
{
  return this->Failure.empty() && this->Proxy->IsDecoupled() && KnowsTickets(this->Proxy);
}

bool ServedVolume::AnyMixed(const std::vector<ServedVolume*>& volumes)
{
  std::vector<PlacedBody> bodies;
  for (const ServedVolume* const volume : volumes)
  {
    PlacedBody body =
      volumes.size() > 1 && volume->Proxy->MixesVolumes() ? volume->Proxy->GetBody() : PlacedBody();
    if (!body.empty())
    {
      bodies.push_back(std::move(body));
    }
  }
  // Whether boxes share space does not depend on the camera.
  const RayCamera any(glm::dmat4(1.0), glm::ivec2(1), glm::dvec3(0.0));
  return bodies.size() > 1 && DepthOrder(bodies, any).SomeUnknown();
}

void ServedVolume::Serve(bool serves, int volumes)
{
  this->Volumes = volumes;
  if (serves != this->Served)
  {
    this->Served = serves;
    this->Seen = this->Number; // what is not answered yet may never be
    this->Proxy->SetServed(serves, this->Window->GetView());
    this->Pictures = this->Proxy->GetPictures();
  }
}

void ServedVolume::WantAnew(const ScreenView& view, bool moves)
{
  // ParaView's editor of opacities, from 5.12 on, has each change drawn and tells the server later.
  if (std::exchange(this->HasOtherFunctions, false))
  {
    this->Proxy->SendFunctions();
  }
  this->Functions.Watch(this->OfUser());
  this->Want(view, moves, /*mayHaveChanged=*/true);
}

void ServedVolume::Want(const ScreenView& view, bool moves, bool mayHaveChanged)
{
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

void ServedVolume::SendTicket()
{
  PictureTicket ticket;
  ticket.Number = ++this->Number;
  if (std::exchange(this->IsNew, false))
  {
    this->Scene = this->Number;
    this->Views.push_back({ this->Scene, this->Content, this->Wanted, {}, this->WantsMoves });
    this->SinceScene = banyan::Timer();
  }
  ticket.Display = this->Display;
  ticket.Scene = this->Scene;
  ticket.Moves = this->WantsMoves;
  ticket.CoarseEvery = this->CoarseEvery();
  // What was sent before has come: the line is free.
  const double seconds = std::max(this->SinceTicket.Seconds(), GoOnSeconds);
  ticket.Credit = this->Credit(std::min(seconds, CreditSeconds));
  ticket.Shown = this->ToldScene;
  ticket.Volumes = this->Volumes;
  ticket.View = this->Wanted;
  this->AddDepths(ticket);
  this->Proxy->SendTicket(ticket);
  this->SinceTicket = banyan::Timer();
}

/// Adds what the window has of other data: it was drawn with the view of the ticket.
void ServedVolume::AddDepths(PictureTicket& ticket)
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
int ServedVolume::CoarseEvery() const
{
  const double most = this->Credit(CoarseSeconds);
  const double pixels = static_cast<double>(this->Wanted.Size.x) * this->Wanted.Size.y;
  int every = 2;
  while (every < 8 && pixels / (every * every) > most)
  {
    every *= 2;
  }
  return every;
}

/// Bytes that this volume's part of the line takes in a time.
int ServedVolume::Credit(double seconds) const
{
  return this->Rate.Credit(seconds) / this->Volumes;
}

void ServedVolume::TakeMessage(void* volume, void* message, int bytes, int)
{
  if (All().count(volume) > 0)
  {
    static_cast<ServedVolume*>(volume)->Take(message, static_cast<std::size_t>(bytes));
  }
}

void ServedVolume::Take(const void* message, std::size_t bytes)
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

void ServedVolume::Take(ParcelAssembly::Whole whole)
{
  const PictureParcel& head = whole.Head;
  if (head.Scene == PictureTicket::OfParaView && head.Kind != PictureParcel::Failure)
  {
    if (head.Kind != PictureParcel::Answer && head.Ticket > this->AwaitedSince)
    {
      this->AwaitsExact = false;
      this->ExactNews = head.Kind == PictureParcel::Exact;
    }
    return;
  }
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
    this->Better = !this->Pictures->LastShown().Exact;
  }
  else if ((head.Kind == PictureParcel::Coarse || head.Kind == PictureParcel::Exact) && isKnown)
  {
    const bool exact = head.Kind == PictureParcel::Exact;
    Asked& asked = this->Views.front();
    if (std::exchange(asked.IsMeasured, false))
    {
      const double lag = asked.Since.Seconds();
      this->LagSeconds += (this->LagSeconds > 0.0 ? 0.3 : 1.0) * (lag - this->LagSeconds);
    }
    PlacedPicture placed = UnpackPicture(whole.Content, ThreadPool::Process());
    this->Pictures->Put({ head.Scene, asked.Content, exact, asked.View, std::move(placed.Picture),
      std::move(placed.Body) });
    this->ExactScene = exact ? head.Scene : this->ExactScene;
    this->Better = true;
  }
}

/// Says it once, and has the window wait as it did.
void ServedVolume::Fail(const std::string& sentence)
{
  if (this->Failure.empty() && !sentence.empty())
  {
    this->Failure = sentence + (sentence.back() == '.' ? "" : ".");
    vtkErrorWithObjectMacro(
      this->Proxy, << "The volume was not drawn while the window went on. " << this->Failure
                   << " Until a property of the display changes, the window waits for the server.");
  }
}

/// Somebody drags a point of a function, or ParaView has changed it, and will render.
void ServedVolume::FunctionsHaveChanged()
{
  this->HasOtherFunctions = this->IsServed();
  if (this->HasOtherFunctions)
  {
    this->Window->StartTimer();
  }
}

void ServedVolume::WaitForExact(bool waits)
{
  this->AwaitsExact = waits;
  this->ExactNews = false;
  this->AwaitedSince = this->Number;
}

bool ServedVolume::GoOnWithExact()
{
  if (!this->AwaitsExact || this->HasFailed())
  {
    return false;
  }
  if (this->Number - this->Seen < MostUnseen && this->SinceTicket.Seconds() >= GoOnSeconds)
  {
    PictureTicket ticket;
    ticket.Number = ++this->Number;
    ticket.Display = this->Display;
    ticket.Scene = PictureTicket::OfParaView;
    ticket.Volumes = this->Volumes;
    this->Proxy->SendTicket(ticket);
    this->SinceTicket = banyan::Timer();
  }
  return true;
}

bool ServedVolume::GoOn()
{
  if (this->Number - this->Seen >= MostUnseen)
  {
    return true;
  }
  if (this->HasOtherFunctions && !this->Window->GetView()->GetNeedsUpdate())
  {
    this->WantAnew(ViewOf(this->Window->GetView()->GetRenderer()), /*moves=*/true);
  }
  const bool isMissing = this->ExactScene != this->Scene;
  // The rest of a picture is asked for when the first part has come.
  const bool waits = this->SinceTicket.Seconds() < GoOnSeconds &&
                     !(this->Parts.HasBegun() && this->Seen == this->Number);
  if (this->IsNew || (isMissing && !waits))
  {
    this->SendTicket();
    return true;
  }
  if (isMissing || this->Better || this->HasOtherFunctions)
  {
    return true;
  }
  // A picture that is exact for another view than that of the window is not told of.
  if (this->ToldScene != this->Scene && this->Pictures->LastShown().Exact)
  {
    this->ToldScene = this->Scene;
    this->SendTicket();
    this->Proxy->FetchStatistics();
  }
  return false;
}

} // namespace banyan
