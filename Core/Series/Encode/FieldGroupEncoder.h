// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_FieldGroupEncoder_h
#define banyan_Series_Encode_FieldGroupEncoder_h

#include "Series/Encode/FieldGroup.h"

#include <functional>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Encodes a group. The result does not depend on the number of threads.
/// @param sumSquares if not null, one array of all voxels per step, to which the squares of the
/// decoded values are added (for magnitudes of vectors; NaN or infinite where a component is)
/// @param tell called often with the number of steps done; may throw
EncodedField EncodeFieldGroup(const FieldGroup& field, ThreadPool& pool,
  std::vector<std::vector<double>>* sumSquares, const std::function<void(double)>& tell);

/// A field of one step becomes one that rests over as many: nothing of it needs to be stored, and
/// what was measured counts as often.
void MarkStatic(EncodedField& field, std::int64_t steps);

/// The key frame of a group, as EncodeFieldGroup encodes it, from its values alone.
/// @param field of which the last step counts
KeyFrame EncodeKeyFrame(const FieldGroup& field, ThreadPool& pool);

} // namespace banyan

#endif
