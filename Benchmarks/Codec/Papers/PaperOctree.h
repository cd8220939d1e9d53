// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_PaperOctree_h
#define banyan_Benchmarks_PaperOctree_h

#include "Base/Bytes.h"
#include "Series/Decode/BrickTree.h"

#include <glm/vec3.hpp>

#include <cstdint>

namespace banyan
{

/// The study's own encoding, to compare with: quantized codes of one step in an octree whose leaves
/// are single voxels, fused bottom-up, and merged with the octree of the step before.
///
/// @par Source: "A study of time-varying octree and difference encoding", sections 3.2 and 3.3,
/// table 2 and figure 9. Branch on need, as in BrickTree: a node of level l stands over the voxels
/// p * 2^l to (p + 1) * 2^l, cut where the volume ends; nothing is padded, and the highest level is
/// the root alone. Level 0 are the voxels; the root is of level 1 or higher.
///
/// The paper does not say how a tree becomes bits. Here it is a linear octree, depth first,
/// children with x fastest, the bits of each byte from the lowest on, and whatever the grid tells
/// is not said again. With n bits per code:
///
/// | node | without a step before | with one |
/// |---|---|---|
/// | level >= 2 | `0` children, `1` macro voxel | `0` children, `10` as before, `11` macro voxel |
/// | level 1 | `0` voxels, `1` macro voxel | `00` voxels, `10` some voxels, `01` as before, `11`
/// macro voxel |
/// | level 0 | code | code |
///
/// (digits in the order of the stream). A macro voxel is followed by its code. "As before" is the
/// paper's pointer to the step before: the same place in the tree that was decoded last, so that a
/// pointer takes no bits. "Some voxels" is followed by one bit per voxel (1: as before) and the
/// codes of the others. Zero bits fill the last byte. Grid, number of bits and whether there is a
/// step before belong into an index, once per series.
struct PaperOctreeCounts
{
  /// The greatest fused nodes by size (element l: level l) of this step's octree by itself; element
  /// 0 are the voxels that did not fuse.
  CountsBySize MacroVoxels;
  /// The greatest subtrees that are equal to those of the step before, by size; element 0 are
  /// single voxels. All zero without a step before.
  CountsBySize MergedSubtrees;
  std::uint64_t CodeBits = 0; ///< of voxels and macro voxels that were not merged
  std::uint64_t TagBits = 0;  ///< all else: tags and masks

  std::uint64_t Bits() const { return this->CodeBits + this->TagBits; }
};

/// One step, encoded.
struct PaperOctreeStep
{
  Bytes Stream; ///< (Counts.Bits() + 7) / 8 bytes
  PaperOctreeCounts Counts;
};

/// @param codes `[z][y][x]`, x fastest, each below 2^bits
/// @param previous codes of the step before, or nullptr for the first one
/// @param samples voxels per axis, each >= 1
/// @param bits per code, 1 to 16
/// Throws Error when an argument is out of its range (a code, too).
PaperOctreeStep EncodePaperOctree(
  const std::uint16_t* codes, const std::uint16_t* previous, const glm::ivec3& samples, int bits);

/// Inverse of `EncodePaperOctree`, bit-exact, with the same arguments.
/// @param codes receives the step; may be `previous` itself, which then plays on in place and costs
/// nothing where subtrees are merged
/// Throws Error when the stream ends early or late. Any stream is safe.
void DecodePaperOctree(const Bytes& stream, const std::uint16_t* previous,
  const glm::ivec3& samples, int bits, std::uint16_t* codes);

/// What table 2 states, as a share: 1 - encoded / original; negative when encoding made it larger.
/// @param voxels greater than 0
/// @param bitsPerVoxel of what to compare with: 8 for the paper's quantized, 32 for its raw data
double SavedShare(std::uint64_t encodedBits, std::int64_t voxels, int bitsPerVoxel);

} // namespace banyan

#endif
