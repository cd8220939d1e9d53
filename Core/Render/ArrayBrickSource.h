#ifndef banyan_Render_ArrayBrickSource_h
#define banyan_Render_ArrayBrickSource_h

#include "Render/BrickSource.h"

#include <vector>

namespace banyan
{

class ThreadPool;

/// A plain array of samples in memory, as data sets that never were encoded have it.
struct SampleArray
{
  /// Takes the Euclidean length of all components instead of one of them.
  static constexpr int Magnitude = -1;

  const void* Values = nullptr; ///< component 0 of the sample at Samples.Lo
  ScalarType Type = ScalarType::Float32;
  std::ptrdiff_t Stride[3] = { 1, 0, 0 }; ///< in values, between neighbours along each axis
  int Components = 1;
  std::ptrdiff_t ComponentStride = 1; ///< in values
  int Component = 0;                  ///< in [0, Components), or Magnitude
  /// Positions held, in samples of the whole grid (index space from 0): a piece of the grid, say.
  Box Samples;
  /// One byte per sample, x fastest, or null. Samples with a bit of HiddenBits set count as NaN.
  const std::uint8_t* Flags = nullptr;
  std::uint8_t HiddenBits = 2;       ///< vtkDataSetAttributes::HIDDENPOINT
  std::shared_ptr<const void> Owner; ///< keeps Values and Flags alive; may be empty
};

/// Extremes of the finite values that are not hidden; empty when there is none.
/// Throws Error when the array's description is not usable.
ValueRange FiniteRange(const SampleArray& array, ThreadPool& pool);

/// Draws from a SampleArray. Bricks are aligned to the whole grid's (brick edges lie at multiples
/// of the brick size), so that pieces of one grid have the same bricks inside.
///
/// Values of a single component without hidden samples are used where they are. Otherwise a brick
/// is copied when it is loaded: as float32 for types that float32 holds exactly, else as float64.
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
  MaskRange MasksAreOver() const override { return this->Over; }
  std::optional<UniformValue> UniformValueOf(std::int64_t brick) const override;
  std::size_t LoadBytes(std::int64_t brick) const override;
  BrickView Load(std::int64_t brick) override;
  /// Takes the samples from the array, also those beyond its bricks' own.
  BrickView LoadAround(std::int64_t brick, Box& samples) override;

protected:
  /// Exists when the array is the whole grid.
  std::unique_ptr<BrickSource> MakeLevel(int level, const Box& domain) override;

private:
  /// A coarser level. Ranges and masks are those of everything that lies in a brick.
  ArrayBrickSource(const ArrayBrickSource& finest, int level);

  /// Cuts `Cells` into bricks.
  void CutIntoBricks();
  /// Whether a brick's samples cannot be used where they are.
  bool IsCopied(const Box& samples) const;
  /// @param samples positions in the array, from 0, in samples of the level
  BrickView ViewOf(const Box& samples) const;
  Box SamplesOf(std::int64_t brick) const;
  /// Whether a sample of the finest level is NaN, infinite or hidden.
  bool HasSpecial(const Box& samples) const;

  SampleArray Array;      ///< of the finest level
  int Every = 1;          ///< samples of the array from one of the level to the next
  glm::ivec3 Held{ 0 };   ///< samples of the level per axis
  int BrickCells;
  MaskRange Over;
  Box Cells;
  glm::ivec3 FirstBrick{ 0 }; ///< position of brick 0 among the whole grid's bricks
  glm::ivec3 BrickCounts{ 1 };
  std::vector<ValueRange> Ranges;
  std::vector<ValueMask> Masks;
  std::vector<std::uint8_t> Uniform; ///< whether all samples have the value Range.Low
};

} // namespace banyan

#endif
