// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_SeriesReport_h
#define banyan_Programs_SeriesReport_h

#include "InterpolationError.h"
#include "Series/Decode/BrickTree.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Points/GridPoints.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace banyan
{

/// Bricks of one field, or of several together.
struct BrickCounts
{
  std::int64_t Bricks = 0;
  std::int64_t MacroVoxels = 0; ///< one value everywhere, no payload
  std::int64_t NonFinite = 0;   ///< with NaN or infinities
  std::int64_t Unchanged = 0;   ///< same identity as at the step before; macro voxels among them
  /// With a payload that no field before it in the segment has (in the order of step, array,
  /// component and level).
  std::int64_t Stored = 0;
  std::int64_t Shared = 0; ///< neither macro voxels nor stored: an earlier brick has the bytes
  std::uint64_t StoredBytes = 0;

  void Add(const BrickCounts& other);
};

/// Holds what the node tables say of one component at one step.
struct StepReport
{
  int Step = 0;
  double Time = 0.0;
  ValueRange Range;                ///< of the decoded finite values
  std::vector<BrickCounts> Levels; ///< finest first
  CountsBySize MacroVoxels;        ///< of the finest level
  CountsBySize Unchanged;          ///< subtrees of the finest level; all 0 at step 0
};

struct ComponentReport
{
  int Array = 0;
  int Component = 0;
  std::string Name;     ///< of the array, with the component's if there are several
  ComponentIndex Index; ///< as the file says
  ScalarType Type = ScalarType::Float32;
  std::vector<StepReport> Steps;             ///< those that were asked for
  std::optional<InterpolationError> Between; ///< if it was asked for

  /// Returns the RMSE of one step; nothing where the series does not say it.
  std::optional<double> RmseOf(const StepReport& step) const;
  double Rmse() const; ///< over all finite values of the series; 0 when there are none
  /// Returns the asked step whose values have the narrowest range that is not 0 wide; null when
  /// there is none. Errors are largest in relation to it.
  const StepReport* NarrowestStep() const;
  BrickCounts Sum(int level) const;
  CountsBySize MacroVoxels() const; ///< over the asked steps
  CountsBySize Unchanged() const;
};

/// Holds what can be said of a series without decoding it.
struct SeriesReport
{
  std::string File;
  SeriesIndex Index;
  std::uint64_t IndexBytes = 0;
  std::uint64_t SegmentBytes = 0;
  std::vector<ComponentReport> Components; ///< of the arrays that were asked for

  /// With the mesh or points, if there are some.
  std::uint64_t EncodedBytes() const
  {
    return this->IndexBytes + this->SegmentBytes +
           (this->Index.Mesh ? this->Index.Mesh->Bytes : 0) + BytesOfPoints(this->Index);
  }
  /// Values of all steps, arrays and components: what "per value" refers to.
  std::int64_t Values() const;
  double BitsPerValue() const; ///< everything counted
  /// Voxels of a cube of that edge, cut where the volume is flat.
  std::int64_t VoxelsOf(std::int64_t edge) const;
  /// Voxels that a node stands over at most, `level` levels above the bricks.
  std::int64_t VoxelsBelow(std::size_t level) const;
};

/// Says what to report on.
struct ReportChoice
{
  int Step = -1;     ///< -1: all
  std::string Array; ///< empty: all
};

/// Reads index and node tables. Throws Error when the choice names what is not there, the series
/// holds nothing, or a file is damaged. All components of the result have steps.
SeriesReport ReportSeries(const SeriesFile& file, const ReportChoice& choice);

/// 20 log10(width / rmse) in dB; nothing when either is 0.
std::optional<double> Decibels(double width, double rmse);

} // namespace banyan

#endif
