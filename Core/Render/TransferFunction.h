#ifndef banyan_Render_TransferFunction_h
#define banyan_Render_TransferFunction_h

#include "Series/ValueMask.h"

#include <glm/vec4.hpp>

#include <vector>

namespace banyan
{

/// A transfer function as a table of colour (not premultiplied) and opacity per unit distance,
/// equally spaced over [Low, High]; values outside take the first or last entry. Look-ups take the
/// nearest entry: make the table fine (4096 is the default everywhere).
struct TransferFunction
{
  double Low = 0.0;
  double High = 1.0;
  std::vector<glm::vec4> Entries; ///< at least 2: r, g, b, opacity in [0, 1] over UnitDistance
  double UnitDistance = 1.0;      ///< world length over which an entry's opacity applies; > 0

  /// Values of the series range's bins that may be visible (opacity > 0 somewhere in the bin).
  ValueMask VisibleBins(const MaskRange& range) const;

  /// Whether some value in [low, high] has an opacity above 0.
  bool AnyVisible(double low, double high) const;
};

/// The table of a transfer function for one sample distance: premultiplied colour and opacity,
/// opacity = 1 - (1 - a)^(distance / UnitDistance).
class StepTable
{
public:
  StepTable(const TransferFunction& function, double sampleDistance);

  /// Entry of a value: nearest; NaN gives a fully transparent entry.
  const glm::vec4& At(float value) const
  {
    // The comparison is false for NaN, which then takes the extra transparent entry at the end.
    const float position = (value - this->Low) * this->Scale + 0.5f;
    if (!(position >= 0.0f))
    {
      return value == value ? this->Entries.front() : this->Entries.back();
    }
    return position >= this->Count ? this->Entries[this->LastIndex]
                                   : this->Entries[static_cast<int>(position)];
  }

private:
  std::vector<glm::vec4> Entries; ///< one more than the function's: the transparent one
  float Low = 0;
  float Scale = 0;
  float Count = 0;
  int LastIndex = 0;
};

} // namespace banyan

#endif
