// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Encode/HiddenSamples.h"

#include <algorithm>

namespace banyan
{

std::vector<std::size_t> HiddenIn(const FieldGroup& field, const std::array<std::uint8_t, 3>& axes,
  std::size_t step, const PlaneRegion& region)
{
  std::vector<std::size_t> hidden;
  const std::uint8_t* const flags = field.HiddenAt(step);
  if (flags == nullptr)
  {
    return hidden;
  }
  const glm::ivec3 size = field.Samples;
  const std::int64_t strides[3] = { 1, size.x, std::int64_t{ size.x } * size.y };
  const auto at = [&](int axis, int place)
  {
    const int real = axes[static_cast<std::size_t>(axis)];
    return strides[real] *
           std::min(region.SampleAt(axis, place) << (2 * region.Plane), size[real] - 1);
  };
  std::size_t number = 0;
  for (int z = 0; z < region.Count.z; ++z)
  {
    for (int y = 0; y < region.Count.y; ++y)
    {
      for (int x = 0; x < region.Count.x; ++x, ++number)
      {
        if (flags[at(2, z) + at(1, y) + at(0, x)] != 0)
        {
          hidden.push_back(number);
        }
      }
    }
  }
  return hidden;
}

bool SameHidden(const FieldGroup& field, const std::array<std::uint8_t, 3>& axes, std::size_t step,
  const PlaneRegion& region)
{
  return field.HiddenAt(step) == field.HiddenAt(step - 1) ||
         HiddenIn(field, axes, step, region) == HiddenIn(field, axes, step - 1, region);
}

} // namespace banyan
