// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_VolumeMapperInternals_h
#define banyan_Rendering_VolumeMapperInternals_h

#include "Backdrop.h"
#include "DistributedField.h"
#include "FrameFigures.h"
#include "FrameScene.h"
#include "MotionEnhancement.h"
#include "ToleranceControl.h"
#include "TransferFunctionTable.h"
#include "vtkBanyanVolumeMapper.h"

#include "Base/Timer.h"
#include "Parallel/Frame/DistributedFrame.h"

#include <array>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <vector>

class vtkDataObject;
class vtkVolume;

/// What a mapper keeps from frame to frame.
struct vtkBanyanVolumeMapper::Internals
{
  std::unique_ptr<banyan::Communicator> Communicator;
  banyan::DistributedField Field;
  banyan::CompositePlanCache Plans; ///< of compositing
  banyan::MotionEnhancement Motion;
  banyan::Backdrop Backdrop;
  banyan::KeptTransferFunction Function;
  std::vector<int> RankOrderBehind;
  std::string LastNote;
  std::string LastIgnored;
  std::string LastProblem;
  std::array<double, 6> Bounds{ { 1, -1, 1, -1, 1, -1 } };
  bool BoundsKnown = false;
  vtkDataObject* BoundsOf = nullptr; ///< only to compare with
  vtkMTimeType BoundsTime = 0;
  banyan::ToleranceControl Tolerance;
  double WriteSeconds = 0.0; ///< of the last frame, to put its picture on the screen
  std::set<const vtkVolume*>
    DrawnByOthers;                  ///< of the renderer's present frame; only to compare with
  unsigned long FrameEnds = 0;      ///< observes that
  unsigned char ToldNotInDepth = 0; ///< bits of banyan::NotInDepth
};

/// A volume in the picture that is under way.
struct vtkBanyanVolumeMapper::Frame
{
  vtkBanyanVolumeMapper* Mapper = nullptr;
  vtkVolume* Volume = nullptr;
  banyan::Timer Began;
  std::optional<banyan::FrameScene> Wanted; ///< none where it cannot be drawn
  banyan::ToleranceControl::Wish Wish;
  banyan::FrameStatistics Statistics;
  banyan::FrameFigures Figures;
};

#endif
