// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/TransferFunction.h"

#include "Base/Error.h"
#include "Base/Hash.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace banyan
{
namespace
{

/// Entries per unit of value. Bounded so that it stays finite in float: a range that narrow is a
/// step at Low, whatever the scale.
double EntriesPerValue(const TransferFunction& function)
{
  constexpr double steepest = 1e30;
  const double width = function.High - function.Low;
  const double entries = static_cast<double>(function.Entries.size()) - 1.0;
  return width > 0.0 ? std::min(entries / width, steepest) : steepest;
}

/// The lowest float that takes the entry above an edge.
float FloatEdge(const FunctionEdge& edge, double relativeTo, bool relative)
{
  constexpr double largest = std::numeric_limits<float>::max();
  constexpr float infinity = std::numeric_limits<float>::infinity();
  const double value = std::clamp(edge.Value - relativeTo, -largest, largest);
  const auto rounded = static_cast<float>(value);
  // Relative values are rounded as the edge is; others are floats already.
  const double exact = relative ? double{ rounded } : value;
  const bool isAbove = edge.Below ? double{ rounded } > exact : double{ rounded } >= exact;
  return isAbove ? rounded : std::nextafter(rounded, infinity);
}

void CheckEdges(const TransferFunction& function)
{
  const std::vector<FunctionEdge>& edges = function.Edges;
  if (edges.empty())
  {
    return;
  }
  if (edges.size() + 1 != function.Entries.size())
  {
    throw Error("A transfer function needs an edge between any two entries",
      { {}, {}, static_cast<std::uint64_t>(edges.size()),
        static_cast<std::uint64_t>(function.Entries.size()) - 1 });
  }
  for (std::size_t i = 0; i < edges.size(); ++i)
  {
    if (!std::isfinite(edges[i].Value) || (i > 0 && edges[i].Value < edges[i - 1].Value))
    {
      throw Error("The edges of a transfer function do not rise: edge " + std::to_string(i));
    }
  }
}

} // namespace

void TransferFunction::Check() const
{
  if (this->Entries.size() < 2)
  {
    throw Error("A transfer function needs at least two entries",
      { {}, {}, static_cast<std::uint64_t>(this->Entries.size()), 2 });
  }
  if (!std::isfinite(this->Low) || !std::isfinite(this->High))
  {
    throw Error("The range of the transfer function is not finite");
  }
  if (!(this->UnitDistance > 0.0) || !std::isfinite(this->UnitDistance))
  {
    throw Error("The opacity unit distance must be above 0");
  }
  CheckEdges(*this);
  for (std::size_t i = 0; i < this->Entries.size(); ++i)
  {
    const glm::vec4& entry = this->Entries[i];
    const bool finite = std::isfinite(entry.r) && std::isfinite(entry.g) && std::isfinite(entry.b);
    if (!finite || !(entry.a >= 0.0f && entry.a <= 1.0f))
    {
      throw Error("An entry of the transfer function has a colour that is not finite or an opacity "
                  "outside 0 to 1: entry " +
                  std::to_string(i));
    }
  }
}

ValueMask TransferFunction::VisibleBins(const MaskRange& range) const
{
  return VisibleValues(*this).Bins(range);
}

ValueMask VisibleValues::Bins(const MaskRange& range) const
{
  constexpr double infinity = std::numeric_limits<double>::infinity();
  const double width = range.High - range.Low;
  if (!(width > 0.0))
  {
    return this->Any(-infinity, infinity) ? MaskOfBins(0, 0) : ValueMask{ 0 };
  }
  // A value at the very edge may be counted to either side, depending on rounding.
  const double slack = 1e-9 * width + 4e-16 * std::max(std::abs(range.Low), std::abs(range.High));
  ValueMask mask = 0;
  for (int bin = 0; bin < 64; ++bin)
  {
    const double low = bin == 0 ? -infinity : range.Low + width * (bin / 64.0) - slack;
    const double high = bin == 63 ? infinity : range.Low + width * ((bin + 1) / 64.0) + slack;
    mask |= this->Any(low, high) ? MaskOfBins(bin, bin) : ValueMask{ 0 };
  }
  return mask;
}

bool TransferFunction::AnyVisible(double low, double high) const
{
  return VisibleValues(*this).Any(low, high);
}

VisibleValues::VisibleValues(const TransferFunction& function)
  : Low(function.Low)
  , Scale(EntriesPerValue(function))
{
  function.Check();
  this->VisibleBefore.resize(function.Entries.size() + 1, 0);
  for (std::size_t i = 0; i < function.Entries.size(); ++i)
  {
    this->VisibleBefore[i + 1] = this->VisibleBefore[i] + (function.Entries[i].a > 0.0f ? 1 : 0);
  }
  // Positions are computed in float by the marcher: about 1e-7 of the table's length off.
  this->Margin = 1.0 + 1e-6 * static_cast<double>(function.Entries.size());
  for (const FunctionEdge& edge : function.Edges)
  {
    this->Edges.push_back(edge.Value);
  }
  const double range[2] = { this->Low, this->Scale };
  const std::uint64_t edges = ShortHashOf(this->Edges.data(), this->Edges.size() * sizeof(double)) ^
                              ShortHashOf(range, sizeof(range));
  this->Hash =
    HashOf(this->VisibleBefore.data(), this->VisibleBefore.size() * sizeof(int), edges).Low;
}

VisibleValues::Span VisibleValues::EntriesOf(double low, double high) const
{
  if (!this->Edges.empty())
  {
    // Interpolations round in float, and so do values that are relative to the low end.
    double largest = 0.0;
    for (const double value : { low, high, low - this->Low, high - this->Low })
    {
      largest = std::isfinite(value) ? std::max(largest, std::abs(value)) : largest;
    }
    const double slack = 4e-7 * largest;
    const auto begin = this->Edges.begin();
    const auto first = std::lower_bound(begin, this->Edges.end(), low - slack);
    const auto last = std::upper_bound(first, this->Edges.end(), high + slack);
    return { static_cast<std::size_t>(first - begin), static_cast<std::size_t>(last - begin) };
  }
  const double last = static_cast<double>(this->VisibleBefore.size()) - 2.0;
  const auto position = [&](double value) { return (value - this->Low) * this->Scale; };
  return { static_cast<std::size_t>(
             std::clamp(std::floor(position(low) - this->Margin), 0.0, last)),
    static_cast<std::size_t>(std::clamp(std::ceil(position(high) + this->Margin), 0.0, last)) };
}

bool VisibleValues::Any(double low, double high) const
{
  if (!(low <= high))
  {
    return false;
  }
  const Span span = this->EntriesOf(low, high);
  return this->VisibleBefore[span.Last + 1] > this->VisibleBefore[span.First];
}

bool VisibleValues::All(double low, double high) const
{
  if (!(low <= high))
  {
    return false;
  }
  const Span span = this->EntriesOf(low, high);
  const int entries = static_cast<int>(span.Last - span.First) + 1;
  return this->VisibleBefore[span.Last + 1] - this->VisibleBefore[span.First] == entries;
}

float OpacityOfDepth::Of(float depth)
{
  const float x = 0.0f - (depth < Largest ? depth : Largest);
  const float octaves = (x * PerOctave + Round) - Round;
  const float r = (x - octaves * OctaveHigh) - octaves * OctaveLow;
  float sum = Terms[0];
  for (int i = 1; i < 6; ++i)
  {
    sum = sum * r + Terms[i];
  }
  const float less = (sum * r) * r + r; // exp(r) - 1
  const std::int32_t bits = (static_cast<std::int32_t>(octaves) + 127) * (1 << 23);
  float scale;
  std::memcpy(&scale, &bits, sizeof(scale));
  return (1.0f - scale) - scale * less;
}

EdgeTable::EdgeTable(const std::vector<FunctionEdge>& edges, double relativeTo, bool relative)
{
  for (const FunctionEdge& edge : edges)
  {
    this->Edges.push_back(FloatEdge(edge, relativeTo, relative));
  }
  constexpr std::size_t most = 4096;
  const std::size_t buckets = std::min(most, 4 * edges.size());
  const double width = double{ this->Edges.back() } - double{ this->Edges.front() };
  const double perValue = width > 0.0 ? static_cast<double>(buckets) / width : 0.0;
  this->Lookup.Low = this->Edges.front();
  this->Lookup.Scale = static_cast<float>(std::min(perValue, 1e30));
  this->Lookup.Bias = 0.0f;
  this->Lookup.Last = static_cast<float>(buckets) - 0.5f;
  // Finding a bucket is monotonic, rounding included: edges of other buckets are known to be below,
  // or above, all values of this one.
  std::vector<std::int32_t> edgesOf(buckets, 0);
  for (const float edge : this->Edges)
  {
    ++edgesOf[static_cast<std::size_t>(this->Lookup.PositionOf(edge))];
  }
  std::int32_t before = 0;
  std::int32_t largest = 0;
  for (const std::int32_t count : edgesOf)
  {
    this->First.push_back(before);
    before += count;
    largest = std::max(largest, count);
  }
  while (largest >> this->Lookup.Steps > 0)
  {
    ++this->Lookup.Steps;
  }
  this->Edges.resize(this->Edges.size() + (std::size_t{ 1 } << this->Lookup.Steps),
    std::numeric_limits<float>::infinity());
}

void EdgeTable::Complete(TableLookup& lookup) const
{
  const int transparent = lookup.Transparent;
  lookup = this->Lookup;
  lookup.Transparent = transparent;
  lookup.Edges = this->Edges.data();
  lookup.First = this->First.data();
}

StepTable::StepTable(const TransferFunction& function, double sampleDistance)
{
  function.Check();
  if (!(sampleDistance > 0.0) || !std::isfinite(sampleDistance))
  {
    throw Error("The sample distance must be above 0");
  }
  const double exponent = sampleDistance / function.UnitDistance;
  this->Entries.reserve(function.Entries.size() + 1);
  this->Extinctions.reserve(function.Entries.size() + 1);
  for (const glm::vec4& entry : function.Entries)
  {
    // log1p and expm1 keep the relative precision of small opacities.
    const double depth = -exponent * std::log1p(-double{ entry.a });
    const double opacity = -std::expm1(-depth);
    this->Entries.emplace_back(static_cast<float>(entry.r * opacity),
      static_cast<float>(entry.g * opacity), static_cast<float>(entry.b * opacity),
      static_cast<float>(1.0 - opacity));
    this->Extinctions.emplace_back(entry.r, entry.g, entry.b, static_cast<float>(depth));
  }
  this->Entries.emplace_back(0.0f, 0.0f, 0.0f, 1.0f);
  this->Extinctions.emplace_back(0.0f);

  constexpr double largest = std::numeric_limits<float>::max();
  const double scale = EntriesPerValue(function);
  this->LowDouble = function.Low;
  this->Absolute.Low = static_cast<float>(std::clamp(function.Low, -largest, largest));
  this->Absolute.Scale = static_cast<float>(scale);
  this->Absolute.Bias =
    static_cast<float>(0.5 + (double{ this->Absolute.Low } - function.Low) * scale);
  this->Absolute.Last = static_cast<float>(function.Entries.size()) - 0.5f;
  this->Absolute.Transparent = static_cast<int>(function.Entries.size());
  this->Relative = this->Absolute;
  this->Relative.Low = 0.0f;
  this->Relative.Bias = 0.5f;
  if (!function.Edges.empty())
  {
    this->AbsoluteEdges = std::make_shared<const EdgeTable>(function.Edges, 0.0, false);
    this->RelativeEdges = std::make_shared<const EdgeTable>(function.Edges, function.Low, true);
    this->AbsoluteEdges->Complete(this->Absolute);
    this->RelativeEdges->Complete(this->Relative);
  }
}

} // namespace banyan
