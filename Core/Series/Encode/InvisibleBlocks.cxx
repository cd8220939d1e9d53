// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/InvisibleBlocks.h"

#include "Base/ForEachScalarType.h"

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// Values that the choice is made from: a median does not need more.
constexpr std::int64_t ValuesToSee = 8192;

} // namespace

template <class T>
InvisibleBlocks<T>::InvisibleBlocks(const FieldGroup& field, const group::FieldHead& head,
  const LatticeDecoder<T>& decoder, const glm::ivec3& samples, const glm::i64vec3& stride)
  : Field(field)
  , Head(head)
  , Fills(field.FillValues)
  , Samples(samples)
  , Stride(stride)
{
  if (!field.Opacity || head.Exact)
  {
    return;
  }
  this->Intervals = InvisibleIntervals(*field.Opacity);
  std::vector<std::vector<double>> values(this->Intervals.Intervals().size());
  this->CollectInto(values);
  for (std::size_t i = 0; i < values.size(); ++i)
  {
    this->Choices.push_back(this->Choose(this->Intervals.Intervals()[i], values[i], decoder));
    this->Usable = this->Usable || this->Choices.back().Usable;
  }
}

template <class T>
void InvisibleBlocks<T>::CollectInto(std::vector<std::vector<double>>& values) const
{
  const std::int64_t count = std::int64_t{ this->Samples.x } * this->Samples.y * this->Samples.z;
  const std::int64_t gap = count / ValuesToSee + 1;
  const T* keyFrame = static_cast<const T*>(this->Field.Steps.back());
  for (std::int64_t i = 0; i < count; i += gap)
  {
    const T value = keyFrame[i * this->Field.Components];
    const int interval = this->Intervals.IntervalOf(static_cast<double>(value));
    if (interval >= 0 && std::isfinite(static_cast<double>(value)) && !this->Fills.Holds(value))
    {
      values[static_cast<std::size_t>(interval)].push_back(static_cast<double>(value));
    }
  }
}

template <class T>
typename InvisibleBlocks<T>::Choice InvisibleBlocks<T>::Choose(
  const ValueRange& interval, std::vector<double>& values, const LatticeDecoder<T>& decoder) const
{
  Choice choice;
  // A decoded block may be the bound away from what it became.
  const double low = this->Field.Map.Forward(interval.Low) + this->Field.Bound;
  const double high = this->Field.Map.Forward(interval.High) - this->Field.Bound;
  if (!(low <= high))
  {
    return choice;
  }
  // Where the key frame has no value there, other steps still may: the end next to the origin.
  double y = std::min(std::max(this->Head.Origin, low), high);
  if (!values.empty())
  {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    y = std::min(std::max(this->Field.Map.Forward(*middle), low), high);
  }
  const double number = std::round((y - this->Head.Origin) / this->Head.Step);
  choice.Number = static_cast<std::int32_t>(
    std::min(std::max(number, double(this->Head.Least)), double(this->Head.Greatest)));
  const double decoded = static_cast<double>(decoder.ValueOf(choice.Number));
  choice.Usable = decoded >= interval.Low && decoded <= interval.High;
  return choice;
}

template <class T>
int InvisibleBlocks<T>::IntervalOf(const T* values, const glm::ivec3& position) const
{
  const int edge = this->Field.BrickCells;
  glm::ivec3 low, high;
  for (int a = 0; a < 3; ++a)
  {
    low[a] = std::max(position[a] * edge - 1, 0);
    high[a] = std::min((position[a] + 1) * edge + 1, this->Samples[a]);
  }
  const T first = values[low.x * this->Stride.x + low.y * this->Stride.y + low.z * this->Stride.z];
  const int interval = this->Intervals.IntervalOf(static_cast<double>(first));
  if (interval < 0 || !this->Choices[static_cast<std::size_t>(interval)].Usable)
  {
    return -1;
  }
  const ValueRange& range = this->Intervals.Intervals()[static_cast<std::size_t>(interval)];
  for (int z = low.z; z < high.z; ++z)
  {
    for (int y = low.y; y < high.y; ++y)
    {
      const T* at = values + low.x * this->Stride.x + y * this->Stride.y + z * this->Stride.z;
      for (int x = low.x; x < high.x; ++x, at += this->Stride.x)
      {
        const double value = static_cast<double>(*at);
        if (!(value >= range.Low && value <= range.High) || !std::isfinite(value) ||
            this->Fills.Holds(*at))
        {
          return -1;
        }
      }
    }
  }
  return interval;
}

#define BANYAN_INSTANTIATE(T) template class InvisibleBlocks<T>
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
