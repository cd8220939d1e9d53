// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Quantize_PlaneFilling_h
#define banyan_Series_Quantize_PlaneFilling_h

#include "Codec/BlockEncoder.h"

#include <algorithm>
#include <cstdint>

namespace banyan
{

/// Numbers for samples that are not held: on the line between those around, so that predictions
/// cost nothing there.
/// @param otherwise when none is held
template <class Number>
void FillGaps(const bool* held, int count, std::int32_t otherwise, Number* numbers)
{
  int before = -1;
  for (int x = 0; x < count;)
  {
    if (held[x])
    {
      before = x++;
      continue;
    }
    const int after = static_cast<int>(std::find(held + x, held + count, true) - held);
    const std::int64_t right = after < count ? numbers[after]
                               : before >= 0 ? numbers[before]
                                             : otherwise;
    const std::int64_t left = before >= 0 ? numbers[before] : right;
    for (; x < after; ++x)
    {
      numbers[x] = static_cast<Number>(left + (right - left) * (x - before) / (after - before));
    }
  }
}

/// Repeats the last samples beyond the field's end, where a box of samples ends with it.
/// @param low its first sample, and @param high the end of each axis
template <class Number>
void Pad(PlaneNumbers& plane, const glm::ivec3& low, const glm::ivec3& high)
{
  const glm::ivec3 n = plane.Samples;
  glm::ivec3 end;
  for (int a = 0; a < 3; ++a)
  {
    end[a] = high[a] == n[a] ? plane.Padded[a] : high[a];
  }
  if (end == high)
  {
    return;
  }
  const auto row = [&plane](int y, int z) {
    return plane.Data<Number>() + plane.IndexOf({ 0, y, z });
  };
  for (int z = low.z; z < end.z; ++z)
  {
    for (int y = low.y; y < end.y; ++y)
    {
      Number* to = row(y, z);
      if (y >= n.y || z >= n.z)
      {
        const Number* from = row(std::min(y, n.y - 1), std::min(z, n.z - 1));
        std::copy(from + low.x, from + end.x, to + low.x);
      }
      else
      {
        std::fill(to + high.x, to + end.x, to[high.x - 1]);
      }
    }
  }
}

/// Every fourth sample.
template <class Number>
void Coarsen(const PlaneNumbers& fine, PlaneNumbers& coarse)
{
  const glm::ivec3 last = fine.Samples - 1;
  for (int z = 0; z < coarse.Samples.z; ++z)
  {
    for (int y = 0; y < coarse.Samples.y; ++y)
    {
      const Number* from =
        fine.Data<Number>() + fine.IndexOf({ 0, std::min(4 * y, last.y), std::min(4 * z, last.z) });
      Number* to = coarse.Data<Number>() + coarse.IndexOf({ 0, y, z });
      for (int x = 0; x < coarse.Samples.x; ++x)
      {
        to[x] = from[std::min(4 * x, last.x)];
      }
    }
  }
  Pad<Number>(coarse, glm::ivec3(0), coarse.Samples);
}

} // namespace banyan

#endif
