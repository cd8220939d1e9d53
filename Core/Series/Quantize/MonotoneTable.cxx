// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/MonotoneTable.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// Far enough from the limits of doubles that no difference, slope or product of them overflows.
constexpr double GreatestMagnitude = 0x1p1000;
constexpr double GreatestSlope = 0x1p900;

bool Usable(double coordinate)
{
  return std::abs(coordinate) <= GreatestMagnitude; // false for NaN
}

bool UsableSegment(double rise, double run)
{
  const double slope = rise / run;
  return rise >= 1.0 / GreatestMagnitude && run >= 1.0 / GreatestMagnitude &&
         slope <= GreatestSlope && slope >= 1.0 / GreatestSlope;
}

std::vector<TransformKnot> Checked(std::vector<TransformKnot> knots)
{
  if (knots.size() < 2 || knots.size() > MonotoneTable::GreatestKnots)
  {
    throw Error("The table of a transform must have from 2 to 4096 knots",
      { {}, {}, knots.size(), MonotoneTable::GreatestKnots });
  }
  for (std::size_t i = 0; i < knots.size(); ++i)
  {
    if (!Usable(knots[i].X) || !Usable(knots[i].Y))
    {
      throw Error("A knot of a transform's table is not finite, or beyond 2^1000");
    }
    if (i == 0)
    {
      continue;
    }
    const TransformKnot& before = knots[i - 1];
    if (!(knots[i].X > before.X) || !(knots[i].Y > before.Y))
    {
      throw Error("The knots of a transform's table must increase strictly, in x and in y");
    }
    if (!UsableSegment(knots[i].Y - before.Y, knots[i].X - before.X))
    {
      throw Error("Two knots of a transform's table are less than 2^-1000 apart, or the table is "
                  "steeper or flatter there than 2^900");
    }
  }
  return knots;
}

std::vector<double> Column(const std::vector<TransformKnot>& knots, double TransformKnot::*column)
{
  std::vector<double> numbers;
  numbers.reserve(knots.size());
  for (const TransformKnot& knot : knots)
  {
    numbers.push_back(knot.*column);
  }
  return numbers;
}

} // namespace

PiecewiseLinear::PiecewiseLinear(
  const std::vector<double>& arguments, const std::vector<double>& results)
{
  const std::size_t knots = arguments.size();
  for (std::size_t j = 0; j < knots; ++j)
  {
    const std::size_t from = j + 1 < knots ? j : j - 1;
    const double slope =
      (results[from + 1] - results[from]) / (arguments[from + 1] - arguments[from]);
    const double limit = j + 1 < knots ? results[j + 1] : std::numeric_limits<double>::infinity();
    this->Segments.push_back({ arguments[j], results[j], slope, limit });
  }
  // Twice as many buckets as knots: with evenly spaced ones at most one falls into each.
  const std::size_t buckets = 2 * knots;
  this->FirstOf.assign(buckets + 1, 0);
  this->BucketScale = static_cast<double>(buckets) / (arguments.back() - arguments.front());
  // An argument of bucket b lies behind every knot of the buckets before b, and before every knot
  // of those behind b, because BucketOf is increasing, however it rounds.
  for (std::size_t j = 0; j < knots; ++j)
  {
    this->FirstOf[this->BucketOf(arguments[j]) + 1] = static_cast<std::uint32_t>(j);
  }
  for (std::size_t b = 1; b <= buckets; ++b)
  {
    this->FirstOf[b] = std::max(this->FirstOf[b], this->FirstOf[b - 1]);
  }
}

std::size_t PiecewiseLinear::BucketOf(double argument) const
{
  const double last = static_cast<double>(this->FirstOf.size() - 2);
  const double bucket = (argument - this->Segments.front().Argument) * this->BucketScale;
  // Comparisons with NaN are false: it goes to the first bucket.
  return static_cast<std::size_t>(bucket > 0 ? (bucket < last ? bucket : last) : 0.0);
}

std::size_t PiecewiseLinear::SegmentOf(double argument) const
{
  const std::size_t bucket = this->BucketOf(argument);
  std::size_t low = this->FirstOf[bucket];
  std::size_t high = this->FirstOf[bucket + 1];
  if (high - low <= 1)
  {
    // Evenly spaced knots end here: there is no branch that a processor could guess wrong.
    return low + (this->Segments[high].Argument <= argument ? high - low : 0);
  }
  while (low < high)
  {
    const std::size_t middle = (low + high + 1) / 2;
    if (this->Segments[middle].Argument <= argument)
    {
      low = middle;
    }
    else
    {
      high = middle - 1;
    }
  }
  return low;
}

// Here and not in the header: multiplication and addition must not be contracted to one operation,
// and only Core is compiled so.
double PiecewiseLinear::operator()(double argument) const
{
  double result = 0.0;
  this->Apply(&argument, 1, &result);
  return result;
}

void PiecewiseLinear::Apply(const double* arguments, std::size_t count, double* results) const
{
  for (std::size_t i = 0; i < count; ++i)
  {
    const double argument = arguments[i];
    const Segment& segment = this->Segments[this->SegmentOf(argument)];
    const double result = segment.Result + (argument - segment.Argument) * segment.Slope;
    results[i] = result > segment.Limit ? segment.Limit : result;
  }
}

MonotoneTable::MonotoneTable(std::vector<TransformKnot> knots)
  : Points(Checked(std::move(knots)))
  , Up(Column(this->Points, &TransformKnot::X), Column(this->Points, &TransformKnot::Y))
  , Down(Column(this->Points, &TransformKnot::Y), Column(this->Points, &TransformKnot::X))
{
}

} // namespace banyan
