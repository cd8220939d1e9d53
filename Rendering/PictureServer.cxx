// SPDX-License-Identifier: BSD-3-Clause
#include "PictureServer.h"

#include "VolumeFrame.h"
#include "VolumesInDepth.h"
#include "vtkBanyanFrameStatistics.h"
#include "vtkBanyanVolumeMapper.h"

#include "Base/ThreadPool.h"
#include "Parallel/Composite/PackedDepths.h"
#include "Parallel/Composite/PackedPicture.h"

#include "vtkVolume.h"

#include <algorithm>
#include <chrono>
#include <cstring>
#include <utility>

namespace banyan
{
namespace
{

/// Rows and columns that a coarse picture leaves out become those of a smaller picture.
ScreenView Smaller(const ScreenView& view, int every)
{
  ScreenView smaller = view;
  smaller.Size = CoarserSize(view.Size, every);
  return smaller;
}

/// All of this main thread: where ranks are threads, each has its own. In the same order on all.
std::vector<PictureServer*>& All()
{
  static thread_local std::vector<PictureServer*> all;
  return all;
}

} // namespace

PictureServer::PictureServer(vtkBanyanVolumeMapper* mapper, vtkVolume* volume)
  : Mapper(mapper)
  , Volume(volume)
{
  All().push_back(this);
}

PictureServer::~PictureServer()
{
  All().erase(std::find(All().begin(), All().end(), this));
}

void PictureServer::Take(const PictureTicket& ticket, const Line& line)
{
  constexpr std::chrono::milliseconds most{ 250 };
  const auto end = std::chrono::steady_clock::now() + most;
  // Whoever has nothing more to say may have left: somebody else may want something.
  const auto leaves = [&] { return line.HasMore() || std::chrono::steady_clock::now() > end; };
  this->Number = ticket.Number;
  this->HasAnswered = false;
  int credit = ticket.Credit;
  if (ticket.Scene == PictureTicket::OfParaView)
  {
    this->Asked = ticket;
    this->GoOnForParaView(leaves);
    this->Answer(line, credit);
    return;
  }
  const bool isNews = ticket.IsNew() || !ticket.Depths.empty();
  if (isNews)
  {
    this->Asked = ticket;
  }
  if (ticket.Shown != 0 && ticket.Shown == this->Asked.Scene)
  {
    this->Mapper->GetStatistics()->SetPictureIsExact(1);
  }
  this->Attempt(
    [&]
    {
      const bool isMissing =
        this->ExactScene != this->Asked.Scene && this->Asked.Others != PictureTicket::OfCoarse;
      if (isNews || (isMissing && !this->Mapper->State->Served.IsComing()))
      {
        this->Draw();
      }
    });
  this->Answer(line, credit);
  // What threads of another volume draw comes first.
  PictureServer* const other = WhoDraws();
  if (other && other != this)
  {
    other->GoOn(leaves, line, credit);
  }
  this->GoOn(leaves, line, credit);
}

void PictureServer::Serve(bool serves)
{
  this->Mapper->State->ServesWindow = serves;
  if (!serves)
  {
    this->Mapper->State->Served.Stop();
    this->Waiting.clear();
  }
}

/// Of this main thread: whose threads draw now. Null for none.
PictureServer* PictureServer::WhoDraws()
{
  const auto draws = [](const PictureServer* server)
  { return server->Mapper->State->Served.IsDrawing(); };
  const auto found = std::find_if(All().begin(), All().end(), draws);
  return found == All().end() ? nullptr : *found;
}

/// Collective: works on exact pictures of what ParaView has drawn, and says when this volume's is
/// there.
void PictureServer::GoOnForParaView(const std::function<bool()>& leaves)
{
  const auto goOn = [&leaves](PictureServer& server)
  {
    LateFramesOfRanks& served = server.Mapper->State->Served;
    if (served.IsComing())
    {
      server.Attempt([&] { served.GoOn(leaves); });
    }
  };
  PictureServer* const other = WhoDraws();
  if (other && other != this)
  {
    goOn(*other);
  }
  goOn(*this);
  if (!this->Mapper->State->Served.IsComing())
  {
    const bool isShown = this->Mapper->GetStatistics()->GetPictureIsExact() != 0;
    this->Put(isShown ? PictureParcel::Same : PictureParcel::Exact, {});
  }
}

/// Collective. What fails is sent as a sentence.
void PictureServer::Attempt(const std::function<void()>& action)
{
  try
  {
    action();
  }
  catch (const std::exception& error)
  {
    const std::string sentence = error.what();
    this->ExactScene = this->Asked.Scene; // no more of this one
    this->Mapper->State->Served.Stop();
    this->Put(PictureParcel::Failure, Bytes(sentence.begin(), sentence.end()));
    this->Mapper->State->Communicator->LeaveTogether(sentence);
  }
}

/// Collective: serves the threads that draw the exact picture, and sends it.
/// @param credit as of Answer
void PictureServer::GoOn(const std::function<bool()>& leaves, const Line& line, int& credit)
{
  LateFramesOfRanks& served = this->Mapper->State->Served;
  this->Attempt(
    [&]
    {
      if (served.GoOn(leaves))
      {
        this->Publish();
      }
      else if (const std::optional<FieldFrames::Frame> between = served.TakeBetween())
      {
        this->PutPicture(false, RoundToBytes(*between->Picture.Pixels, this->Asked.View.Size));
      }
    });
  this->Answer(line, credit);
}

/// Collective: draws the scene that was asked for, unless that was done.
void PictureServer::Draw()
{
  MapperState& state = *this->Mapper->State;
  this->Mapper->GetStatistics()->SetPictureIsExact(0);
  this->Mapper->UpdateField(this->Volume);
  auto frame = std::make_unique<VolumeFrame>(this->Mapper, state, this->Volume);
  VolumeFrame coarse(this->Mapper, state, this->Volume);
  if (!frame->Prepare(this->Asked.View) ||
      !coarse.Prepare(Smaller(this->Asked.View, std::max(1, this->Asked.CoarseEvery))))
  {
    state.Served.Stop();
    this->Drawn = nullptr;
    this->DrawnScene = this->Asked.Scene;
    this->Body.clear();
    this->PutPicture(true, { this->Asked.View.Size, {}, {} });
    this->ExactScene = this->Asked.Scene;
    return;
  }
  frame->BeginFigures();
  const FieldFrames::Wish wish = frame->WishFor(this->Asked.Moves, /*eye=*/0, this->Asked.Volumes);
  RayScene scene = frame->Scene();
  this->Body = BodyOf(this->Volume, this->Mapper, state.Field.Place().Bounds, scene);
  RayScene small = coarse.Scene();
  this->AddDepths(scene, small);
  if (this->Asked.Others == PictureTicket::OfCoarse)
  {
    state.Served.DrawCoarse(*state.Communicator, state.Field, small, wish);
    this->Drawn = std::move(frame);
    this->DrawnScene = this->Asked.Scene;
    this->Publish();
  }
  else if (state.Served.Draw(*state.Communicator, state.Field, scene, small, wish))
  {
    this->Drawn = std::move(frame);
    this->DrawnScene = this->Asked.Scene;
    if (state.Served.HasAny())
    {
      this->Publish();
    }
  }
  else
  {
    this->Rename();
  }
}

/// Has rays end where other data of the client's view are.
void PictureServer::AddDepths(RayScene& scene, RayScene& coarse) const
{
  if (this->Asked.Depths.empty())
  {
    return;
  }
  const DepthPicture depths = UnpackDepths(this->Asked.Depths);
  const bool ofAll = this->Asked.Others == PictureTicket::OfAll;
  if (ofAll)
  {
    scene.Depth = depths.In(scene.Viewport);
  }
  coarse.Depth =
    (ofAll ? depths.Coarser(std::max(1, this->Asked.CoarseEvery)) : depths).In(coarse.Viewport);
}

/// The scene that was drawn has another number now.
void PictureServer::Rename()
{
  const bool isExact = this->Mapper->State->Served.Last().Exact;
  this->ExactScene = isExact ? this->Asked.Scene : this->ExactScene;
  bool comes = false;
  for (Parcel& parcel : this->Waiting)
  {
    if (parcel.Head.Scene == this->DrawnScene)
    {
      parcel.Head.Scene = this->Asked.Scene;
      comes = comes || parcel.Head.Kind == PictureParcel::Exact;
    }
  }
  this->DrawnScene = this->Asked.Scene;
  if (isExact && !comes)
  {
    this->Put(PictureParcel::Same, {});
  }
}

/// Collective: takes a better picture for the client.
void PictureServer::Publish()
{
  MapperState& state = *this->Mapper->State;
  const LateFrames::Shown& shown = state.Served.Last();
  this->ExactScene = shown.Exact ? this->Asked.Scene : this->ExactScene;
  if (this->Drawn)
  {
    this->Drawn->Tell(shown.Frame);
    this->Drawn->Finish(CompositeStatistics(), 0.0);
  }
  if (shown.Frame.Picture.Pixels)
  {
    const glm::ivec2 size =
      shown.Exact ? this->Asked.View.Size : Smaller(this->Asked.View, this->Asked.CoarseEvery).Size;
    this->PutPicture(shown.Exact, RoundToBytes(*shown.Frame.Picture.Pixels, size));
  }
}

void PictureServer::PutPicture(bool exact, BytePicture picture)
{
  this->Put(exact ? PictureParcel::Exact : PictureParcel::Coarse,
    PackPicture({ std::move(picture), this->Body }, ThreadPool::Process()));
}

/// Has something sent when it may be. What is better, or of a newer scene, takes the place of what
/// was not begun to be sent; a coarse picture that was is sent to its end, or no end would come
/// while the camera moves.
void PictureServer::Put(PictureParcel::Kinds kind, Bytes content)
{
  const auto stays = [](const Parcel& parcel)
  {
    return parcel.Head.Kind == PictureParcel::Failure ||
           (parcel.Head.Kind == PictureParcel::Coarse && parcel.Sent > 0);
  };
  this->Waiting.erase(std::remove_if(this->Waiting.begin(), this->Waiting.end(),
                        [&](const Parcel& parcel) { return !stays(parcel); }),
    this->Waiting.end());
  Parcel parcel;
  parcel.Head.Display = this->Asked.Display;
  parcel.Head.Kind = kind;
  parcel.Head.Scene = this->Asked.Scene;
  parcel.Head.Bytes = static_cast<std::uint32_t>(content.size());
  parcel.Content = std::move(content);
  this->Waiting.push_back(std::move(parcel));
}

/// Sends what may be sent: at least one message for each ticket.
/// @param credit bytes; what was sent is subtracted
void PictureServer::Answer(const Line& line, int& credit)
{
  if (this->Mapper->State->Communicator->Rank() > 0)
  {
    this->Waiting.clear();
    return;
  }
  ++this->Burst;
  if (this->Waiting.empty() && !this->HasAnswered)
  {
    this->Put(PictureParcel::Answer, {});
  }
  constexpr std::size_t most = PictureParcel::MostBytes - sizeof(PictureParcel);
  while (!this->Waiting.empty() && (credit > 0 || !this->HasAnswered))
  {
    Parcel& parcel = this->Waiting.front();
    const std::size_t bytes = std::min(most, parcel.Content.size() - parcel.Sent);
    parcel.Head.Ticket = this->Number;
    parcel.Head.Burst = this->Burst;
    parcel.Head.Begin = static_cast<std::uint32_t>(parcel.Sent);
    Bytes message(sizeof(PictureParcel) + bytes);
    std::memcpy(message.data(), &parcel.Head, sizeof(PictureParcel));
    std::copy_n(parcel.Content.data() + parcel.Sent, bytes, message.data() + sizeof(PictureParcel));
    line.Send(message);
    this->HasAnswered = true;
    credit -= static_cast<int>(message.size());
    parcel.Sent += bytes;
    if (parcel.Sent == parcel.Content.size())
    {
      this->Waiting.pop_front();
    }
  }
}

} // namespace banyan
