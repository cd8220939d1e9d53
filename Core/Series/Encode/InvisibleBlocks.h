// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_InvisibleBlocks_h
#define banyan_Series_Encode_InvisibleBlocks_h

#include "Series/Decode/LatticeDecoder.h"
#include "Series/Encode/FieldGroup.h"
#include "Series/Quantize/FillValues.h"

#include <vector>

namespace banyan
{

/// Which blocks of a field nobody can see, and what they may decode to instead.
///
/// A block is invisible when all its samples, and those around it (one more at either side along
/// each axis), lie in one interval of values whose opacity is 0. Cells that touch a sample of such
/// a block then have all corners in that interval, so that no interpolant of the finest level
/// becomes visible, or stops being so, whatever other values of the interval the block gets.
/// Samples with NaN, infinities or fill values are not invisible.
template <class T>
class InvisibleBlocks
{
public:
  /// Chooses one number per interval, the same for all blocks and steps of the group, so that they
  /// cost nothing: that of the median of the values in the interval, at least the bound away from
  /// its ends. Intervals too narrow for that are left alone. Looks at a part of the key frame only:
  /// what a key frame decodes to must not depend on other steps.
  InvisibleBlocks(const FieldGroup& field, const group::FieldHead& head,
    const LatticeDecoder<T>& decoder, const glm::ivec3& samples, const glm::i64vec3& stride);

  /// False: there is nothing to replace.
  bool Any() const { return !this->Intervals.Intervals().empty() && this->Usable; }

  /// Number of the interval that a block of the finest plane may be replaced in, or -1.
  /// @param position of the block, in blocks
  int IntervalOf(const T* values, const glm::ivec3& position) const;

  /// Returns the number that blocks of an interval become.
  std::int32_t NumberOf(int interval) const
  {
    return this->Choices[static_cast<std::size_t>(interval)].Number;
  }

  /// Whether an interval holds a value.
  bool Holds(int interval, T value) const
  {
    return this->Intervals.IntervalOf(static_cast<double>(value)) == interval;
  }

private:
  struct Choice
  {
    bool Usable = false;
    std::int32_t Number = 0;
  };
  Choice Choose(const ValueRange& interval, std::vector<double>& values,
    const LatticeDecoder<T>& decoder) const;
  void CollectInto(std::vector<std::vector<double>>& values) const;

  const FieldGroup& Field;
  const group::FieldHead& Head;
  FillSet<T> Fills;
  glm::ivec3 Samples;
  glm::i64vec3 Stride;
  InvisibleIntervals Intervals;
  std::vector<Choice> Choices;
  bool Usable = false;
};

} // namespace banyan

#endif
