// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_MadeUpBricks_h
#define banyan_Benchmarks_MadeUpBricks_h

#include "Render/Bricks/BrickSource.h"
#include "Series/Decode/SeriesFile.h"
#include "Series/Grid/Grid.h"

#include <vector>

namespace banyan::bench
{

/// Bricks with ranges and masks, as an encoded series of floats has them in memory, and without
/// values: large volumes can be planned, and not drawn. Values lie in [0, 1], half of the bricks
/// have some above 1/2.
class MadeUpBricks : public BrickSource
{
public:
  /// What the values look like.
  enum class Kind
  {
    Smooth,   ///< a surface with four waves along each axis, and one side of it
    Scattered ///< each brick by itself, by chance: the worst case for anything that goes by boxes
  };

  /// @param samples of the finest level
  MadeUpBricks(const glm::ivec3& samples, int brickCells, Kind kind, int level = 0);

  glm::ivec3 Bricks() const override { return this->Layout.Bricks(); }
  Box CellsOf(std::int64_t brick) const override { return this->Layout.CellsOf(brick); }
  ValueRange RangeOf(std::int64_t brick) const override { return this->NodeOf(brick).Range; }
  ValueMask MaskOf(std::int64_t brick) const override { return this->NodeOf(brick).Mask; }
  MaskRange MasksAreOver() const override { return { 0.0, 1.0 }; }
  std::size_t LoadBytes(std::int64_t brick) const override;
  /// Throws Error.
  BrickView Load(std::int64_t brick) override;

protected:
  std::unique_ptr<BrickSource> MakeLevel(int level, const Box& domain) override;

private:
  const BrickNode& NodeOf(std::int64_t brick) const
  {
    return this->Nodes[static_cast<std::size_t>(brick)];
  }
  ValueRange MakeRange(std::int64_t brick) const;

  glm::ivec3 FineSamples;
  BrickLayout Layout;
  Kind Values;
  std::vector<BrickNode> Nodes;
};

} // namespace banyan::bench

#endif
