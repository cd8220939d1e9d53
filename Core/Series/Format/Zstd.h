// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_Zstd_h
#define banyan_Series_Format_Zstd_h

#include "Base/Bytes.h"

namespace banyan
{

/// Appends one zstd frame (without content size and checksum: the format keeps both elsewhere).
/// Gives the same bytes on every thread. Throws Error when zstd fails (out of memory).
/// @param level 1 to 19
void AppendCompressed(const std::uint8_t* data, std::size_t bytes, int level, Bytes& out);

/// Decompresses one frame that must give exactly `expected` bytes. Throws Error otherwise; takes no
/// memory in proportion to what the frame claims.
void Decompress(
  const std::uint8_t* frame, std::size_t bytes, std::uint8_t* out, std::size_t expected);

} // namespace banyan

#endif
