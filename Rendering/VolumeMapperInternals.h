#ifndef banyan_Rendering_VolumeMapperInternals_h
#define banyan_Rendering_VolumeMapperInternals_h

#include "Backdrop.h"
#include "DistributedField.h"
#include "MotionEnhancement.h"
#include "ToleranceControl.h"
#include "TransferFunctionTable.h"
#include "vtkBanyanVolumeMapper.h"

#include "Cache/BrickCache.h"
#include "Parallel/DistributedFrame.h"

#include <array>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

class vtkBanyanFrameStatistics;
class vtkDataObject;

/// What a mapper keeps from frame to frame.
struct vtkBanyanVolumeMapper::Internals
{
  std::unique_ptr<banyan::Communicator> Communicator;
  banyan::DistributedField Field;
  banyan::KeptPlan Plans; ///< of compositing
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

  void Publish(const banyan::FrameStatistics& frame, std::uint64_t bytesRead,
    const banyan::BrickCache::Statistics& cacheBefore, std::uint64_t aheadBefore, double seconds,
    vtkBanyanFrameStatistics* out) const;
};

#endif
