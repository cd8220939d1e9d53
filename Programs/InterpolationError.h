// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Programs_InterpolationError_h
#define banyan_Programs_InterpolationError_h

#include <cstdint>

namespace banyan
{

class SeriesFile;

/// How far values that are interpolated between steps may be from the truth, which no file has:
/// estimated. A step is left out, made of both steps around it, and compared with what it is. Where
/// values are smooth over three steps, the error between two grows with the square of the time
/// between them: so steps a quarter as far off are told from those that were left out. Errors of
/// encoding are among the differences.
struct InterpolationError
{
  int Steps = 0;               ///< that were left out, one after the other; 0: nothing is known
  int EveryNth = 1;            ///< of the samples per axis were compared
  double LargestLeftOut = 0.0; ///< difference, in the units of the data
  double Largest = 0.0;        ///< estimate between two steps, of the values compared
  double Rms = 0.0;            ///< the same, root of the mean square
};

/// Reads 64 steps at most, spread over the series, with those around them, at a level of at most
/// 2^18 samples or the coarsest. Fill values, hidden points and what is not finite are left out.
/// @return nothing is known of integers, meshes, and series of less than three steps
/// Throws Error as SeriesFile does.
InterpolationError EstimateInterpolation(const SeriesFile& series, int array, int component);

} // namespace banyan

#endif
