// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/ProjectionTable.h"

#include "Base/Error.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

void Check(const RayBlend& blend)
{
  const int mode = static_cast<int>(blend.Mode);
  if (mode < 0 || mode > static_cast<int>(BlendMode::Average))
  {
    throw Error("There is no blend mode of number " + std::to_string(mode));
  }
  if (!std::isfinite(blend.Black) || !std::isfinite(blend.White))
  {
    throw Error("The values that an average shows in black and white are not finite");
  }
  if (!(blend.AveragedLow <= blend.AveragedHigh))
  {
    throw Error("The range of values to average has no lower and upper end");
  }
}

/// The values that interpolations, which round in float, may give of a range. Between equal values
/// there is no other.
ValueRange Widened(const ValueRange& range)
{
  if (range.Low == range.High)
  {
    return range;
  }
  const double slack = 4e-7 * std::max(std::abs(range.Low), std::abs(range.High));
  return { range.Low - slack, range.High + slack };
}

float ToFloat(double value)
{
  constexpr double largest = std::numeric_limits<float>::max();
  return static_cast<float>(std::clamp(value, -largest, largest));
}

/// Finite ones that are no lower, and no higher, than a finite value, or that it is rounded to.
float FloatAbove(double value)
{
  const float rounded = ToFloat(value);
  constexpr float largest = std::numeric_limits<float>::max();
  return rounded < value ? std::min(std::nextafter(rounded, largest), largest) : rounded;
}

float FloatBelow(double value)
{
  return -FloatAbove(-value);
}

glm::vec4 ColourOfRank(const RayScene& scene, float rank)
{
  const int entries = static_cast<int>(scene.Transfer.Entries.size());
  const int number = static_cast<int>(rank);
  const int entry = scene.Blend.Mode == BlendMode::Minimum ? entries - number : number - 1;
  const glm::vec4& colour = scene.Transfer.Entries[std::clamp(entry, 0, entries - 1)];
  return { colour.a * glm::vec3(colour), colour.a };
}

glm::vec4 GreyOfAverage(const glm::vec4& pixel)
{
  const float weight = pixel.g + pixel.b;
  const float grey = std::clamp(weight > 0.0f ? pixel.r / weight : 0.0f, 0.0f, 1.0f);
  return { grey, grey, grey, 1.0f };
}

} // namespace

ProjectionTable::ProjectionTable(const RayScene& scene, const StepTable& steps)
  : Mode(scene.Blend.Mode)
  , NearestSamples(scene.Interpolation == SampleInterpolation::Nearest)
  , RelativeTo(steps.Low())
  , Visible(scene.Transfer)
  , LowestCounted(scene.Blend.AveragedLow)
  , HighestCounted(scene.Blend.AveragedHigh)
{
  Check(scene.Blend);
  for (const glm::vec4& entry : scene.Transfer.Entries)
  {
    this->Opacities.push_back(entry.a);
    this->NothingVisible = this->NothingVisible && entry.a == 0.0f;
  }
  this->Opacities.push_back(0.0f);
  this->Absolute = this->MakeScale(scene.Blend, steps.Lookup(), 0.0);
  this->Relative = this->MakeScale(scene.Blend, steps.RelativeLookup(), steps.Low());
}

ProjectionTable::Scale ProjectionTable::MakeScale(
  const RayBlend& blend, const TableLookup& lookup, double relativeTo) const
{
  Scale scale;
  scale.Lookup = lookup;
  scale.Black = ToFloat(blend.Black - relativeTo);
  scale.PerValue = blend.White > blend.Black ? ToFloat(1.0 / (blend.White - blend.Black)) : 0.0f;
  scale.LowestCounted = ToFloat(blend.AveragedLow - relativeTo);
  scale.HighestCounted = ToFloat(blend.AveragedHigh - relativeTo);
  return scale;
}

float ProjectionTable::HighestRank(const ValueRange& range) const
{
  if (range.Empty())
  {
    return 0.0f;
  }
  const ValueRange values = Widened(range);
  if (this->Averages())
  {
    const bool some = values.High >= this->LowestCounted && values.Low <= this->HighestCounted;
    return some ? 1.0f : 0.0f;
  }
  if (this->NothingVisible)
  {
    return 0.0f;
  }
  // Finding entries is monotonic, rounding included: no sample has a better one than the best
  // value.
  const bool lowest = this->Mode == BlendMode::Minimum;
  const auto entryOf = [lowest](const TableLookup& lookup, const ValueRange& of)
  { return lookup.IndexOf(lowest ? FloatBelow(of.Low) : FloatAbove(of.High)); };
  const ValueRange shifted =
    Widened({ range.Low - this->RelativeTo, range.High - this->RelativeTo });
  const float absolute = this->RankOf(entryOf(this->Absolute.Lookup, values));
  return std::max(absolute, this->RankOf(entryOf(this->Relative.Lookup, shifted)));
}

bool ProjectionTable::OnlyCounts(const ValueRange& range) const
{
  const ValueRange values = Widened(range);
  return this->Averages() && !range.Empty() && !this->Visible.Any(values.Low, values.High) &&
         values.Low >= this->LowestCounted && values.High <= this->HighestCounted;
}

Combination CombinationOf(const RayBlend& blend)
{
  switch (blend.Mode)
  {
    case BlendMode::Composite:
      return Combination::Over;
    case BlendMode::Average:
      return Combination::Sum;
    default:
      return Combination::Largest;
  }
}

void FinishPicture(const RayScene& scene, FloatImage& picture)
{
  if (scene.Blend.Mode == BlendMode::Composite)
  {
    return;
  }
  for (glm::vec4& pixel : picture.Pixels)
  {
    if (pixel != glm::vec4(0.0f))
    {
      pixel = scene.Blend.Mode == BlendMode::Average ? GreyOfAverage(pixel)
                                                     : ColourOfRank(scene, pixel.r);
    }
  }
}

} // namespace banyan
