// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_NodeTable_h
#define banyan_Series_NodeTable_h

#include "Series/BrickCodec.h"
#include "Series/SegmentFormat.h"
#include "Series/SeriesFile.h"

#include <vector>

namespace banyan
{

/// Where a brick's payload lies, and how it is coded.
struct PayloadReference
{
  std::uint64_t Offset = 0; ///< in the segment file; 0 for a macro voxel
  std::uint8_t Mode = 0;
};

/// All bricks of one field (a component of an array at a step and level), as a segment keeps them.
struct NodeTable
{
  std::vector<BrickNode> Nodes;
  std::vector<PayloadReference> Payloads;

  std::uint64_t MemoryBytes() const
  {
    return this->Nodes.size() * sizeof(BrickNode) +
           this->Payloads.size() * sizeof(PayloadReference);
  }
};

/// Reads the compressed bytes of a table, `NodeBytes` times the number of nodes when decompressed,
/// and checks every field. Identities of macro voxels are made anew.
/// @param layout of the level: says how many nodes there must be
/// @param payloadEnd end of the payload section, which payloads must lie in
/// Throws Error when anything does not fit.
NodeTable UnpackNodeTable(const std::uint8_t* stored, const segment::TableEntry& entry,
  const BrickLayout& layout, ScalarType type, std::uint64_t payloadEnd);

/// Translates the masks of a table to another range, conservatively.
void TranslateMasks(NodeTable& table, const MaskRange& from, const MaskRange& to);

/// Identity of a macro voxel.
PayloadIdentity MacroVoxelIdentity(ScalarType type, const glm::ivec3& samples, double value);

} // namespace banyan

#endif
