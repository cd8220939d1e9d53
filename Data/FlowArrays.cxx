// SPDX-License-Identifier: BSD-3-Clause
#include "FlowArrays.h"

#include "FlowSimulation.h"

#include <cmath>

namespace banyan
{

ImageArray FlowArray(const FlowSimulation& flow, const std::string& name)
{
  ImageArray array;
  array.Name = name;
  if (name == "temperature")
  {
    array.Values = flow.Temperature();
    return array;
  }
  const auto vectors = name == "velocity" ? flow.Velocity() : flow.Vorticity();
  array.Components = name == "velocity" ? 3 : 1;
  const std::size_t count = vectors[0].size();
  array.Values.resize(count * array.Components);
  for (std::size_t i = 0; i < count; ++i)
  {
    const float x = vectors[0][i], y = vectors[1][i], z = vectors[2][i];
    if (name == "velocity")
    {
      array.Values[3 * i] = x;
      array.Values[3 * i + 1] = y;
      array.Values[3 * i + 2] = z;
    }
    else
    {
      array.Values[i] = std::sqrt(x * x + y * y + z * z);
    }
  }
  return array;
}

} // namespace banyan
