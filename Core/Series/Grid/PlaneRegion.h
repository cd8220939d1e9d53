// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Grid_PlaneRegion_h
#define banyan_Series_Grid_PlaneRegion_h

#include "Codec/BlockEncoder.h"
#include "Series/Grid/Grid.h"
#include "Series/Grid/NumberBox.h"

#include <algorithm>
#include <array>
#include <vector>

namespace banyan
{

/// Samples of a brick as the planes of the codec hold them: every `Stride`-th of a plane, axes in
/// the codec's order.
struct PlaneRegion
{
  int Plane = 0;
  int Stride = 1;
  glm::ivec3 Low{ 0 };   ///< in samples of the plane
  glm::ivec3 Count{ 1 }; ///< samples taken
  glm::ivec3 Last{ 0 };  ///< the plane's last sample, which stands for what would lie beyond it
  /// The blocks that hold them, half-open.
  glm::ivec3 FirstBlock{ 0 }, EndBlock{ 1 };

  /// @param box samples of a brick of a level, as BrickLayout has them, axes as the data has them
  /// @param samples of the plane, axes in the codec's order
  PlaneRegion(int level, const Box& box, const std::array<std::uint8_t, 3>& axes,
    const glm::ivec3& samples, int edge);

  /// Makes the region of a level that a block and the layer behind it hold.
  /// @param block its position, in the codec's order as all else
  PlaneRegion(int level, const glm::ivec3& block, const glm::ivec3& samples, int edge);

  /// Sample of the plane that is taken at a place of the region, along an axis.
  int SampleAt(int axis, int place) const
  {
    return std::min(this->Low[axis] + place * this->Stride, this->Last[axis]);
  }
};

NumberExtremes ExtremesOfRegion(const PlaneNumbers& plane, const PlaneRegion& region);

/// Whether all samples of a region are those of another step.
/// @param next the plane whose region is looked at after this one, or null
bool SameInRegion(const PlaneNumbers& plane, const PlaneNumbers& before, const PlaneNumbers* next,
  const PlaneRegion& region);

/// Extremes of a block and the layer behind it, by level: of all its samples, and of every second
/// one.
struct BlockExtremes
{
  NumberExtremes OfLevel[2];
};

/// @param levels how many there are, of all planes: others are not looked at
BlockExtremes ExtremesOfBlock(
  const PlaneNumbers& numbers, int plane, std::int64_t block, int levels);

/// Returns what ExtremesOfRegion gives for a brick's region, made of the extremes of the plane's
/// blocks.
NumberExtremes ExtremesOfBlocks(
  const std::vector<BlockExtremes>& blocks, const PlaneNumbers& plane, const PlaneRegion& region);

} // namespace banyan

#endif
