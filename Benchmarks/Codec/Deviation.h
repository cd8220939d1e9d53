// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_Deviation_h
#define banyan_Benchmarks_Deviation_h

#include <cstddef>
#include <cstdint>

namespace banyan::bench
{

/// How far decoded values lie from the original ones, voxel by voxel in float32.
///
/// NaN and infinities have to come back as what they were: a NaN as any NaN, an infinity with its
/// sign. Where they do not, or a finite value becomes one of them, the deviation is infinite.
class Deviation
{
public:
  void Include(const float* original, const float* decoded, std::size_t count);

  /// Largest |decoded - original|, in double precision.
  double Largest() const { return this->LargestError; }
  double RootMeanSquare() const;
  /// 20 log10(range / RMSE); infinite for equal values.
  double SignalToNoiseDecibels(double range) const;

private:
  double LargestError = 0;
  double SumOfSquares = 0;
  std::uint64_t Count = 0;
};

} // namespace banyan::bench

#endif
