// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/JoinedComponents.h"

#include "Base/Error.h"
#include "Render/Bricks/ArraySamples.h"
#include "Render/Bricks/ColourNumbers.h"
#include "Render/Bricks/SampledBox.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace banyan
{
namespace
{

/// Calls function(position, value) for all samples, x fastest.
template <class Function>
void ForSamples(const BrickView& view, const glm::ivec3& samples, Function&& function)
{
  Dispatch(view.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* values = static_cast<const T*>(view.Values);
      std::size_t at = 0;
      for (int z = 0; z < samples.z; ++z)
      {
        for (int y = 0; y < samples.y; ++y)
        {
          const T* row = values + z * view.Stride[2] + y * view.Stride[1];
          for (int x = 0; x < samples.x; ++x, ++at)
          {
            function(at, static_cast<double>(row[x * view.Stride[0]]));
          }
        }
      }
    });
}

void JoinLengths(const std::vector<BrickView>& parts, const glm::ivec3& samples, float* lengths)
{
  const std::size_t count = static_cast<std::size_t>(samples.x) * samples.y * samples.z;
  std::fill_n(lengths, count, 0.0f);
  for (const BrickView& part : parts)
  {
    ForSamples(part, samples,
      [&](std::size_t at, double value) { lengths[at] += static_cast<float>(value * value); });
  }
  std::transform(lengths, lengths + count, lengths, [](float sum) { return std::sqrt(sum); });
}

void JoinColours(const std::vector<BrickView>& parts, const glm::ivec3& samples, double* colours)
{
  const std::size_t components = parts.size();
  const std::size_t count = static_cast<std::size_t>(samples.x) * samples.y * samples.z;
  std::vector<double> all(components * count);
  for (std::size_t c = 0; c < components; ++c)
  {
    ForSamples(
      parts[c], samples, [&](std::size_t at, double value) { all[at * components + c] = value; });
  }
  for (std::size_t at = 0; at < count; ++at)
  {
    colours[at] = ColourNumber::Of(&all[at * components], static_cast<int>(components));
  }
}

ValueRange LengthBounds(const std::vector<ValueRange>& components)
{
  double low = 0.0;
  double high = 0.0;
  for (const ValueRange& range : components)
  {
    const double largest = std::max(std::abs(range.Low), std::abs(range.High));
    const bool straddles = range.Low <= 0.0 && range.High >= 0.0;
    const double smallest = straddles ? 0.0 : std::min(std::abs(range.Low), std::abs(range.High));
    low += smallest * smallest;
    high += largest * largest;
  }
  return { std::sqrt(low), std::sqrt(high) };
}

ValueRange ColourBounds(const std::vector<ValueRange>& components)
{
  double low[4] = {};
  double high[4] = {};
  const int count = static_cast<int>(std::min<std::size_t>(components.size(), 4));
  for (int c = 0; c < count; ++c)
  {
    low[c] = components[static_cast<std::size_t>(c)].Low;
    high[c] = components[static_cast<std::size_t>(c)].High;
  }
  // Rises with each component.
  return { ColourNumber::ShownOf(ColourNumber::Of(low, count)),
    ColourNumber::ShownOf(ColourNumber::Of(high, count)) };
}

} // namespace

void CheckColours(int components)
{
  if (components != 3 && components != 4)
  {
    throw Error("Colours have three components, or four with their opacity, and the array has " +
                std::to_string(components));
  }
}

ScalarType JoinedType(int how)
{
  return how == SampleArray::Colours ? ScalarType::Float64 : ScalarType::Float32;
}

BrickView Joined(int how, const std::vector<BrickView>& parts, const glm::ivec3& samples)
{
  void* values = nullptr;
  BrickView view = AllocateView({ glm::ivec3(0), samples }, JoinedType(how), values);
  how == SampleArray::Colours ? JoinColours(parts, samples, static_cast<double*>(values))
                              : JoinLengths(parts, samples, static_cast<float*>(values));
  return view;
}

ValueRange JoinedBounds(int how, const std::vector<ValueRange>& components)
{
  const bool none = std::any_of(
    components.begin(), components.end(), [](const ValueRange& range) { return range.Empty(); });
  if (none)
  {
    return {};
  }
  return how == SampleArray::Colours ? ColourBounds(components) : LengthBounds(components);
}

} // namespace banyan
