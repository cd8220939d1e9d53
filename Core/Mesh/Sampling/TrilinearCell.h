// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Sampling_TrilinearCell_h
#define banyan_Mesh_Sampling_TrilinearCell_h

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/vec3.hpp>

#include <array>
#include <cmath>

namespace banyan
{

/// Weights of eight corners, x fastest, at a place from 0 to 1 along each axis. They are not below
/// 0 there and add up to 1.
inline std::array<double, 8> TrilinearWeights(const glm::dvec3& part)
{
  const glm::dvec3 rest = 1.0 - part;
  std::array<double, 8> weights;
  for (int corner = 0; corner < 8; ++corner)
  {
    weights[static_cast<std::size_t>(corner)] = ((corner & 1) != 0 ? part.x : rest.x) *
                                                ((corner & 2) != 0 ? part.y : rest.y) *
                                                ((corner & 4) != 0 ? part.z : rest.z);
  }
  return weights;
}

/// A general hexahedron: the image of the unit cube under the trilinear map of its corners, as a
/// polynomial in the places r, s, t along its own axes.
class TrilinearCell
{
public:
  /// @param corners bit 0 of the number is along r, bit 1 along s, bit 2 along t
  explicit TrilinearCell(const std::array<glm::dvec3, 8>& corners)
    : One(corners[0])
    , R(corners[1] - corners[0])
    , S(corners[2] - corners[0])
    , T(corners[4] - corners[0])
    , RS(corners[3] - corners[2] - R)
    , ST(corners[6] - corners[4] - S)
    , RT(corners[5] - corners[4] - R)
    , RST(corners[7] - corners[6] - corners[5] + corners[4] - RS)
  {
  }
  TrilinearCell() = default;

  glm::dvec3 At(const glm::dvec3& p) const
  {
    return this->One + p.x * this->AlongR(p) + p.y * (this->S + p.z * this->ST) + p.z * this->T;
  }

  /// Columns are the derivatives along the cell's own axes.
  glm::dmat3 JacobianAt(const glm::dvec3& p) const
  {
    return { this->AlongR(p), this->S + p.x * this->RS + p.z * this->ST + p.x * p.z * this->RST,
      this->T + p.y * this->ST + p.x * this->RT + p.x * p.y * this->RST };
  }

  /// How far any point of the cell is at most from where the tangent in its middle puts it, along
  /// each axis.
  glm::dvec3 Bend() const
  {
    // For r s that is |(r - 1/2) (s - 1/2)| <= 1/4. For r s t it is three of these, halved, and
    // 1/8.
    return 0.25 * (glm::abs(this->RS + 0.5 * this->RST) + glm::abs(this->ST + 0.5 * this->RST) +
                    glm::abs(this->RT + 0.5 * this->RST)) +
           0.125 * glm::abs(this->RST);
  }

  /// Where in the cell a point lies, by Newton's method; outside of it an estimate.
  /// @param part begins as a guess
  /// @return whether the point was met, within 1e-9 of a cell that is not badly bent. False as soon
  /// as it is clear that the place is outside of the unit cube.
  bool Find(const glm::dvec3& point, glm::dvec3& part) const
  {
    for (int iteration = 0; iteration < 16; ++iteration)
    {
      const glm::dmat3 jacobian = this->JacobianAt(part);
      const glm::dvec3 first = glm::cross(jacobian[1], jacobian[2]);
      const double determinant = glm::dot(jacobian[0], first);
      if (determinant == 0.0 || !std::isfinite(determinant))
      {
        return false;
      }
      const glm::dvec3 rest = point - this->At(part);
      const glm::dvec3 step =
        glm::dvec3(glm::dot(first, rest), glm::dot(glm::cross(jacobian[2], jacobian[0]), rest),
          glm::dot(glm::cross(jacobian[0], jacobian[1]), rest)) /
        determinant;
      // Far outside the map may fold over: nothing is to be found there.
      part = glm::clamp(part + step, glm::dvec3(-1.0), glm::dvec3(2.0));
      // Steps become squares of themselves.
      const double length = glm::dot(step, step);
      if (length < 1e-10)
      {
        return true;
      }
      const glm::dvec3 out = glm::max(glm::max(-part, part - 1.0), glm::dvec3(0.0));
      if (iteration > 0 && length < 0.01 * glm::dot(out, out))
      {
        return false;
      }
    }
    return false;
  }

private:
  glm::dvec3 AlongR(const glm::dvec3& p) const
  {
    return this->R + p.y * this->RS + p.z * (this->RT + p.y * this->RST);
  }

  glm::dvec3 One{ 0.0 };
  glm::dvec3 R{ 0.0 };
  glm::dvec3 S{ 0.0 };
  glm::dvec3 T{ 0.0 };
  glm::dvec3 RS{ 0.0 };
  glm::dvec3 ST{ 0.0 };
  glm::dvec3 RT{ 0.0 };
  glm::dvec3 RST{ 0.0 };
};

} // namespace banyan

#endif
