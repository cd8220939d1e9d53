// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_MonotoneTable_h
#define banyan_Series_Quantize_MonotoneTable_h

#include <cstddef>
#include <cstdint>
#include <vector>

namespace banyan
{

/// A point that a piecewise-linear transform goes through.
struct TransformKnot
{
  double X = 0.0; ///< value
  double Y = 0.0; ///< transformed value
};

/// One direction of a piecewise-linear map: from arguments a0 < a1 < ... to results r0 < r1 < ...
///
/// Result = r[j] + (argument - a[j]) * slope[j], but not above r[j + 1], where j is the last knot
/// at or before the argument (the first, when none is) and slope[j] that of the segment behind it
/// (the last knot has the slope of the segment before it): one subtraction, multiplication and
/// addition in double precision. Hence increasing in the weak sense, exact at the knots, and the
/// same bits everywhere. Beyond the ends the outer segments go on. Finding j costs O(1) for knots
/// that are evenly spaced, O(log n) at worst.
class PiecewiseLinear
{
public:
  struct Segment
  {
    double Argument;
    double Result;
    double Slope;
    double Limit; ///< result of the next knot; infinite for the last
  };

  /// @param arguments,results as many of each, at least 2, strictly increasing
  PiecewiseLinear(const std::vector<double>& arguments, const std::vector<double>& results);

  double operator()(double argument) const;
  /// For `count` arguments; both arrays may be the same.
  void Apply(const double* arguments, std::size_t count, double* results) const;

  const std::vector<Segment>& GetSegments() const { return this->Segments; }

private:
  std::size_t SegmentOf(double argument) const;
  std::size_t BucketOf(double argument) const;

  std::vector<Segment> Segments; ///< one per knot
  /// Segments to search, per bucket of equal width: FirstOf[b] to FirstOf[b + 1], both included.
  std::vector<std::uint32_t> FirstOf;
  double BucketScale = 0.0;
};

/// A strictly monotone piecewise-linear map and its inverse.
class MonotoneTable
{
public:
  static constexpr std::size_t GreatestKnots = 4096;

  /// @param knots 2 to GreatestKnots, of magnitudes up to 2^1000; x and y increase from knot to
  /// knot, by 2^-1000 at least, and with slopes within [2^-900, 2^900]. Throws Error otherwise.
  explicit MonotoneTable(std::vector<TransformKnot> knots);

  const std::vector<TransformKnot>& Knots() const { return this->Points; }
  const PiecewiseLinear& Forward() const { return this->Up; }
  const PiecewiseLinear& Inverse() const { return this->Down; }

private:
  std::vector<TransformKnot> Points;
  PiecewiseLinear Up;
  PiecewiseLinear Down;
};

} // namespace banyan

#endif
