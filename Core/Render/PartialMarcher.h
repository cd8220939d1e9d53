#ifndef banyan_Render_PartialMarcher_h
#define banyan_Render_PartialMarcher_h

#include "Render/Interpolators.h"
#include "Render/TransferFunction.h"

#include <glm/vec4.hpp>

namespace banyan
{

/// Blends single samples, one after the other: the heads and tails of rays.
template <class T>
class PartialMarcher
{
public:
  /// @param relative whether values become relative to the table's low end, or are already
  PartialMarcher(
    const BrickView& view, const glm::ivec3& corner, const StepTable& table, bool relative)
    : Table(table)
    , Lookup(relative ? table.RelativeLookup() : table.Lookup())
    , Values(view, table.Low())
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Corner[axis] = ToFixed(corner[axis]);
    }
  }

  /// @param pixel premultiplied colour and transmittance
  void March(const PartialSample& sample, glm::vec4& pixel) const
  {
    std::int64_t position[3] = { sample.Position[0], sample.Position[1], sample.Position[2] };
    this->MoveToBrick(position);
    const int index = this->Lookup.IndexOf(this->Values.At(position));
    const glm::vec4 entry = this->Table.Partial(index, sample.Fraction);
    pixel.r += pixel.a * entry.r;
    pixel.g += pixel.a * entry.g;
    pixel.b += pixel.a * entry.b;
    pixel.a *= 1.0f - entry.a;
  }

protected:
  void MoveToBrick(std::int64_t (&position)[3]) const
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      position[axis] -= this->Corner[axis];
    }
  }

  std::int64_t Corner[3]; ///< fixed-point position of the brick's first sample
  const StepTable& Table;
  TableLookup Lookup;
  PlainInterpolator<T> Values;
};

} // namespace banyan

#endif
