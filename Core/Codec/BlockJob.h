// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_BlockJob_h
#define banyan_Codec_BlockJob_h

#include "Codec/BlockEncoder.h"

#include <cstdint>
#include <vector>

namespace banyan
{

/// State of a block between its edges, faces and interior.
struct BlockUnderway
{
  std::vector<std::uint8_t> Magnitudes; ///< of its edges, and then of its faces with them
  bool Rough = false;                   ///< some residual is not zero
};

struct PlaneJob
{
  const PlaneToEncode* Plane;
  PlaneNumbers* Decoded;
  std::vector<BlockTokens>* Blocks;
  std::vector<BlockUnderway>* Underway;
};

/// Phases of encoding. Each needs the ones before of all blocks, because units begin at
/// what neighbours own.
enum class BlockPhase
{
  Choose, ///< of a mode
  Edges,
  Faces,
  Interior
};

} // namespace banyan

#endif
