// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Representations_WallOfRanks_h
#define banyan_Representations_WallOfRanks_h

#include "Render/Scene/DepthPicture.h"
#include "VolumesOnWall.h"

#include <string>
#include <vector>

class vtkMultiProcessController;
class vtkPVRenderView;

namespace banyan
{

class FramebufferExchange;

/// Whether each rank of a server shows a picture of its own: on a tile display, or in a CAVE.
bool IsWall(vtkPVRenderView* view);

/// What the displays of all ranks show of a view.
struct WallOfRanks
{
  std::vector<WallPicture> Pictures; ///< the same on all ranks
  DepthPicture Own; ///< at which other data are in this rank's place, in pixels of its picture
  /// What a user has to know: displays differ, or some show nothing. The same on all ranks.
  std::string Note;
};

/// At which depths this rank of a CAVE has drawn other data, in pixels of its display: to be called
/// before ParaView writes its picture back. Nothing on a tile display, whose depths ParaView keeps.
DepthPicture DepthsInCave(vtkPVRenderView* view, FramebufferExchange& framebuffer);

/// Collective, when ParaView has put the picture of other data into the windows of all ranks.
/// @param inCave DepthsInCave
WallOfRanks LookAtWall(
  vtkPVRenderView* view, vtkMultiProcessController* ranks, const DepthPicture& inCave);

} // namespace banyan

#endif
