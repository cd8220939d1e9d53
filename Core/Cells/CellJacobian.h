// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_CellJacobian_h
#define banyan_Cells_CellJacobian_h

#include "Cells/CellCorners.h"

namespace banyan
{

/// The signs that the determinant of a cell's Jacobian has at its corners: both when it is folded.
/// None when it is zero all over the cell, which has no volume then.
struct JacobianSigns
{
  bool Positive = false;
  bool Negative = false;
};

/// Zero is what rounding of the corners, and of the determinant, in double makes of it. Where it is
/// zero at all corners, as in hexahedra whose opposite faces are collapsed to edges, signs inside
/// count.
/// @param places finite, and at most CellFacts::MostCoordinate
JacobianSigns SignsOfJacobian(CellShape shape, const CellPlaces& places);

} // namespace banyan

#endif
