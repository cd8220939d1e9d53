// SPDX-License-Identifier: BSD-3-Clause
#include "Series/Format/QuantizerOptions.h"

#include "Base/Error.h"
#include "Series/Format/SeriesIndex.h"

#include <cmath>

namespace banyan
{
namespace
{

Transform MakeTransform(
  const QuantizerOptions& options, const ValueHistogram* values, const ValueRange& range)
{
  switch (options.Map)
  {
    case TransformChoice::Asinh:
      return Transform::Asinh(
        options.AsinhScale > 0 ? options.AsinhScale : AsinhScale(*values, range, options.Scaling));
    case TransformChoice::Table:
      return Transform::Table(options.Knots);
    case TransformChoice::Adaptive:
      return range.Empty() ? Transform{} : MakeAdaptive(*values, range, options.Adaptive);
    default:
      return {};
  }
}

} // namespace

bool QuantizerOptions::NeedsHistogram(bool relative) const
{
  const bool map = this->Map == TransformChoice::Adaptive ||
                   (this->Map == TransformChoice::Asinh && this->AsinhScale == 0);
  const bool clamps = this->Range.ClampOutside && this->Range.From != RangeRule::Source::Given;
  const bool range =
    this->Range.From == RangeRule::Source::Percentiles ||
    (this->Range.From == RangeRule::Source::Data && relative && !this->FillValues.empty());
  return map || range || clamps;
}

void QuantizerOptions::Check() const
{
  this->Range.Check();
  if (this->Map == TransformChoice::Asinh && !(this->AsinhScale == 0))
  {
    (void)Transform::Asinh(this->AsinhScale);
  }
  if (this->Map == TransformChoice::Table)
  {
    (void)Transform::Table(this->Knots);
  }
  for (const double value : this->FillValues)
  {
    if (!std::isfinite(value))
    {
      throw Error("A fill value must be a finite number: NaN and infinities are always kept");
    }
  }
  if (!this->Opacity.empty())
  {
    (void)OpacityFunction(this->Opacity);
  }
}

void ApplyQuantizer(const QuantizerOptions& options, const ValueHistogram* values,
  const ValueRange& told, bool relative, ComponentIndex& component)
{
  options.Check();
  if (values == nullptr && options.NeedsHistogram(relative))
  {
    throw Error(
      "This transform or range needs a histogram of the whole series: read all steps once "
      "before, or state a scale or range");
  }
  const bool given = options.Range.From == RangeRule::Source::Given;
  component.PromisedRange =
    given ? options.Range.Given : (values ? ChooseRange(options.Range, *values) : told);
  component.RangeFrom = options.Range.From;
  component.ClampOutside = options.Range.ClampOutside;
  component.FillValues = options.FillValues;
  component.Opacity = options.Opacity;
  component.ValueTransform = MakeTransform(options, values, component.PromisedRange);
}

} // namespace banyan
