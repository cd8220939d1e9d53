// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_ArraySamples_h
#define banyan_Render_Bricks_ArraySamples_h

#include "Base/Box.h"
#include "Render/Bricks/BrickView.h"
#include "Series/Grid/ValueMask.h"
#include "Series/Quantize/ValueRange.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A plain array of samples in memory, as data sets that never were encoded have it.
struct SampleArray
{
  /// Takes the Euclidean length of all components instead of one of them.
  static constexpr int Magnitude = -1;
  /// Takes three or four components as a colour: what the opacity function is asked for, and
  /// ColourNumber in views. One component has such numbers already.
  static constexpr int Colours = -2;

  const void* Values = nullptr; ///< component 0 of the sample at Samples.Lo
  ScalarType Type = ScalarType::Float32;
  std::ptrdiff_t Stride[3] = { 1, 0, 0 }; ///< in values, between neighbours along each axis
  int Components = 1;
  std::ptrdiff_t ComponentStride = 1; ///< in values
  int Component = 0;                  ///< in [0, Components), Magnitude or Colours
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

/// What is known of a box of samples without looking at them again.
struct BoxSummary
{
  ValueRange Range;     ///< of the finite values
  ValueMask Mask = 0;   ///< bins that a cell's values may lie in
  bool Uniform = false; ///< whether all samples have the value Range.Low
};

/// Boxes of the samples of a SampleArray, as they are drawn.
///
/// Values of a single component without hidden samples are used where they are. Otherwise a box is
/// copied when it is viewed: as float32 for types that float32 holds exactly, else as float64.
/// Colours are always copied, as float64.
class ArraySamples
{
public:
  /// Throws Error when the array's description is not usable.
  explicit ArraySamples(const SampleArray& array);

  const SampleArray& Array() const { return this->Source; }

  /// Lets go of the values: no view may be made any more.
  void LetGo()
  {
    this->Source.Values = nullptr;
    this->Source.Flags = nullptr;
    this->Source.Owner.reset();
  }

  /// Whether no view points at the array's own values.
  bool AlwaysCopied() const { return this->Source.Component < 0 || this->Source.Flags != nullptr; }
  bool HasColours() const { return this->Source.Component == SampleArray::Colours; }
  /// That views have.
  ScalarType ViewType() const;

  // Positions are counted in the array, from 0, in samples of a level: along each axis
  // every `every`-th of the array. Where the last cell of a level is not whole, the sample after
  // the last repeats that.

  /// Memory that a view takes beside the array.
  std::size_t ViewBytes(const Box& samples, const glm::ivec3& every = glm::ivec3(1)) const;
  BrickView View(const Box& samples, const glm::ivec3& every = glm::ivec3(1)) const;

  /// @param boxes of samples, not empty
  /// @param over range of the 64 bins of the masks
  std::vector<BoxSummary> Summarize(
    const std::vector<Box>& boxes, const MaskRange& over, ThreadPool& pool) const;

private:
  bool IsCopied(const Box& samples, const glm::ivec3& every) const;
  bool HasSpecial(const Box& samples) const;

  SampleArray Source;
};

} // namespace banyan

#endif
