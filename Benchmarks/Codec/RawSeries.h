// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_RawSeries_h
#define banyan_Benchmarks_RawSeries_h

#include "Series/Format/SeriesIndex.h"
#include "Series/Grid/Grid.h"

#include <string>
#include <vector>

namespace banyan::bench
{

/// A time series of one scalar in memory, as the codecs get it: float32, `[step][z][y][x]`, x
/// fastest.
class RawSeries
{
public:
  /// Reads the JSON file that describes a file of raw values and then the values themselves:
  /// `{"name": "jet", "file": "jet.raw", "samples": [nx, ny, nz], "steps": n}`, and optionally
  /// `"range_percentile": p` (see `BoundRange`). The raw file is looked for beside the JSON file;
  /// its numbers are little-endian float32. Throws Error when either is damaged or missing.
  static RawSeries Open(const std::string& description);

  /// @param values `[step][z][y][x]`, a whole number of steps, at least one
  /// @param percentile in (0, 100]
  RawSeries(const std::string& name, const glm::ivec3& samples, std::vector<float> values,
    double percentile = 100.0);

  const std::string& Name() const { return this->SeriesName; }
  glm::ivec3 Samples() const { return this->SampleCounts; }
  int Steps() const { return this->StepCount; }
  std::size_t VoxelsPerStep() const;
  const float* Step(int step) const;
  Grid Domain() const;

  /// Extremes of the finite values of all steps.
  const ValueRange& FullRange() const { return this->Full; }
  /// The range that error bounds are made from. It ends at the given percentile of the finite
  /// values, so that a few extreme values do not decide how exact all the others are; values
  /// beyond it are data as good as any and have to meet the bound.
  const ValueRange& BoundRange() const { return this->Cut; }

private:
  std::string SeriesName;
  glm::ivec3 SampleCounts;
  int StepCount = 0;
  std::vector<float> Values;
  ValueRange Full;
  ValueRange Cut;
};

} // namespace banyan::bench

#endif
