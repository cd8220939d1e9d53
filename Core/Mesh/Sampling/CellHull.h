// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Sampling_CellHull_h
#define banyan_Mesh_Sampling_CellHull_h

#include <glm/geometric.hpp>
#include <glm/vec3.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace banyan
{

/// The space between pairs of planes around a hexahedron, one pair along each face. A trilinear
/// cell lies within the hull of its corners, however it is bent. So a point outside of a pair is in
/// no place of the cell, and need not be looked for there. Takes 180 bytes.
class CellHull
{
public:
  CellHull() = default;

  /// @param corners as TrilinearCell has them
  explicit CellHull(const std::array<glm::dvec3, 8>& corners)
  {
    for (const glm::dvec3& corner : corners)
    {
      this->Centre += 0.125 * corner;
    }
    double radius = 0.0;
    for (const glm::dvec3& corner : corners)
    {
      radius = std::max(radius, glm::length(corner - this->Centre));
    }
    for (std::size_t face = 0; face < 6; ++face)
    {
      const std::size_t axis = face / 2;
      const std::size_t first = face % 2 << axis;
      const std::size_t right = std::size_t{ 1 } << (axis + 1) % 3;
      const std::size_t up = std::size_t{ 1 } << (axis + 2) % 3;
      const glm::dvec3 normal = glm::cross(
        corners[first | right | up] - corners[first], corners[first | up] - corners[first | right]);
      const double length = glm::length(normal);
      this->Set(face, length > 0.0 ? normal / length : glm::dvec3(0.0), corners, radius);
    }
  }

  /// False when the point is outside; also of some places outside it is true, as of those up to
  /// 1e-5 of the cell's size beside it.
  bool MayHold(const glm::dvec3& point) const
  {
    // Relative to the middle single precision is enough, and all pairs are looked at at once.
    const glm::vec3 off(point - this->Centre);
    int outside = 0;
    for (std::size_t i = 0; i < Lanes; ++i)
    {
      const float along = this->X[i] * off.x + this->Y[i] * off.y + this->Z[i] * off.z;
      outside |= std::abs(along - this->Middle[i]) > this->Half[i] ? 1 : 0;
    }
    return outside == 0;
  }

private:
  static constexpr std::size_t Lanes = 8; ///< the last two have no planes
  using Row = std::array<float, Lanes>;

  void Set(std::size_t face, const glm::dvec3& normal, const std::array<glm::dvec3, 8>& corners,
    double radius)
  {
    double low = glm::dot(normal, corners[0] - this->Centre);
    double high = low;
    for (const glm::dvec3& corner : corners)
    {
      const double along = glm::dot(normal, corner - this->Centre);
      low = std::min(low, along);
      high = std::max(high, along);
    }
    this->X[face] = static_cast<float>(normal.x);
    this->Y[face] = static_cast<float>(normal.y);
    this->Z[face] = static_cast<float>(normal.z);
    this->Middle[face] = static_cast<float>(0.5 * (low + high));
    // More than rounding, and than how far outside a point counts as one of a face.
    this->Half[face] = static_cast<float>(0.5 * (high - low) + 2e-5 * radius);
  }

  glm::dvec3 Centre{ 0.0 };
  Row X{}, Y{}, Z{}, Middle{}, Half{};
};

} // namespace banyan

#endif
