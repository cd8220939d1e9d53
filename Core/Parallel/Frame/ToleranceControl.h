// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Frame_ToleranceControl_h
#define banyan_Parallel_Frame_ToleranceControl_h

#include "Parallel/Fields/DistributedField.h"
#include "Parallel/Frame/DistributedPlan.h"
#include "Parallel/Frame/GroupPlans.h"
#include "Render/Sampling/InteractiveLevels.h"

#include <array>
#include <string>

namespace banyan
{

/// Decides how frames are sampled: within the tolerance that is wanted, and while somebody moves
/// the camera, as far beyond it as the promised frame time demands.
class ToleranceControl
{
public:
  /// That pictures of meshes are sampled at, which have elements of several sizes.
  static constexpr int CoarsestMeshLevel = 5;

  struct Wish
  {
    double Still = 1.0;       ///< 1/255
    double Interactive = 8.0; ///< 1/255
    double Seconds = 0.2;     ///< that a frame may take while interacting; 0 for any
    bool Interacting = false;
    bool BeginsCoarse = false; ///< whether the first picture by steps has all of them
    /// Whether a picture by steps has half of those that keep the time, which it exceeds.
    bool Between = false;
    double MaxElementsPerPixel = 0.0; ///< of meshes: see FinestLevelsOfTiles
    /// Above 0, what cells may measure on the screen, in place of the tolerance: see
    /// SamplingsByScreen.
    double ScreenErrorPixels = 0.0;
    bool FixedDistance =
      false; ///< whether the scene's distance between samples is that of all levels
    bool KeepsTolerance = true; ///< otherwise the picture is one of InteractiveLevels
    int Eye = 0;                ///< 1 for the second picture of a frame, where both eyes get one
    /// Whether steps of a series that plays share plans. See GroupPlans.
    bool PlansOfGroups = true;
  };

  /// How coarse a picture may be. Smaller is finer.
  struct Aim
  {
    double Coarseness = 0.0;  ///< the tolerance in 1/255, or a number of steps (InteractiveLevels)
    bool Interacting = false; ///< whether levels and time may count more than that
  };

  /// Begins a frame.
  Aim Begin(const Wish& wish);

  /// Collective: gives the scene its samplings and its opacity limit.
  /// @param view a hash of all that decides the picture, its samplings and the values apart
  /// @param aim as Begin has said
  /// @param frame the probes' samples and bytes are added
  /// @return the estimated error in 1/255; 0 where nothing tells it: where the size of cells
  /// decides, or the promised time
  double Plan(Communicator& communicator, DistributedField& field, RayScene& scene,
    const Hash128& view, const Wish& wish, const Aim& aim, std::uint64_t budgetBytes,
    FrameStatistics& frame);

  /// Remarks on the estimated error of the frame that was planned last, in sentences for the
  /// user: why it is above the tolerance that was wanted, or what it may have
  /// missed. Empty if nothing. The same on all ranks.
  const std::string& Limit() const { return this->LimitText; }

  /// Tells what the frame took that was planned last: the same numbers on all ranks.
  /// @param drawing seconds
  /// @param showing seconds to put it on the screen: no sampling changes them
  void FrameTook(const Wish& wish, double drawing, double showing);

  /// Forgets plans of earlier frames: when the ranks are others, say.
  void ForgetPlans();

private:
  /// For pictures that keep no tolerance (InteractiveLevels): while somebody moves the camera they
  /// keep the promised time; still ones have all samples.
  void PlanSteps(
    Communicator& communicator, DistributedField& field, RayScene& scene, const Aim& aim);
  SamplingPlan PlanWithin(Communicator& communicator, DistributedField& field,
    const RayScene& scene, const Hash128& view, const SamplingWish& sampling, const Wish& wish,
    std::uint64_t budgetBytes, FrameStatistics& frame);
  static void PlanByScreen(Communicator& communicator, DistributedField& field, RayScene& scene,
    const Wish& wish, int coarsest);

  std::string LimitText;
  std::array<GroupPlans, 2> Plans; ///< of still pictures of each eye
  double Slack = 1.0;              ///< times the interactive tolerance
  StepControl Steps;
  bool BySteps = false;      ///< the last frame
  int CoarsestStepLevel = 0; ///< that a frame by steps could have
};

} // namespace banyan

#endif
