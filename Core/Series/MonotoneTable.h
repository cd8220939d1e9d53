#ifndef banyan_Series_MonotoneTable_h
#define banyan_Series_MonotoneTable_h

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

/// One direction of a piecewise-linear map: from arguments `At` to results `To`.
///
/// Result = To[j] + (argument - At[j]) * Slope[j], not above To[j + 1], where j is the last segment
/// that starts at or before the argument (the first, when none does): subtraction, multiplication,
/// addition, in double precision. Hence increasing in the weak sense, exact at the knots, and the
/// same bits everywhere. Beyond the ends the outer segments go on. Finding j costs O(1) for knots
/// that are evenly spaced, O(log n) at worst.
class PiecewiseLinear
{
public:
  PiecewiseLinear(std::vector<double> at, std::vector<double> to);

  double operator()(double argument) const;

  /// Greatest slope of the segments that an interval [low, high] of arguments touches.
  double GreatestSlope(double low, double high) const;
  const std::vector<double>& Slopes() const { return this->Slope; }

private:
  std::size_t SegmentOf(double argument) const;
  std::size_t BucketOf(double argument) const;

  std::vector<double> At;
  std::vector<double> To;
  std::vector<double> Slope;
  /// Segments to search, per bucket of equal width: FirstOf[b] to FirstOf[b + 1], both included.
  std::vector<std::uint32_t> FirstOf;
  double BucketScale = 0.0;
};

/// A strictly monotone piecewise-linear map and its inverse.
class MonotoneTable
{
public:
  static constexpr std::size_t GreatestKnots = 4096;

  /// @param knots 2 to GreatestKnots, x and y strictly increasing, of magnitudes up to 2^1000, each
  /// segment with a slope within [2^-900, 2^900]. Throws Error otherwise.
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
