// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Filters_WriterQuantizer_h
#define banyan_Filters_WriterQuantizer_h

#include "Series/Format/QuantizerOptions.h"

#include <string>
#include <vector>

namespace banyan
{

/// Holds what the writer's properties say about quantizing, as numbers and flat lists.
struct WriterQuantizer
{
  int Transform = 0; ///< as TransformChoice
  double AsinhScale = 0;
  std::vector<double> TransformTable; ///< value, transformed, value, ...
  int RangeMode = 0;                  ///< as RangeRule::Source
  double RangePercentiles[2] = { 0.01, 99.99 };
  double Range[2] = { 0, 1 };
  bool ClampOutside = false;
  std::vector<double> FillValues;
  std::vector<double> OpacityFunction; ///< value, opacity, value, ...

  /// Throws Error, with a sentence that names the property.
  QuantizerOptions Options() const;

  /// One line per property that is not as by default.
  std::string Text() const;
};

} // namespace banyan

#endif
