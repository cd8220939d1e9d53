// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_WallOfRanks_h
#define banyan_Representations_WallOfRanks_h

#include "Render/Scene/DepthPicture.h"
#include "VolumesOnWall.h"

#include <string>
#include <vector>

class vtkMultiProcessController;
class vtkPVRenderView;
class vtkRenderer;

namespace banyan
{

class FramebufferExchange;

/// Whether each rank of a server shows a picture of its own: on a tile display, or in a CAVE.
bool IsWall(vtkPVRenderView* view);

/// What the displays of all ranks show of a view.
struct WallOfRanks
{
  std::vector<WallPicture> Pictures; ///< the same on all ranks
  /// For each picture, at which depths other data are in it, as far as this rank knows.
  std::vector<DepthPicture> Own;
  /// What a user has to know: displays differ, or some show nothing. The same on all ranks.
  std::string Note;
};

/// At which depths this rank of a CAVE has drawn other data, in pixels of its display: to be called
/// before ParaView writes its picture back. Nothing on a tile display, whose depths ParaView keeps.
DepthPicture DepthsInCave(vtkPVRenderView* view, FramebufferExchange& framebuffer);

/// What this rank has drawn in a call of ParaView's compositor: for one tile, or for all of them.
struct DrawnPart
{
  ScreenView View; ///< of the call: Size is that of the window
  DepthPicture Depths;
};

/// Whether ParaView keeps no depths: on a tile display while something translucent is shown.
bool NeedsDrawnParts(vtkPVRenderView* view);

/// To be called when a call of the compositor has drawn all else.
DrawnPart DepthsOfCall(vtkRenderer* renderer, FramebufferExchange& framebuffer);

/// Collective, when ParaView has put the picture of other data into the windows of all ranks.
/// @param inCave DepthsInCave
/// @param drawn in all calls of this picture, if it NeedsDrawnParts
WallOfRanks LookAtWall(vtkPVRenderView* view, vtkMultiProcessController* ranks,
  const DepthPicture& inCave, const std::vector<DrawnPart>& drawn);

} // namespace banyan

#endif
