// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_MapperState_h
#define banyan_Rendering_MapperState_h

#include "Backdrop.h"
#include "MotionEnhancement.h"
#include "RenderWhenDrawn.h"
#include "RendererCamera.h"
#include "TransferFunctionTable.h"

#include "Parallel/Fields/DistributedField.h"
#include "Parallel/Frame/LateFramesOfRanks.h"

#include "vtkType.h"

#include <array>
#include <memory>
#include <set>
#include <string>
#include <vector>

class vtkDataObject;
class vtkRenderer;
class vtkVolume;

namespace banyan
{

struct LinearParts;

/// What vtkBanyanVolumeMapper keeps from frame to frame.
struct MapperState
{
  std::unique_ptr<banyan::Communicator> Communicator;
  DistributedField Field;
  FieldFrames Frames;
  LateFrames Late{ Frames };
  std::vector<std::unique_ptr<FieldFrames>> WallFrames; ///< of each picture of a wall
  LateFramesOfRanks Served{ Frames };
  bool ServesWindow = false; ///< of a client: exact pictures may come late to ParaView's own, too
  RenderWhenDrawn Again;
  bool ShowsCoarse = false;                  ///< the last picture: the exact one comes by itself
  const vtkRenderer* LastRenderer = nullptr; ///< only to compare with
  MotionEnhancement Motion;
  std::shared_ptr<const LinearParts> Parts; ///< of cells of the last step that are not linear
  banyan::Backdrop Backdrop;
  std::array<glm::dmat4, 2> LastViews{ glm::dmat4(0.0), glm::dmat4(0.0) }; ///< PictureOf, by eye
  KeptTransferFunction Function;
  std::vector<int> RankOrderBehind;
  std::string LastNote;
  std::string LastIgnored;
  std::string LastProblem;
  std::array<double, 6> Bounds{ { 1, -1, 1, -1, 1, -1 } };
  bool BoundsKnown = false;
  vtkDataObject* BoundsOf = nullptr; ///< only to compare with
  vtkMTimeType BoundsTime = 0;
  double WriteSeconds = 0.0; ///< of the last frame, to put its picture on the screen
  std::set<const vtkVolume*>
    DrawnByOthers;                  ///< of the renderer's present frame; only to compare with
  unsigned long FrameEnds = 0;      ///< observes that
  unsigned char ToldNotInDepth = 0; ///< bits of banyan::NotInDepth
};

} // namespace banyan

#endif
