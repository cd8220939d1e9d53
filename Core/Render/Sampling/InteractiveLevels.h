// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Sampling_InteractiveLevels_h
#define banyan_Render_Sampling_InteractiveLevels_h

#include "Render/Scene/RaySampling.h"

#include <array>

namespace banyan
{

/// The samplings of pictures that keep no tolerance, as no probes tell their error: projections,
/// volumes whose samples are taken as they are (labels), and coarse pictures before exact ones.
/// Step 0 is the picture as it should be. Each step has rays in half as many rows and columns of
/// pixels, or takes the next coarser level, with as much more between samples as its cells are
/// larger:
///
///     step             0   1   2   3   4   5   6
///     level            0   0   0   1   1   2   3   and so on
///     pixels per ray   1   2   4   4   8   8   8   in rows and columns
///
/// Few samplings give better pictures in less time (banyan-bench-steps).
class InteractiveLevels
{
public:
  /// @param coarsestLevel that can be drawn, at least 0
  static int Last(int coarsestLevel) { return coarsestLevel + StrideSteps; }

  /// @param step at least 0; those beyond the last are the last
  /// @param distance world length between samples at step 0, above 0
  static RaySampling SamplingOf(int step, double distance, int coarsestLevel);

private:
  static constexpr int StrideSteps = 3;
  static_assert(1 << StrideSteps == RaySampling::LargestStride, "the last step has the largest");
};

/// Chooses the step whose frames keep a promised time: a later one after a frame that took longer,
/// and one before once that is expected to keep it too.
class StepControl
{
public:
  /// That frames should have now.
  /// @param beginsCoarse whether the first frame has the last step
  int Step(bool beginsCoarse = false)
  {
    this->Current = beginsCoarse && !this->HasFrames ? MostSteps - 1 : this->Current;
    return this->Current;
  }

  /// @param seconds that the last frame took
  /// @param promised seconds; 0 for any
  /// @param coarsestLevel as for InteractiveLevels
  void FrameTook(double seconds, double promised, int coarsestLevel);

private:
  static constexpr int MostSteps = 16;

  int Current = 0;
  bool HasFrames = false;
  std::array<double, MostSteps> Taken{}; ///< seconds, per step; less and less as time goes by
};

} // namespace banyan

#endif
