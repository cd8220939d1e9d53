// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_PackedDepths_h
#define banyan_Parallel_Composite_PackedDepths_h

#include "Base/Bytes.h"
#include "Render/Scene/DepthPicture.h"

namespace banyan
{

/// Few bytes of a picture of depths, for a slow line: 24 bits each, which are all that most depth
/// buffers have, as differences to a plane through three neighbours, and zstd. Surfaces are nearly
/// planes.
Bytes PackDepths(const DepthPicture& picture);

/// The inverse, within 2^-25. Throws Error when the bytes are not those of such a picture.
DepthPicture UnpackDepths(const Bytes& packed);

} // namespace banyan

#endif
