// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_ServableView_h
#define banyan_Representations_ServableView_h

#include "Base/Timer.h"

#include <set>

class vtkPVRenderView;
class vtkSMProxy;
class vtkSMRenderViewProxy;
class vtkSMSessionClient;

namespace banyan
{

/// The client's own object of a view; null where there is none.
vtkPVRenderView* OfClient(vtkSMRenderViewProxy* view);
/// Null where the proxy is of no client of a server.
vtkSMSessionClient* SessionOf(vtkSMProxy* proxy);

/// Whether a view is that of the only client of a server that holds the data and renders.
bool HasServer(vtkSMRenderViewProxy* view);

/// Whether ParaView's next picture of a view may be drawn by the client alone, and the server's
/// pictures of volumes be put over it: the window is one whose event loop turns, and somebody looks
/// at it.
bool IsServable(vtkSMRenderViewProxy* view);

/// Visible representations of a view that Banyan draws as volumes.
std::set<vtkSMProxy*> VolumesIn(vtkSMRenderViewProxy* view);

/// Whether the server of a volume knows this plugin's tickets: its own definitions of proxies say
/// so.
bool KnowsTickets(vtkSMProxy* volume);

/// Whether a client may send a message, and draw a window, without coming between ParaView's own.
bool IsIdle(vtkSMProxy* proxy);

/// Whether the server renders what the view shows now, or while the camera moves: there are too
/// many other data for a client.
bool IsRemote(vtkSMRenderViewProxy* view);

/// Whether other views follow the camera of this one: ParaView moves it.
bool IsLinked(vtkSMRenderViewProxy* view);

/// Tells the steps of a play, each of which is to be seen, from a step that somebody has chosen.
class StepWatch
{
public:
  explicit StepWatch(double time)
    : Time(time)
  {
  }

  /// To be called before each picture.
  /// @param time that the view shows
  /// @return whether it came soon after another one
  bool Plays(double time);

private:
  double Time;
  bool Playing = false;
  Timer SinceStep;
};

} // namespace banyan

#endif
