// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_ChainLengths_h
#define banyan_Series_Encode_ChainLengths_h

#include "Series/Encode/FieldGroup.h"

namespace banyan
{

/// How far a look at one brick goes: sets ChainSum, ChainBricks and ChainMost of a field whose
/// blocks and nodes are encoded.
///
/// A brick is decoded from a box: its block and the shared layers of up to seven neighbours, after
/// the boxes of what any of the eight refers to, and after the box around it of the next coarser
/// plane, which has references of its own. All steps of which a box is decoded count, the brick's
/// own among them, starting with nothing in memory. A brick of one value is not decoded, and counts
/// its own step.
/// @param samples of the field, axes as the data has them
void CountChains(EncodedField& field, const glm::ivec3& samples, int brickCells);

} // namespace banyan

#endif
