// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_TakenComponent_h
#define banyan_Mesh_Octree_TakenComponent_h

#include "Base/Error.h"
#include "Mesh/Octree/NodalField.h"

#include <cmath>
#include <string>

namespace banyan
{

/// Throws Error when an array has not the component that is to be taken, or no values.
inline void RequireComponent(const NodeArray& array)
{
  const bool exists = array.Component == NodeArray::Magnitude ||
                      (array.Component >= 0 && array.Component < array.Components);
  if (array.Components < 1 || !exists)
  {
    throw Error("The array has no component " + std::to_string(array.Component));
  }
  if (!array.Values)
  {
    throw Error("The array to draw has no values in memory");
  }
}

/// One component of a tuple of the array, or the length of all.
template <class In>
double TakenComponent(const In* tuple, const NodeArray& array)
{
  if (array.Component != NodeArray::Magnitude)
  {
    return static_cast<double>(tuple[array.Component]);
  }
  double sum = 0.0;
  for (int c = 0; c < array.Components; ++c)
  {
    const auto value = static_cast<double>(tuple[c]);
    sum += value * value;
  }
  return std::sqrt(sum);
}

} // namespace banyan

#endif
