// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_BrickRates_h
#define banyan_Benchmarks_BrickRates_h

#include "BenchScene.h"

#include <string>

namespace banyan::bench
{

/// What a brick of 16^3 cells is worth on its way to a rank that has not got it.
struct BrickRates
{
  double Bytes = 0.0;   ///< encoded
  double Seconds = 0.0; ///< processor time of reading it from the system's cache and decoding it
};

/// Encodes the middle of a volume, at most 256 samples per axis, with the default bound, and
/// decodes all bricks of it, one after the other.
/// @param folder an empty one, for the series
BrickRates MeasuredBrickRates(const Volume& volume, const std::string& folder);

} // namespace banyan::bench

#endif
