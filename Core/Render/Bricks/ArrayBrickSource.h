// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_ArrayBrickSource_h
#define banyan_Render_Bricks_ArrayBrickSource_h

#include "Render/Bricks/ArraySamples.h"
#include "Render/Bricks/BrickSource.h"

#include <memory>
#include <optional>
#include <vector>

namespace banyan
{

/// Draws from a SampleArray; see ArraySamples for what is copied when a brick is loaded. Bricks are
/// aligned to the whole grid's (brick edges lie at multiples of the brick size), so that pieces of
/// one grid have the same bricks inside.
class ArrayBrickSource : public BrickSource
{
public:
  /// Reads all values once to make ranges and masks.
  /// @param brickCells at least 1
  /// @param masks range of the 64 bins of the masks; the finite range of the array is a good one
  /// Throws Error when the array's description is not usable.
  ArrayBrickSource(
    const SampleArray& array, int brickCells, const MaskRange& masks, ThreadPool& pool);

  glm::ivec3 Bricks() const override { return this->BrickCounts; }
  Box CellsOf(std::int64_t brick) const override;
  ValueRange RangeOf(std::int64_t brick) const override { return this->Ranges[brick]; }
  ValueMask MaskOf(std::int64_t brick) const override { return this->Masks[brick]; }
  bool HasColours() const override { return this->Values->HasColours(); }
  MaskRange MasksAreOver() const override { return this->Over; }
  std::optional<UniformValue> UniformValueOf(std::int64_t brick) const override;
  /// Known of bricks that were looked at.
  std::optional<Hash128> ContentOf(std::int64_t brick) const override;
  /// Reads their samples, in parallel.
  void LookAt(const std::vector<std::int64_t>& bricks) override;
  std::size_t LoadBytes(std::int64_t brick) const override;
  BrickView Load(std::int64_t brick) override;
  /// Takes the samples from the array, also those beyond its bricks' own.
  BrickView LoadAround(std::int64_t brick, Box& samples) override;
  BrickView LoadTogether(const Box& bricks, bool around, Box& samples) override;
  /// LevelEdges::Following.
  glm::ivec3 CellEdges() const override { return this->Every; }

  /// Lets go of the array, for a source that takes its place: nothing can be loaded any more, at no
  /// level. What is known of bricks stays.
  void LetGoOfValues() { this->Values->LetGo(); }

protected:
  /// Exists when the array is the whole grid.
  std::unique_ptr<BrickSource> MakeLevel(int level, const Box& domain) override;

private:
  /// A coarser level. Ranges and masks are those of everything that lies in a brick.
  /// @param edges of its cells
  ArrayBrickSource(const ArrayBrickSource& finest, const glm::ivec3& edges);

  /// Cuts `Cells` into bricks.
  void CutIntoBricks();
  Box SamplesOf(std::int64_t brick) const;
  BrickView ViewOf(const Box& wanted, Box& samples) const;

  std::shared_ptr<ArraySamples> Values; ///< of the finest level; all levels have them together
  glm::ivec3 Every{ 1 };                ///< samples of the array from one of the level to the next
  glm::ivec3 Held{ 0 };                 ///< samples of the level per axis
  int BrickCells;
  MaskRange Over;
  Box Cells;
  glm::ivec3 FirstBrick{ 0 }; ///< position of brick 0 among the whole grid's bricks
  glm::ivec3 BrickCounts{ 1 };
  std::vector<ValueRange> Ranges;
  std::vector<ValueMask> Masks;
  std::vector<std::uint8_t> Uniform;            ///< whether all samples have the value Range.Low
  std::vector<std::optional<Hash128>> Contents; ///< of bricks that were looked at; may be empty
};

} // namespace banyan

#endif
