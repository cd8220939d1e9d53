// SPDX-License-Identifier: BSD-3-Clause
#include "LatticeOfRanks.h"

#include "Mesh/Octree/ElementOctree.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Communicate/Communicator.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace banyan
{
namespace
{

/// Plain memory: ranks send it as it is.
struct Lattice
{
  glm::dvec3 Origin{ std::numeric_limits<double>::max() };
  glm::dvec3 Edge{ std::numeric_limits<double>::max() };
};

} // namespace

CommonLattice LatticeOfRanks(Communicator& ranks, const ElementOctree* tree)
{
  // Ranks without a tree have the largest numbers there are.
  Lattice mine;
  if (tree)
  {
    mine = { tree->Origin(), tree->Edge() };
  }
  std::vector<Lattice> all(static_cast<std::size_t>(ranks.Size()));
  ranks.AllGather(&mine, sizeof(mine), all.data());
  CommonLattice common;
  common.Origin = common.Edge = glm::dvec3(std::numeric_limits<double>::max());
  for (const Lattice& theirs : all)
  {
    common.Origin = glm::min(common.Origin, theirs.Origin);
    common.Edge = glm::min(common.Edge, theirs.Edge);
  }
  Collective(ranks,
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
  common.CoarsestLevel =
    static_cast<int>(AllMax(ranks, tree ? tree->CoarsestLevel() + common.Shift : 0));
  return common;
}

} // namespace banyan
