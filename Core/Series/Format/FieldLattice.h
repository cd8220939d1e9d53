// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_FieldLattice_h
#define banyan_Series_Format_FieldLattice_h

#include "Base/ScalarType.h"
#include "Series/Format/GroupFormat.h"
#include "Series/Quantize/Transform.h"
#include "Series/Quantize/ValueRange.h"

namespace banyan
{

/// Greatest |lattice number| that is coded; values further away are exceptions.
constexpr double GreatestLatticeNumber = 268435456.0; // 2^28

/// Chooses the lattice of a component: y = Origin + k * Step in the transformed domain, with `Bin`
/// lattice steps per residual, so that a value and what it decodes to differ by at most `bound`
/// there. The lattice goes through 0 wherever numbers stay small enough.
///
/// Sets Exact, Origin, Step, Bin, Least and Greatest of the head. Exact is set when the bound is 0
/// or below what the type resolves: every sample is then an exception.
/// @param bound in the transformed domain, >= 0, finite
/// @param expected where the values lie; only efficiency depends on it
/// @param beyond some values may lie outside: the lattice goes on by its own width at either end,
/// so that what is near does not have to be kept exactly
void ChooseLattice(ScalarType type, const Transform& transform, double bound,
  const ValueRange& expected, bool beyond, group::FieldHead& head);

} // namespace banyan

#endif
