// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_ServedWindow_h
#define banyan_Representations_ServedWindow_h

#include "RendererCamera.h"
#include "ServableView.h"

#include "Base/Timer.h"
#include "Render/Scene/CameraPath.h"

#include "vtkWeakPointer.h"

#include <memory>
#include <vector>

class vtkObject;
class vtkRenderWindowInteractor;
class vtkSMRenderViewProxy;

namespace banyan
{

class ServedVolume;

/// A window of a client that does not wait for its server. The window draws alone, at once, with
/// the best pictures of its volumes that are at hand; the server is told what is wanted by tickets,
/// and its pictures come as messages.
///
///     mouse      move      move      release
///     window     draws     draws     ParaView's still picture    draws       draws
///     tickets    view 1    view 2    view 3   go on   go on ...
///     pictures         coarse 1  coarse 2 ...                  coarse 3    exact 3
///
/// Depths of other data in the view, which the client has and draws, go with the tickets. Where
/// there are none, views of a moving camera are those that it will have when their pictures come.
/// Where there are more data than a client gets, the server draws as ParaView asks for it: a coarse
/// picture, and the exact one once it is there. Where neither does (stereo, walls, screenshots,
/// steps of a play, scripts, failures, a volume that is not Decoupled, volumes that are mixed),
/// ParaView waits for it.
class ServedWindow : public std::enable_shared_from_this<ServedWindow>
{
public:
  /// That of a view, which its volumes share.
  /// @param view HasServer
  static std::shared_ptr<ServedWindow> Of(vtkSMRenderViewProxy* view);
  explicit ServedWindow(vtkSMRenderViewProxy* view);
  ~ServedWindow();
  ServedWindow(const ServedWindow&) = delete;
  ServedWindow& operator=(const ServedWindow&) = delete;

  void Add(ServedVolume* volume) { this->Volumes.push_back(volume); }
  void Remove(ServedVolume* volume);

  /// Null when it is gone.
  vtkSMRenderViewProxy* GetView() const { return this->View; }
  /// Whether pictures come as messages now.
  bool IsServed() const { return this->Served && this->View && !IsRemote(this->View); }
  /// Whether the server draws for ParaView, and exact pictures may come later.
  bool IsLate() const { return this->Served && this->View && IsRemote(this->View); }
  /// Has what is missing asked for, and what comes be shown.
  void StartTimer();

private:
  void Observe();
  void Ignore();
  void BeforeRender();
  void AfterRender(vtkObject* caller, unsigned long event, void* interactive);
  bool Move(vtkObject* caller, unsigned long event, void* data);
  void BeginMoves();
  bool MayAsk() const;
  void Release();
  void EndMoves() { this->Moving = this->EndsAtRest = false; }
  glm::dmat4 WorldToEye() const;
  void Look(vtkObject* caller, unsigned long event, void* timer);
  void ReadPictures();
  void ShowPictures();
  void WaitForExact(bool waits);
  void LookForExact();

  std::vector<ServedVolume*> InView() const;
  std::vector<ServedVolume*> InUse() const;
  void Want(const ScreenView& view, bool moves);
  ScreenView Soon(const ScreenView& now);
  bool HasFailed() const;
  bool HasOthersInView() const;
  void DrawAlone(bool exact);
  void StopTimer();

  vtkWeakPointer<vtkSMRenderViewProxy> View;
  vtkWeakPointer<vtkRenderWindowInteractor> Interactor; ///< that is observed
  std::vector<ServedVolume*> Volumes;
  std::vector<unsigned long> OfView;
  std::vector<unsigned long> OfInteractor;
  int Timer = -1; ///< of the interactor; -1 for none
  bool Served = false;
  bool Moving = false;     ///< the camera, by the mouse
  bool EndsAtRest = false; ///< Moving, by a widget, which does not say when that ends
  bool Busy = false;       ///< in a function that draws or pumps
  StepWatch Steps;
  bool HasLod = false;          ///< other data were delivered for moves
  bool IsDrawn = true;          ///< as it is to stay, if all pictures are exact
  glm::dmat4 DrawnToEye{ 1.0 }; ///< WorldToEye of the last picture
  CameraPath Path;              ///< while the mouse moves it
  bool Ahead = false; ///< the server draws what will be seen, if the camera goes on as it does
  banyan::Timer Clock;
  banyan::Timer SinceMove;
  banyan::Timer SinceDrawn;
};

} // namespace banyan

#endif
