// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_PackedPicture_h
#define banyan_Parallel_Composite_PackedPicture_h

#include "Base/Bytes.h"
#include "Render/Scene/BytePicture.h"

namespace banyan
{

/// Lossless bytes of a picture, for a slow line: PackPixels, and zstd.
Bytes PackPicture(const BytePicture& picture);

/// The inverse. Throws Error when the bytes are not those of a picture.
BytePicture UnpackPicture(const Bytes& packed);

} // namespace banyan

#endif
