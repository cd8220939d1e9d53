// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeOfRanks.h"

#include "RankTalk.h"

#include "Mesh/Octree/ElementOctree.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <vector>

namespace banyan
{

CommonLattice LatticeOfRanks(const RankTalk& talk, const ElementOctree* tree)
{
  const auto several = [&](const std::function<double(int)>& numbers, int count)
  {
    vtkMultiProcessStream mine;
    for (int i = 0; tree && i < count; ++i)
    {
      mine << numbers(i);
    }
    std::vector<std::vector<double>> all;
    for (vtkMultiProcessStream& theirs : talk.Exchange(mine))
    {
      all.emplace_back();
      for (int i = 0; !theirs.Empty() && i < count; ++i)
      {
        theirs >> all.back().emplace_back();
      }
    }
    return all;
  };
  CommonLattice common;
  common.Edge = glm::dvec3(std::numeric_limits<double>::max());
  common.Origin = common.Edge;
  const auto places =
    several([&](int i) { return i < 3 ? tree->Origin()[i] : tree->Edge()[i - 3]; }, 6);
  for (const std::vector<double>& theirs : places)
  {
    for (int axis = 0; axis < 3 && !theirs.empty(); ++axis)
    {
      common.Origin[axis] = std::min(common.Origin[axis], theirs[static_cast<std::size_t>(axis)]);
      common.Edge[axis] = std::min(common.Edge[axis], theirs[static_cast<std::size_t>(axis) + 3]);
    }
  }
  talk.Together(
    [&]
    {
      const glm::dvec3 times = tree ? tree->Edge() / common.Edge : glm::dvec3(1.0);
      common.Shift = static_cast<int>(std::lround(std::log2(times.x)));
      const glm::dvec3 off = glm::abs(times / std::exp2(common.Shift) - 1.0);
      if (std::max({ off.x, off.y, off.z }) > 1.0 / 16)
      {
        throw Error(
          "The widths of its smallest cells and of another rank's must differ by a factor of "
          "2, 4, 8 and so on");
      }
    });
  for (const std::vector<double>& theirs :
    several([&](int) { return static_cast<double>(tree->CoarsestLevel() + common.Shift); }, 1))
  {
    common.CoarsestLevel =
      std::max(common.CoarsestLevel, theirs.empty() ? 0 : static_cast<int>(theirs.front()));
  }
  return common;
}

} // namespace banyan
