// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_DecodeTimes_h
#define banyan_Programs_DecodeTimes_h

#include <cstdint>
#include <string>
#include <vector>

namespace banyan
{

/// Microseconds of single measurements.
struct TimeSummary
{
  std::int64_t Count = 0;
  double Median = 0.0;
  double Mean = 0.0;
  double Percentile95 = 0.0;
};

/// @param microseconds may be in any order, and empty
TimeSummary Summarize(std::vector<double> microseconds);

/// How long decoding takes on one thread, at the finest level. Macro voxels need none and are left
/// out.
struct DecodeTimes
{
  /// A random brick: tables at hand, the bytes of payloads in memory, nothing decoded. What other
  /// bricks around it or at later steps leave in the cache of this process makes them faster.
  TimeSummary Warm;
  TimeSummary Finest; ///< the same where the coarser planes that it is predicted from are decoded
  /// A random brick and the node table it needs, of a series that was opened just before (opening
  /// itself is not in it), after the system was told to forget the file; how far it does is up to
  /// the system.
  TimeSummary Cold;
  TimeSummary Open; ///< opening the series
  /// All bricks of some steps in order, from the first step of a group on, nothing being decoded
  /// before: bytes of decoded values, macro voxels left out, over seconds.
  double SequentialBytesPerSecond = 0.0;
};

/// @param path of the series; nothing else in the process should have it open
/// @param array number of the array, whose first component is measured
/// @param seed of the choice of steps and bricks
/// Takes some seconds. Throws Error as SeriesFile does.
DecodeTimes MeasureDecodeTimes(const std::string& path, int array, std::uint64_t seed);

} // namespace banyan

#endif
