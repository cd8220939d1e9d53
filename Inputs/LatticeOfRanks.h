// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_LatticeOfRanks_h
#define banyan_Inputs_LatticeOfRanks_h

#include "BanyanInputsModule.h"

#include <glm/vec3.hpp>

namespace banyan
{

class Communicator;
class ElementOctree;

/// Holds what the pieces of a mesh on all ranks have in common.
struct CommonLattice
{
  glm::dvec3 Origin{ 0.0 };
  glm::dvec3 Edge{ 0.0 };
  int CoarsestLevel = 0;
  int Shift = 0; ///< what levels of this rank's tree have to be raised by
};

/// Collective: levels are those of the whole mesh. Throws CollectiveError when the smallest cells
/// of one are no multiple of another's by a power of two.
/// @param tree of this rank; may be null
BANYANINPUTS_EXPORT CommonLattice LatticeOfRanks(Communicator& ranks, const ElementOctree* tree);

} // namespace banyan

#endif
