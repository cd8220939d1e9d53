// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Grid/LevelGrid.h"

namespace banyan
{

Grid GridOfLevel(const Grid& domain, int level)
{
  if (level == 0)
  {
    return domain;
  }
  Grid grid = domain;
  // In 64 bits and clamped: a level that is out of range must not shift into the sign.
  const std::int64_t factor = std::int64_t{ 1 } << (level < 40 ? level : 40);
  const glm::ivec3 samples = domain.Samples();
  grid.Extent.Lo = glm::ivec3(0);
  for (int axis = 0; axis < 3; ++axis)
  {
    grid.Extent.Hi[axis] = static_cast<int>((std::int64_t{ samples[axis] } - 1) / factor) + 1;
  }
  grid.Spacing = domain.Spacing * static_cast<double>(factor);
  grid.Origin = domain.Origin + domain.Direction * (domain.Spacing * glm::dvec3(domain.Extent.Lo));
  return grid;
}

} // namespace banyan
