// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_HexBrickSummary_h
#define banyan_Mesh_Octree_HexBrickSummary_h

#include "Base/Hash.h"
#include "Base/HeldArray.h"
#include "Mesh/Octree/HexBricks.h"
#include "Mesh/Octree/NodalField.h"
#include "Series/Grid/ValueMask.h"
#include "Series/Quantize/ValueRange.h"

#include <cstddef>
#include <cstdint>
#include <memory>

namespace banyan
{

class ThreadPool;

/// Says which values each brick of a mesh has. It is found by one look at all elements.
struct HexBrickSummary
{
  HeldArray<Hash128> Contents; ///< of elements and their values: BrickSource::ContentOf
  HeldArray<ValueRange> Ranges;
  HeldArray<ValueMask> Masks;
  HeldArray<std::uint8_t> Special; ///< whether a corner of an element is not finite
  MaskRange Over;                  ///< what masks are over: the finite values of all bricks

  std::size_t Bytes() const
  {
    return this->Contents.Bytes() + this->Ranges.Bytes() + this->Masks.Bytes() +
           this->Special.Bytes();
  }

  static HexBrickSummary Of(const HexBricks& bricks, const NodalField& values, ThreadPool& pool);

  /// The summary can be written as one run of bytes, which other processes of the machine can use
  /// as theirs.
  static std::size_t PackedBytes(std::size_t bricks);
  void WriteTo(char* to) const;
  /// Returns the summary that lies in the memory; nothing is copied.
  static HexBrickSummary Read(std::size_t bricks, const std::shared_ptr<const char>& memory);
};

} // namespace banyan

#endif
