#ifndef banyan_Series_GroupEncoder_h
#define banyan_Series_GroupEncoder_h

#include "Series/SegmentFolder.h"
#include "Series/SeriesEncoder.h"

#include <functional>
#include <vector>

namespace banyan
{

class ThreadPool;

/// What encoding a group adds to the index of its series.
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

/// Encodes a group of consecutive steps into its segment. Groups do not depend on each other: they
/// may be encoded in any order, by any process that has the same plan, to the same bytes.
/// @param plan the index of the series, with ranges and bounds (see PlanSeries)
/// @param number of the group in the series
/// @param steps values by step and array, as SeriesEncoder::AddStep has them
/// @param tell called with a value in [0, 1); may return false to interrupt
/// Throws Error; the segment is then not there.
EncodedGroup EncodeGroup(const SeriesIndex& plan, const EncodeOptions& options,
  SegmentFolder& folder, int number, const std::vector<double>& times,
  const std::vector<std::vector<ArrayValues>>& steps, ThreadPool& pool,
  const std::function<bool(double)>& tell);

/// Adds a group to the index; groups in order.
void AddGroup(const EncodedGroup& group, SeriesIndex& index);

} // namespace banyan

#endif
