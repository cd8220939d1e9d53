// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Quantize/AdaptiveTransform.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <vector>

namespace banyan
{
namespace
{

constexpr double GreatestEnd = 0x1p999;

void Check(const AdaptiveRule& rule, const ValueRange& range)
{
  if (!(rule.Equalization >= 0.0) || !(rule.Equalization <= 0.999))
  {
    throw Error("The equalization of an adaptive transform must lie within 0 and 0.999");
  }
  if (!(rule.SlopeRatio >= 1.0) || !(rule.SlopeRatio <= 0x1p20))
  {
    throw Error("The slope ratio of an adaptive transform must lie within 1 and 2^20");
  }
  if (rule.Cells < 1 || rule.Cells > AdaptiveRule::GreatestCells)
  {
    throw Error("An adaptive transform must have from 1 to 4094 cells");
  }
  if (!(range.Low >= -GreatestEnd) || !(range.High <= GreatestEnd) || range.Empty())
  {
    throw Error("The range of an adaptive transform must not be empty, nor go beyond 2^999");
  }
}

/// Whether every cell is far wider than doubles around it lie apart, the least slope included.
bool Resolved(const AdaptiveRule& rule, const ValueRange& range)
{
  const double cell = range.Width() / rule.Cells;
  const double magnitude = std::max(std::abs(range.Low), std::abs(range.High));
  return cell >= magnitude * 0x1p-40 && cell >= 0x1p-900;
}

/// Edges of equal cells, one of them 0 when 0 lies in the range.
std::vector<double> EdgesOf(const AdaptiveRule& rule, const ValueRange& range)
{
  const double cell = range.Width() / rule.Cells;
  std::vector<double> edges;
  for (int i = 0; i < rule.Cells; ++i)
  {
    edges.push_back(range.Low + range.Width() * (static_cast<double>(i) / rule.Cells));
  }
  edges.push_back(range.High);
  if (range.Low < 0 && range.High > 0)
  {
    const auto nearest = std::min_element(
      edges.begin(), edges.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    const bool inner = nearest != edges.begin() && nearest != edges.end() - 1;
    // An end is moved only where the table loses nothing by it.
    if (std::abs(*nearest) < cell * (inner ? 0.25 : 0x1p-10))
    {
      *nearest = 0.0;
    }
    else
    {
      edges.insert(std::upper_bound(edges.begin(), edges.end(), 0.0), 0.0);
    }
  }
  return edges;
}

/// Spreads the count of a bin over the cells that it overlaps, in proportion to width.
void Spread(const HistogramBin& bin, const std::vector<double>& edges, std::vector<double>& counts)
{
  const double count = static_cast<double>(bin.Count);
  const auto last = static_cast<std::ptrdiff_t>(counts.size()) - 1;
  const auto cellOf = [&](double x)
  {
    const auto above = std::upper_bound(edges.begin(), edges.end(), x) - edges.begin();
    return std::clamp<std::ptrdiff_t>(above - 1, 0, last);
  };
  if (!(bin.High > bin.Low))
  {
    counts[static_cast<std::size_t>(cellOf(bin.Low))] +=
      bin.Low >= edges.front() && bin.Low <= edges.back() ? count : 0.0;
    return;
  }
  for (std::ptrdiff_t i = cellOf(bin.Low); i <= cellOf(bin.High); ++i)
  {
    const std::size_t c = static_cast<std::size_t>(i);
    const double overlap = std::min(bin.High, edges[c + 1]) - std::max(bin.Low, edges[c]);
    counts[c] += overlap > 0 ? count * (overlap / (bin.High - bin.Low)) : 0.0;
  }
}

std::vector<double> CountsOf(const ValueHistogram& values, const std::vector<double>& edges)
{
  std::vector<double> counts(edges.size() - 1, 0.0);
  const bool zeroIsKnot = std::binary_search(edges.begin(), edges.end(), 0.0);
  for (HistogramBin bin : values.Bins())
  {
    if (zeroIsKnot && bin.Low == 0.0 && bin.High == 0.0)
    {
      continue;
    }
    bin.Low = std::max(bin.Low, values.Range().Low);
    bin.High = std::min(bin.High, values.Range().High);
    Spread(bin, edges, counts);
  }
  return counts;
}

/// The slope of every cell; empty when there are no values.
std::vector<double> SlopesOf(
  const AdaptiveRule& rule, const std::vector<double>& counts, const std::vector<double>& edges)
{
  const double total = std::accumulate(counts.begin(), counts.end(), 0.0);
  if (!(total > 0))
  {
    return {};
  }
  const double w = rule.Equalization;
  const double width = edges.back() - edges.front();
  const double cap = w > 0 ? (rule.SlopeRatio - 1.0) * (1.0 - w) / w : 0.0;
  std::vector<double> slopes;
  double mean = 0.0;
  for (std::size_t i = 0; i < counts.size(); ++i)
  {
    const double part = (edges[i + 1] - edges[i]) / width;
    slopes.push_back((1.0 - w) + w * std::min(counts[i] / total / part, cap));
    mean += slopes.back() * part;
  }
  for (double& slope : slopes)
  {
    slope /= mean;
  }
  return slopes;
}

/// Knots at all edges, y = x at the one that is 0, or else at the first.
std::vector<TransformKnot> KnotsOf(
  const std::vector<double>& edges, const std::vector<double>& slopes)
{
  const auto zero = std::find(edges.begin(), edges.end(), 0.0);
  const std::size_t anchor =
    zero == edges.end() ? 0 : static_cast<std::size_t>(zero - edges.begin());
  std::vector<TransformKnot> knots(edges.size());
  knots[anchor] = { edges[anchor], edges[anchor] };
  for (std::size_t i = anchor + 1; i < edges.size(); ++i)
  {
    knots[i] = { edges[i], knots[i - 1].Y + slopes[i - 1] * (edges[i] - edges[i - 1]) };
  }
  for (std::size_t i = anchor; i-- > 0;)
  {
    knots[i] = { edges[i], knots[i + 1].Y - slopes[i] * (edges[i + 1] - edges[i]) };
  }
  std::vector<TransformKnot> needed;
  for (std::size_t i = 0; i < knots.size(); ++i)
  {
    const bool inner = i > 0 && i + 1 < knots.size();
    if (!inner || i == anchor || slopes[i] != slopes[i - 1])
    {
      needed.push_back(knots[i]);
    }
  }
  return needed;
}

} // namespace

Transform MakeAdaptive(
  const ValueHistogram& values, const ValueRange& range, const AdaptiveRule& rule)
{
  Check(rule, range);
  if (!Resolved(rule, range))
  {
    return {};
  }
  const std::vector<double> edges = EdgesOf(rule, range);
  const std::vector<double> slopes = SlopesOf(rule, CountsOf(values, edges), edges);
  return slopes.empty() ? Transform() : Transform::Table(KnotsOf(edges, slopes));
}

double AsinhScale(const ValueHistogram& values, const ValueRange& range, const AsinhRule& rule)
{
  if (!(rule.Share >= 0.0) || !(rule.Share <= 1.0) || !(rule.LeastShareOfGreatest >= 0.0) ||
      !(rule.LeastShareOfGreatest <= 1.0))
  {
    throw Error("The shares of an asinh transform's rule must lie within 0 and 1");
  }
  const double greatest = range.Empty() ? 0.0 : std::max(std::abs(range.Low), std::abs(range.High));
  std::map<double, std::uint64_t> magnitudes; // by the bins' greater ends
  std::uint64_t total = 0;
  for (const HistogramBin& bin : values.Bins())
  {
    const double magnitude = std::min(std::max(std::abs(bin.Low), std::abs(bin.High)), greatest);
    if (magnitude > 0)
    {
      magnitudes[magnitude] += bin.Count;
      total += bin.Count;
    }
  }
  if (total == 0)
  {
    return 1.0;
  }
  const double rank = rule.Share * static_cast<double>(total);
  double scale = greatest;
  std::uint64_t below = 0;
  for (const auto& [magnitude, count] : magnitudes)
  {
    below += count;
    if (static_cast<double>(below) >= rank)
    {
      scale = magnitude;
      break;
    }
  }
  return std::clamp(std::max(scale, rule.LeastShareOfGreatest * greatest), 0x1p-1000, 0x1p1000);
}

} // namespace banyan
