// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Bricks_Interpolators_h
#define banyan_Render_Bricks_Interpolators_h

#include "Render/Bricks/BrickView.h"
#include "Render/Scene/RayLattice.h"

#include <cmath>
#include <cstring>
#include <limits>
#include <type_traits>

namespace banyan
{

/// Types that float cannot hold exactly are taken relative to the table's low end, in double,
/// before they become float: data with a large offset keep all their digits.
template <class T>
constexpr bool IsRelative = sizeof(T) >= 4 && !std::is_same_v<T, float>;

/// The cell that a fixed-point position lies in.
inline glm::ivec3 CellAt(const std::int64_t (&position)[3])
{
  return { static_cast<int>(position[0] >> FractionBits),
    static_cast<int>(position[1] >> FractionBits), static_cast<int>(position[2] >> FractionBits) };
}

/// Bits of a fixed-point position that an interpolation uses: as many as float holds exactly.
constexpr int UsedBits = 24;
constexpr float UsedUnit = 1.0f / (1 << UsedBits);

/// A corner's value in float.
/// @param low what relative types are relative to
template <class T>
inline float CornerValue(T value, [[maybe_unused]] double low)
{
  if constexpr (!IsRelative<T>)
  {
    return static_cast<float>(value);
  }
  else
  {
    double relative = static_cast<double>(value) - low;
    if constexpr (std::is_same_v<T, double>)
    {
      // Values this far outside a table may as well be here: differences stay finite in float.
      constexpr double farAway = 1e30;
      if (!(std::abs(relative) < farAway))
      {
        relative = std::isfinite(value) ? std::copysign(farAway, relative)
                                        : std::numeric_limits<double>::quiet_NaN();
      }
    }
    return static_cast<float>(relative);
  }
}

/// The plain way, one position after the other, for any type and any strides: eight corners, mixed
/// along z, then y, then x. What it gives is what BlockInterpolator must give, bit for bit.
template <class T>
class PlainInterpolator
{
public:
  /// @param nearest whether values are those of the nearest samples
  PlainInterpolator(const BrickView& view, double low, bool nearest = false)
    : Values(static_cast<const T*>(view.Values))
    , StrideX(view.Stride[0])
    , StrideY(view.Stride[1])
    , StrideZ(view.Stride[2])
    , Low(low)
    , Nearest(nearest)
  {
  }

  /// The value (for relative types: minus `low`) at a fixed-point position relative to the brick's
  /// corner, inside the brick. Not finite when a corner is not finite, or the nearest one.
  float At(const std::int64_t (&position)[3]) const
  {
    if (this->Nearest)
    {
      return this->NearestTo(position);
    }
    const T* cell = this->Values + (position[0] >> FractionBits) * this->StrideX +
                    (position[1] >> FractionBits) * this->StrideY +
                    (position[2] >> FractionBits) * this->StrideZ;
    const float z = Fraction(position[2]);
    const auto edge = [&](std::ptrdiff_t offset)
    {
      return Mix(CornerValue(cell[offset], this->Low),
        CornerValue(cell[offset + this->StrideZ], this->Low), z);
    };
    const float y = Fraction(position[1]);
    const float left = Mix(edge(0), edge(this->StrideY), y);
    const float right = Mix(edge(this->StrideX), edge(this->StrideX + this->StrideY), y);
    return Mix(left, right, Fraction(position[0]));
  }

private:
  /// Half way between two samples it is the upper one.
  float NearestTo(const std::int64_t (&position)[3]) const
  {
    constexpr std::int64_t half = std::int64_t{ 1 } << (FractionBits - 1);
    const T* sample = this->Values + ((position[0] + half) >> FractionBits) * this->StrideX +
                      ((position[1] + half) >> FractionBits) * this->StrideY +
                      ((position[2] + half) >> FractionBits) * this->StrideZ;
    return CornerValue(*sample, this->Low);
  }

  static float Mix(float a, float b, float part) { return a + part * (b - a); }

  static float Fraction(std::int64_t position)
  {
    constexpr std::int64_t mask = (1 << UsedBits) - 1;
    const std::int64_t bits = (position >> (FractionBits - UsedBits)) & mask;
    return static_cast<float>(static_cast<std::int32_t>(bits)) * UsedUnit;
  }

  const T* Values;
  std::ptrdiff_t StrideX;
  std::ptrdiff_t StrideY;
  std::ptrdiff_t StrideZ;
  double Low;
  bool Nearest;
};

} // namespace banyan

#endif
