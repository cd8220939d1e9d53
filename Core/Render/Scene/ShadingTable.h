// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Scene_ShadingTable_h
#define banyan_Render_Scene_ShadingTable_h

#include "Render/Scene/RayScene.h"

#include <cmath>
#include <vector>

namespace banyan
{

/// What a sample's gradient does to its colour. Vectors do the same in the same order.
struct Shade
{
  float Colour = 1.0f;    ///< factor
  float Highlight = 0.0f; ///< added, times opacity
};

/// RayShading, made ready for one scene.
class ShadingTable
{
public:
  static constexpr int Entries = 4096;

  /// @param worldToIndex of directions
  /// Throws Error when a coefficient is not finite or negative.
  ShadingTable(const RayShading& shading, const glm::dmat3& worldToIndex);

  /// @param gradient in index space, times any power of two
  /// @param direction of the ray, as RayTile::Direction has it
  Shade Of(const float (&gradient)[3], const float (&direction)[3]) const
  {
    const float along =
      (gradient[0] * direction[0] + gradient[1] * direction[1]) + gradient[2] * direction[2];
    const float(&m)[6] = this->Metric;
    const float x = (gradient[0] * m[0] + gradient[1] * m[3]) + gradient[2] * m[4];
    const float y = gradient[1] * m[1] + gradient[2] * m[5];
    const float z = gradient[2] * m[2];
    const float length = (gradient[0] * x + gradient[1] * y) + gradient[2] * z;
    const float squared = along * along / length;
    // Not a number where there is no gradient.
    const float inside = squared >= 0.0f ? (squared < 1.0f ? squared : 1.0f) : 0.0f;
    const float cosine = std::sqrt(inside);
    const float nearest = cosine * (Entries - 1) + 0.5f;
    const int entry = static_cast<int>(nearest);
    return { this->Ambient + this->Diffuse * cosine,
      this->Highlights[static_cast<std::size_t>(entry)] };
  }

  float Ambient;
  float Diffuse;
  /// Squared length of gradients: xx, yy, zz, 2 xy, 2 xz, 2 yz.
  float Metric[6];
  bool HasHighlights;
  std::vector<float> Highlights;
};

} // namespace banyan

#endif
