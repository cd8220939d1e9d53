// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_GroupEncoder_h
#define banyan_Series_Encode_GroupEncoder_h

#include "Base/Hash.h"
#include "Series/Encode/FieldGroup.h"
#include "Series/Encode/SegmentFolder.h"
#include "Series/Encode/SeriesEncoder.h"

#include <functional>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Holds what encoding a group adds to the index of its series.
struct EncodedGroup
{
  SegmentIndex Segment;
  std::vector<double> Times;
  /// By array and component: Range, errors and counts of this group.
  std::vector<std::vector<ComponentIndex>> Measured;
  /// By array and step; of arrays with more than one component.
  std::vector<std::vector<ValueRange>> Magnitudes;
  EncodeStatistics Statistics;
  std::uint64_t BytesIn = 0;
};

/// Holds what the last step of a group decodes to, as the group after it needs it.
struct LastStep
{
  int Group = -1;               ///< -1: there is none
  std::vector<KeyFrame> Fields; ///< by component of all arrays
  std::vector<Hash128> Values;  ///< of the values as they came, by array
  SparePlanes Spare;            ///< memory of the group before
};

/// A group as it comes, borrowed.
struct GroupSteps
{
  int Number; ///< in the series
  const std::vector<double>& Times;
  /// By step and array, as SeriesEncoder::AddStep has them.
  const std::vector<std::vector<ArrayValues>>& Values;
  /// By array, of the step before the first. May be empty for the first group of the series, for a
  /// single step, where MayReferBefore is false, and where the encoder is told the last step of
  /// the group before.
  const std::vector<ArrayValues>& Before;
};

/// Whether groups of a series may refer to the last step of the group before: where the plan fixes
/// the range of some component, and the options do not close groups.
bool MayReferBefore(const SeriesIndex& plan, const EncodeOptions& options);

/// Encodes a group of consecutive steps into its segment. Groups may be encoded in any order, by
/// any process that has the same plan, to the same bytes: all that a group needs of the one before
/// is what its last step decodes to, which follows from the values of that step alone.
/// @param plan the index of the series, with ranges and bounds (see PlanSeries)
/// @param last if not null, replaced by that of this group
/// @param tell called with a value in [0, 1); may return false to interrupt
/// Throws Error; the segment is then not there.
EncodedGroup EncodeGroup(const SeriesIndex& plan, const EncodeOptions& options,
  SegmentFolder& folder, const GroupSteps& steps, LastStep* last, ThreadPool& pool,
  const std::function<bool(double)>& tell);

} // namespace banyan

#endif
