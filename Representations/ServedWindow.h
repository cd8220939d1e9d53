// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_ServedWindow_h
#define banyan_Representations_ServedWindow_h

#include "LiveFunctions.h"
#include "PictureTicket.h"
#include "PicturesAtHand.h"
#include "ServableView.h"

#include "Base/LineRate.h"
#include "Base/Timer.h"
#include "Parallel/Composite/ParcelAssembly.h"

#include "vtkSmartPointer.h"
#include "vtkWeakPointer.h"

#include <deque>
#include <memory>
#include <string>

class vtkMultiProcessController;
class vtkObject;
class vtkRenderWindowInteractor;
class vtkSMBanyanVolumeProxy;
class vtkSMRenderViewProxy;

namespace banyan
{

/// A window of a client that does not wait for its server. The window draws alone, at once, with
/// the best picture of the volume that is at hand; the server is told what is wanted by tickets,
/// and its pictures come as messages.
///
///     mouse      move      move      release
///     window     draws     draws     ParaView's still picture    draws       draws
///     tickets    view 1    view 2    view 3   go on   go on ...
///     pictures         coarse 1  coarse 2 ...                  coarse 3    exact 3
///
/// Depths of other data in the view, which the client has and draws, go with the tickets.
/// Where this does not do (several volumes in the view, stereo, walls, screenshots, steps of a
/// play, scripts, failures, more data than a client gets), the server draws as ParaView asks for
/// it.
class ServedWindow
{
public:
  /// @param proxy of the volume
  /// @param view that shows it; HasServer
  ServedWindow(vtkSMBanyanVolumeProxy* proxy, vtkSMRenderViewProxy* view);
  ~ServedWindow();
  ServedWindow(const ServedWindow&) = delete;
  ServedWindow& operator=(const ServedWindow&) = delete;

  /// Whether pictures come as messages now.
  bool IsServed() const { return this->Served && !IsRemote(this->View); }

private:
  static void TakeMessage(void* self, void* message, int bytes, int process);

  void Observe();
  void Ignore();
  void BeforeRender();
  void AfterRender(vtkObject* caller, unsigned long event, void* interactive);
  bool Move(vtkObject* caller, unsigned long event, void* data);
  void BeginMoves() { this->Moving = true; }
  void EndMoves() { this->Moving = false; }
  void TryAgain() { this->Failure.clear(); }
  void FunctionsHaveChanged();
  void ShowFunctions();
  void Look(vtkObject* caller, unsigned long event, void* timer);

  void Want(bool moves, bool mayHaveChanged);
  void SendTicket();
  void AddDepths(PictureTicket& ticket);
  int CoarseEvery() const;
  void GoOn();
  void Take(const void* message, std::size_t bytes);
  void Take(ParcelAssembly::Whole whole);
  void Fail(const std::string& sentence);
  void DrawAlone(bool exact);
  void StartTimer();
  void StopTimer();
  bool IsMissing() const { return this->ExactScene != this->Scene; }

  vtkSMBanyanVolumeProxy* Proxy;
  vtkWeakPointer<vtkSMRenderViewProxy> View;
  vtkWeakPointer<vtkRenderWindowInteractor> Interactor; ///< that is observed
  vtkWeakPointer<vtkMultiProcessController> Server;
  int Display;                ///< number that its pictures come with
  unsigned long Messages = 0; ///< the server's, that are observed
  unsigned long OfDisplay = 0;
  std::vector<unsigned long> OfView;
  std::vector<unsigned long> OfInteractor;
  int Timer = -1; ///< of the interactor; -1 for none
  bool Served = false;
  bool Moving = false; ///< the camera, by the mouse
  bool Busy = false;   ///< in a function that draws or pumps
  std::string Failure; ///< why the server is not asked any more

  /// What the server was asked for.
  struct Asked
  {
    int Scene;
    int Content;
    ScreenView View;
  };

  StepWatch Steps;
  LiveFunctions Functions;
  bool HasOtherFunctions = false; ///< that the server has not

  ScreenView Wanted;
  bool WantsMoves = false;
  bool IsNew = false;                                      ///< whether Wanted is still to be sent
  bool HasLod = false;                                     ///< other data were delivered for moves
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
  double HadNone = 0.0; ///< when no message was waiting, by that
  std::shared_ptr<PicturesAtHand> Pictures;
  bool HasBetter = false; ///< a picture that is not shown yet
  banyan::Timer SinceTicket;
  banyan::Timer SinceDrawn;
};

} // namespace banyan

#endif
