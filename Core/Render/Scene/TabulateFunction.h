// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_TabulateFunction_h
#define banyan_Render_Scene_TabulateFunction_h

#include "Render/Scene/TransferFunction.h"

#include <functional>

namespace banyan
{

/// Colour (not premultiplied) and opacity of a value.
using FunctionOfValue = std::function<glm::dvec4(double)>;

/// How far an entry of TabulateFunction's may be from the function, at any value of the entry.
struct TabulationError
{
  /// Largest error of each channel of a colour.
  static constexpr double Colour = 2.0 / 255.0;
  /// Largest error of opacities: a part of the opacity itself, and of the function's highest one.
  static constexpr double OpacityOfItself = 1.0 / 64.0;
  static constexpr double OpacityOfHighest = 1.0 / 256.0;
};

/// Makes a table of a function that is within TabulationError of it everywhere, but for values that
/// are closer than rounding in float to where it jumps.
///
/// Most functions get equally spaced entries: `entries` of them, or four times as many. A function
/// that jumps, or changes within less than these can tell, gets entries with edges: as many as it
/// takes, and its jumps are exact.
/// @param function evaluated in double, up to some 100,000 times; constant beyond the corners
/// @param corners where the function may jump, bend or have a value of its own, in any order; what
/// is not finite is left out. It may jump elsewhere too, but what begins and ends within an eighth
/// of the way from one corner to the next may be missed
/// @param equalParts of the range, in each of which colours are the same: small steps from one part
/// to the next then fall between equally spaced entries. 0 if there are none The unit distance is
/// left at 1. Throws Error when the function gives what is not a number.
TransferFunction TabulateFunction(const FunctionOfValue& function, std::vector<double> corners,
  int equalParts = 0, int entries = 4096);

} // namespace banyan

#endif
