// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_ServedVolume_h
#define banyan_Representations_ServedVolume_h

#include "LiveFunctions.h"
#include "PictureTicket.h"
#include "PicturesAtHand.h"

#include "Base/LineRate.h"
#include "Base/Timer.h"
#include "Parallel/Composite/ParcelAssembly.h"

#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <deque>
#include <memory>
#include <string>

class vtkMultiProcessController;
class vtkSMBanyanVolumeProxy;
class vtkSMProxy;
class vtkSMRenderViewProxy;

namespace banyan
{

class ServedWindow;

/// A volume of a ServedWindow: what the server was asked for, and what has come.
class ServedVolume
{
public:
  /// @param proxy of the volume
  /// @param view that shows it; HasServer
  ServedVolume(vtkSMBanyanVolumeProxy* proxy, vtkSMRenderViewProxy* view);
  ~ServedVolume();
  ServedVolume(const ServedVolume&) = delete;
  ServedVolume& operator=(const ServedVolume&) = delete;

  /// The representation that a user sees.
  vtkSMProxy* OfUser() const;
  /// Whether pictures come as messages now.
  bool IsServed() const;
  /// Whether they could.
  bool IsServable() const;
  /// Whether the server was told that they do, if the client draws the window.
  bool Serves() const { return this->Served; }
  /// Whether some of a view are mixed, since they share space as far as the client knows: the
  /// server's pictures have them apart.
  static bool AnyMixed(const std::vector<ServedVolume*>& volumes);
  /// @param volumes of the window that share the line
  void Serve(bool serves, int volumes);

  /// Tells the server what is wanted, now or soon.
  void Want(const ScreenView& view, bool moves, bool mayHaveChanged);
  /// After a picture of ParaView's, for which anything may have changed, functions included.
  void WantAnew(const ScreenView& view, bool moves);
  /// Has the server go on. To be called now and then.
  /// @return whether something is still to come, or to be shown
  bool GoOn();

  /// After a picture that the server has drawn for ParaView: whether it is to become exact.
  void WaitForExact(bool waits);
  /// Has the server go on with that. To be called now and then.
  /// @return whether its exact picture is still to come
  bool GoOnWithExact();
  /// Whether the exact picture has come, and ParaView has to ask for it.
  bool HasExactNews() const { return this->ExactNews; }

  /// Whether the view is still to be sent.
  bool HasNews() const { return this->IsNew; }
  /// Whether the exact picture of the view is here.
  bool HasExact() const { return this->ExactScene == this->Scene && !this->IsNew; }
  /// Whether a picture is here that is not shown yet.
  bool HasBetter() const { return this->Better; }
  /// Whether other data may be in the view.
  bool HasOthersInView() const { return this->Pictures && this->Pictures->HasOthersInView(); }
  /// Seconds from a ticket of a moving camera to its first picture, as measured; 0 at first.
  double Lag() const { return this->LagSeconds; }
  /// The window draws.
  void WillBeShown() { this->Better = false; }
  /// No message waits.
  void NoteAllRead() { this->HadNone = this->Clock.Seconds(); }
  /// Whether the server is not asked any more.
  bool HasFailed() const { return !this->Failure.empty(); }

private:
  static void TakeMessage(void* self, void* message, int bytes, int process);

  void TryAgain() { this->Failure.clear(); }
  void FunctionsHaveChanged();
  void SendTicket();
  void AddDepths(PictureTicket& ticket);
  int CoarseEvery() const;
  int Credit(double seconds) const;
  void Take(const void* message, std::size_t bytes);
  void Take(ParcelAssembly::Whole whole);
  void Fail(const std::string& sentence);

  /// What the server was asked for.
  struct Asked
  {
    int Scene;
    int Content;
    ScreenView View;
    banyan::Timer Since;
    bool IsMeasured; ///< how long its first picture takes: that of a moving camera
  };

  vtkSMBanyanVolumeProxy* Proxy;
  std::shared_ptr<ServedWindow> Window;
  vtkWeakPointer<vtkMultiProcessController> Server;
  int Display;                ///< number that its pictures come with
  unsigned long Messages = 0; ///< the server's, that are observed
  unsigned long OfDisplay = 0;
  bool Served = false;
  int Volumes = 1;
  std::string Failure; ///< why the server is not asked any more

  LiveFunctions Functions;
  bool HasOtherFunctions = false; ///< that the server has not

  ScreenView Wanted;
  bool WantsMoves = false;
  bool IsNew = false;                                      ///< whether Wanted is still to be sent
  PictureTicket::Geometries Sent = PictureTicket::Nothing; ///< depths, of the last scene
  banyan::Timer SinceScene;
  int Number = 0;          ///< of the last ticket
  int Seen = 0;            ///< of the last one that the server has answered
  int Scene = 0;           ///< of the last ticket with a view
  int ExactScene = 0;      ///< whose exact picture is here
  int ToldScene = 0;       ///< the server, that its exact picture is shown
  int Content = 0;         ///< of it: another one where values may be others
  vtkMTimeType Stamp = 0;  ///< of that
  std::deque<Asked> Views; ///< that pictures may still come of
  ParcelAssembly Parts;
  LineRate Rate;
  banyan::Timer Clock;
  double LagSeconds = 0.0;
  double HadNone = 0.0; ///< when no message was waiting, by that
  std::shared_ptr<PicturesAtHand> Pictures;
  bool Better = false;
  bool AwaitsExact = false; ///< of ParaView's own picture
  bool ExactNews = false;
  int AwaitedSince = 0; ///< the last ticket before that
  banyan::Timer SinceTicket;
};

} // namespace banyan

#endif
