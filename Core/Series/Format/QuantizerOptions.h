// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Format_QuantizerOptions_h
#define banyan_Series_Format_QuantizerOptions_h

#include "Series/Quantize/AdaptiveTransform.h"
#include "Series/Quantize/OpacityWeight.h"
#include "Series/Quantize/RangeRule.h"
#include "Series/Quantize/Transform.h"

#include <vector>

namespace banyan
{

struct ComponentIndex;

/// Where the transform of a component comes from. Documentation/howto/choose-a-quantizer.md says
/// what each is good for.
enum class TransformChoice
{
  Uniform, ///< none: the bound holds in the units of the data
  Asinh,   ///< Transform::Asinh: for data over decades, of either sign
  Table,   ///< the user's knots
  Adaptive ///< a table from the histogram of the whole series (MakeAdaptive)
};

/// How the values of an array are quantized; each component by itself.
struct QuantizerOptions
{
  TransformChoice Map = TransformChoice::Uniform;
  double AsinhScale = 0;            ///< of Asinh; 0 chooses one from the histogram
  std::vector<TransformKnot> Knots; ///< of Table
  AdaptiveRule Adaptive;            ///< of Adaptive
  AsinhRule Scaling;                ///< of Asinh with scale 0
  /// A relative bound is relative to this range, and Adaptive is made over it.
  RangeRule Range;
  /// Finite values that mean "no value": bit-exact, and never part of a range.
  std::vector<double> FillValues;
  /// Opacity over values, for pictures: where it is 0 over a block and its neighbours, values may
  /// become any other of the same interval of invisible ones, and cost nothing. Empty: all count.
  std::vector<OpacityKnot> Opacity;

  /// Whether a plan needs the histogram of all values of the series.
  /// @param relative whether the error bound is one relative to the range
  bool NeedsHistogram(bool relative) const;

  /// Throws Error for numbers that are out of range.
  void Check() const;
};

/// Sets the transform and the range of a component, and what encoding and judging need to know.
/// @param values all finite values of the component but fill values; null when there is none
/// @param told the range that was told instead; may be empty
/// @param relative as above
/// Throws Error when a histogram is missing or an option is out of range.
void ApplyQuantizer(const QuantizerOptions& options, const ValueHistogram* values,
  const ValueRange& told, bool relative, ComponentIndex& component);

} // namespace banyan

#endif
