// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Scene/ShadingTable.h"

#include "Base/Error.h"
#include "Render/Scene/RayLattice.h"

#include <glm/matrix.hpp>

namespace banyan
{

ShadingTable::ShadingTable(const RayShading& shading, const glm::dmat3& worldToIndex)
  : Ambient(shading.Ambient)
  , Diffuse(shading.Diffuse)
  , HasHighlights(shading.Specular > 0.0f)
{
  for (const float value :
    { shading.Ambient, shading.Diffuse, shading.Specular, shading.SpecularPower })
  {
    if (!(value >= 0.0f) || !std::isfinite(value))
    {
      throw Error("A coefficient of the shading is negative or not finite");
    }
  }
  // A gradient in world space is the transposed matrix times the one in index space.
  const glm::dmat3 scaled = worldToIndex * ScaleToOne(worldToIndex);
  const glm::dmat3 metric = scaled * glm::transpose(scaled);
  for (int i = 0; i < 3; ++i)
  {
    this->Metric[i] = static_cast<float>(metric[i][i]);
  }
  this->Metric[3] = static_cast<float>(2.0 * metric[0][1]);
  this->Metric[4] = static_cast<float>(2.0 * metric[0][2]);
  this->Metric[5] = static_cast<float>(2.0 * metric[1][2]);
  this->Highlights.reserve(Entries);
  for (int i = 0; i < Entries; ++i)
  {
    const double power = std::pow(i / (Entries - 1.0), double{ shading.SpecularPower });
    this->Highlights.push_back(static_cast<float>(shading.Specular * power));
  }
}

} // namespace banyan
