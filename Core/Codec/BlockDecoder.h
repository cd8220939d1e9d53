// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Codec_BlockDecoder_h
#define banyan_Codec_BlockDecoder_h

#include "Codec/DecodeTables.h"
#include "Codec/LinePrefetcher.h"

#include <glm/vec3.hpp>

#include <cstddef>
#include <cstdint>

namespace banyan
{

/// A block as the file holds it.
struct BlockCode
{
  bool Exists = false;  ///< not beyond the field's end; there, the rest has its defaults
  bool Uniform = false; ///< all its samples are `Value`
  bool Same = false;    ///< all its samples are those of reference A
  std::int32_t Value = 0;
  std::uint8_t Mode = 0; ///< see BlockModes.h
  const std::uint8_t* Data = nullptr;
  std::size_t Bytes = 0; ///< 0: all residuals are zero
  /// The field's last sample, seen from the block's first one: beyond, there are no residuals.
  glm::ivec3 Limit{ -1 };
};

/// Properties that all blocks of one plane of a field share.
struct PlaneCode
{
  const DecodeTables* Tables = nullptr;
  std::int32_t CoarseBin = 1; ///< lattice steps per residual at stride 2
  std::int32_t FineBin = 1;   ///< at stride 1
  std::int32_t Least = 0;     ///< decoded lattice numbers are kept in [Least, Greatest]
  std::int32_t Greatest = 0;
};

/// All that is needed to decode the samples of a block and of the faces that it shares.
/// @param Number std::int16_t where block::Narrow says so, else std::int32_t
template <class Number>
struct BoxCodeOf
{
  /// The block and its neighbours: bits 0, 1, 2 of the index are offsets of one block in x, y, z.
  BlockCode Blocks[8];
  /// Samples at stride 4: `[z][y][x]` of (edge / 4 + 1) per axis; from the coarser plane.
  const Number* Coarse = nullptr;
  /// Decoded boxes of the references; must be given when a mode asks for them.
  const Number* A = nullptr;
  const Number* B = nullptr;
  /// Decoded boxes of the neighbours that exist along x, y, z and were decoded before; null for
  /// others. Faces that are here are not decoded again.
  const Number* Neighbours[3] = {};
  /// Loads memory into caches meanwhile; or null.
  LinePrefetcher* Prefetcher = nullptr;

  void Prefetch(int lines) const
  {
    if (this->Prefetcher != nullptr)
    {
      this->Prefetcher->Ask(lines);
    }
  }
};
using BoxCode = BoxCodeOf<std::int32_t>;

/// Decodes a box: the (edge + 1)^3 samples of a block and the layer that neighbours own.
/// @param edge 16 or 32
/// @param box receives lattice numbers `[z][y][x]`
/// Throws Error when a payload is damaged; any input is safe. Integer arithmetic: bit-exact on
/// every machine.
void DecodeBox(
  int edge, const PlaneCode& plane, const BoxCodeOf<std::int16_t>& code, std::int16_t* box);
void DecodeBox(
  int edge, const PlaneCode& plane, const BoxCodeOf<std::int32_t>& code, std::int32_t* box);

} // namespace banyan

#endif
