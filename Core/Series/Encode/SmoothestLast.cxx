// SPDX-License-Identifier: BSD-3-Clause
#include "Base/ForEachScalarType.h"
#include "Series/Encode/FieldQuantizer.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace banyan
{

glm::i64vec3 StridesOf(const FieldGroup& field)
{
  const std::int64_t row = std::int64_t{ field.Components } * field.Samples.x;
  return { field.Components, row, row * field.Samples.y };
}

template <class T>
std::array<std::uint8_t, 3> SmoothestLast(const FieldGroup& field, const void* step)
{
  const T* values = static_cast<const T*>(step);
  const glm::i64vec3 stride = StridesOf(field);
  // A sparse grid of samples is enough to tell the axes apart.
  glm::ivec3 gap;
  for (int a = 0; a < 3; ++a)
  {
    gap[a] = std::max(1, field.Samples[a] / 24);
  }
  double roughness[3] = {};
  // No outlier decides alone.
  const double most =
    field.Expected.Empty() ? std::numeric_limits<double>::max() : field.Expected.Width();
  for (int a = 0; a < 3; ++a)
  {
    if (field.Samples[a] < 3)
    {
      roughness[a] = std::numeric_limits<double>::infinity();
      continue;
    }
    for (int z = a == 2 ? 1 : 0; z < field.Samples.z - (a == 2 ? 1 : 0); z += gap.z)
    {
      for (int y = a == 1 ? 1 : 0; y < field.Samples.y - (a == 1 ? 1 : 0); y += gap.y)
      {
        for (int x = a == 0 ? 1 : 0; x < field.Samples.x - (a == 0 ? 1 : 0); x += gap.x)
        {
          const T* at = values + x * stride.x + y * stride.y + z * stride.z;
          const double bend = static_cast<double>(at[stride[a]]) +
                              static_cast<double>(at[-stride[a]]) -
                              2.0 * static_cast<double>(at[0]);
          roughness[a] += std::isfinite(bend) ? std::min(std::abs(bend), most) : 0.0;
        }
      }
    }
  }
  std::array<std::uint8_t, 3> axes{ 0, 1, 2 };
  // Only what is clearly smoother goes behind, so that groups that are alike have the same order
  // and may refer to each other.
  constexpr double clearly = 1.125;
  for (const std::size_t a : { 0, 1, 0 })
  {
    if (roughness[axes[a]] * clearly < roughness[axes[a + 1]])
    {
      std::swap(axes[a], axes[a + 1]);
    }
  }
  return axes;
}

#define BANYAN_INSTANTIATE(T)                                                                      \
  template std::array<std::uint8_t, 3> SmoothestLast<T>(const FieldGroup&, const void*)
BANYAN_FOR_EACH_SCALAR_TYPE(BANYAN_INSTANTIATE);
#undef BANYAN_INSTANTIATE

} // namespace banyan
