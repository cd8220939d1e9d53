// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_PreIntegrationTimes_h
#define banyan_Benchmarks_PreIntegrationTimes_h

#include "BenchScene.h"

namespace banyan::bench
{

/// How an interval between two samples is integrated.
enum class Method
{
  Middle, ///< the entry of its middle
  Ends,   ///< the mean over the values between its ends
  Slope   ///< the mean over those that the slope at its middle spans
};

struct MethodTimes
{
  double NanosecondsPerSample = 0; ///< of one thread; the least of some pictures
  double TableMilliseconds = 0;    ///< once for each function and sample distance
};

/// Times a plain loop over samples, the same for all methods but for what they look up: entries of
/// one value, or of two, in a table of 512^2. Floats, one ray after the other, no sample left out.
/// @param voxels sample distance
MethodTimes TimesOf(const BenchScene& scene, double voxels, Method method);

} // namespace banyan::bench

#endif
