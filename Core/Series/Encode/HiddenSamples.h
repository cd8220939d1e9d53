// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Series_Encode_HiddenSamples_h
#define banyan_Series_Encode_HiddenSamples_h

#include "Series/Encode/FieldGroup.h"
#include "Series/Grid/PlaneRegion.h"

#include <array>
#include <cstddef>
#include <vector>

namespace banyan
{

/// Numbers of the hidden samples of a region, x fastest, in order.
/// @param axes the codec's order, in which the region is
std::vector<std::size_t> HiddenIn(const FieldGroup& field, const std::array<std::uint8_t, 3>& axes,
  std::size_t step, const PlaneRegion& region);

/// Whether the same samples of a region are hidden as in the step before.
bool SameHidden(const FieldGroup& field, const std::array<std::uint8_t, 3>& axes, std::size_t step,
  const PlaneRegion& region);

/// Replaces hidden values by the first that is not hidden, so that they change no range; if all
/// are, by 0.
/// @param hidden as HiddenIn gives them
template <class T>
void LeaveOut(const std::vector<std::size_t>& hidden, std::vector<T>& values)
{
  std::size_t seen = 0;
  while (seen < hidden.size() && hidden[seen] == seen)
  {
    ++seen;
  }
  const T value = seen < values.size() ? values[seen] : T{};
  for (const std::size_t number : hidden)
  {
    values[number] = value;
  }
}

} // namespace banyan

#endif
