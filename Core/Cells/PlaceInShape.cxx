// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/PlaceInShape.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace banyan
{
namespace
{

constexpr int MostSteps = 50;
/// Of the last step: its square is far below the rounding of places.
constexpr double Converged = 1e-12;
/// Volume of the tangents' parallelepiped, of that of a box with its edges: less is rounding.
constexpr double NoVolume = 1e-13;
/// Beyond this, places are not followed further.
constexpr double Farthest = 4.0;
/// Below this height a pyramid is so narrow that r and s of a point beside it mean nothing.
constexpr double NearApex = 0x1p-10;

double Largest(const glm::dvec3& v)
{
  return std::max({ std::abs(v.x), std::abs(v.y), std::abs(v.z) });
}

/// The map from the unknowns of Newton's method to space, relative to the first corner. Unknowns
/// are: places from -1 to 1 of hexahedra; r, s and t of tetrahedra; r, s, and t from -1 to 1, of
/// wedges; u, v and h of pyramids.
class ShapeMap
{
public:
  ShapeMap(CellShape shape, const CellCorners& corners)
    : Shape(shape)
  {
    std::array<glm::dvec3, 8> c{};
    for (std::size_t i = 0; i < static_cast<std::size_t>(CornersOf(shape)); ++i)
    {
      c[i] = corners[i] - corners[0];
    }
    switch (shape)
    {
      case CellShape::Tetrahedron:
        this->X = c[1];
        this->Y = c[2];
        this->Z = c[3];
        break;
      case CellShape::Pyramid:
        this->SetPyramid(c);
        break;
      case CellShape::Wedge:
        this->SetWedge(c);
        break;
      default:
        this->SetHexahedron(c);
    }
  }

  /// Where Newton's method starts.
  glm::dvec3 Middle() const
  {
    switch (this->Shape)
    {
      case CellShape::Tetrahedron:
        return glm::dvec3(0.25);
      case CellShape::Pyramid:
        return { 0.0, 0.0, 0.5 };
      case CellShape::Wedge:
        return { 1.0 / 3.0, 1.0 / 3.0, 0.0 };
      default:
        return glm::dvec3(0.0);
    }
  }

  glm::dvec3 At(const glm::dvec3& p) const
  {
    if (this->Shape == CellShape::Pyramid)
    {
      return this->One + p.x * this->X + p.y * this->Y + p.z * this->Z +
             p.x * p.y / Height(p) * this->XY;
    }
    return this->One + p.x * this->X + p.y * this->Y + p.z * this->Z + p.x * p.y * this->XY +
           p.y * p.z * this->YZ + p.z * p.x * this->ZX + p.x * p.y * p.z * this->XYZ;
  }

  /// Columns are the derivatives.
  glm::dmat3 JacobianAt(const glm::dvec3& p) const
  {
    if (this->Shape != CellShape::Pyramid)
    {
      return { this->X + p.y * this->XY + p.z * this->ZX + p.y * p.z * this->XYZ,
        this->Y + p.x * this->XY + p.z * this->YZ + p.x * p.z * this->XYZ,
        this->Z + p.y * this->YZ + p.x * this->ZX + p.x * p.y * this->XYZ };
    }
    const double height = Height(p);
    glm::dvec3 product(p.y / height, p.x / height, 0.0);
    if (height == p.z)
    {
      product.z = -p.x * p.y / (height * height);
    }
    else if (height == std::abs(p.x))
    {
      product.x = 0.0;
    }
    else if (height == std::abs(p.y))
    {
      product.y = 0.0;
    }
    return { this->X + product.x * this->XY, this->Y + product.y * this->XY,
      this->Z + product.z * this->XY };
  }

  bool Inside(const glm::dvec3& p, const FaceTolerances& tolerances) const
  {
    const FaceTolerances inwards = this->FromFaces(p);
    for (std::size_t face = 0; face < static_cast<std::size_t>(FacesOf(this->Shape).Count); ++face)
    {
      if (!(inwards[face] >= -tolerances[face]))
      {
        return false;
      }
    }
    // Beyond its apex a pyramid would begin again.
    return this->Shape != CellShape::Pyramid ||
           p.z >= -*std::max_element(tolerances.begin() + 1, tolerances.begin() + 5);
  }

  /// Unknowns as VTK's parametric coordinates.
  glm::dvec3 PlaceOf(const glm::dvec3& p) const
  {
    switch (this->Shape)
    {
      case CellShape::Tetrahedron:
        return p;
      case CellShape::Pyramid:
      {
        const double height = Height(p);
        return { 0.5 + 0.5 * (p.x / height), 0.5 + 0.5 * (p.y / height), 1.0 - height };
      }
      case CellShape::Wedge:
        return { p.x, p.y, 0.5 + 0.5 * p.z };
      default:
        return 0.5 + 0.5 * p;
    }
  }

private:
  /// How far inside of each face a place is.
  FaceTolerances FromFaces(const glm::dvec3& p) const
  {
    switch (this->Shape)
    {
      case CellShape::Tetrahedron:
        return { p.z, p.y, 1.0 - p.x - p.y - p.z, p.x };
      case CellShape::Pyramid:
        return { 1.0 - p.z, p.z + p.y, p.z - p.x, p.z - p.y, p.z + p.x };
      case CellShape::Wedge:
        return { 1.0 + p.z, 1.0 - p.z, p.y, 1.0 - p.x - p.y, p.x };
      default:
        return { 1.0 + p.x, 1.0 - p.x, 1.0 + p.y, 1.0 - p.y, 1.0 + p.z, 1.0 - p.z };
    }
  }

  /// h where a pyramid is wide enough. Near the apex the smallest one at which u and v are inside:
  /// beside the pyramid, which ends there, u v / h would have no bound.
  static double Height(const glm::dvec3& p)
  {
    const double least = std::min(NearApex, std::max(std::abs(p.x), std::abs(p.y)));
    return std::max({ p.z, least, 0x1p-500 });
  }

  void SetHexahedron(const std::array<glm::dvec3, 8>& c)
  {
    const std::array<glm::dvec3*, 8> terms{ &this->One, &this->X, &this->Y, &this->XY, &this->Z,
      &this->ZX, &this->YZ, &this->XYZ };
    for (std::size_t term = 0; term < 8; ++term)
    {
      for (std::size_t corner = 0; corner < 8; ++corner)
      {
        // The product of the signs, -1 or 1, of the corner's coordinates that the term has.
        const std::size_t low = term & ~corner;
        const bool odd = ((low ^ low >> 1 ^ low >> 2) & 1) != 0;
        *terms[term] += (odd ? -0.125 : 0.125) * c[corner];
      }
    }
  }

  void SetWedge(const std::array<glm::dvec3, 8>& c)
  {
    this->One = 0.5 * (c[0] + c[3]);
    this->X = 0.5 * (c[1] + c[4]) - this->One;
    this->Y = 0.5 * (c[2] + c[5]) - this->One;
    this->Z = 0.5 * (c[3] - c[0]);
    this->ZX = 0.5 * (c[4] - c[1]) - this->Z;
    this->YZ = 0.5 * (c[5] - c[2]) - this->Z;
  }

  /// Relative to the apex, h times what the base has.
  void SetPyramid(const std::array<glm::dvec3, 8>& c)
  {
    this->One = c[4];
    this->Z = 0.25 * (c[0] + c[1] + c[2] + c[3]) - c[4];
    this->X = 0.25 * (c[1] + c[2] - c[0] - c[3]);
    this->Y = 0.25 * (c[2] + c[3] - c[0] - c[1]);
    this->XY = 0.25 * (c[0] + c[2] - c[1] - c[3]);
  }

  CellShape Shape;
  glm::dvec3 One{ 0.0 };
  glm::dvec3 X{ 0.0 };
  glm::dvec3 Y{ 0.0 };
  glm::dvec3 Z{ 0.0 };
  glm::dvec3 XY{ 0.0 }; ///< of pyramids: with u v / h
  glm::dvec3 YZ{ 0.0 };
  glm::dvec3 ZX{ 0.0 };
  glm::dvec3 XYZ{ 0.0 };
};

/// What a matrix takes to `rest`.
/// @return false when there is no such vector
bool Solve(const glm::dmat3& jacobian, const glm::dvec3& rest, glm::dvec3& step)
{
  const glm::dvec3 first = glm::cross(jacobian[1], jacobian[2]);
  const double determinant = glm::dot(jacobian[0], first);
  const double box = glm::length(jacobian[0]) * glm::length(jacobian[1]) * glm::length(jacobian[2]);
  if (!(std::abs(determinant) > NoVolume * box) || !std::isfinite(determinant))
  {
    return false;
  }
  step = glm::dvec3(glm::dot(first, rest), glm::dot(glm::cross(jacobian[2], jacobian[0]), rest),
           glm::dot(glm::cross(jacobian[0], jacobian[1]), rest)) /
         determinant;
  return true;
}

} // namespace

std::array<double, 8> WeightsAt(CellShape shape, const glm::dvec3& place)
{
  const auto [r, s, t] = std::array<double, 3>{ place.x, place.y, place.z };
  const glm::dvec3 rest = 1.0 - place;
  switch (shape)
  {
    case CellShape::Tetrahedron:
      return { 1.0 - r - s - t, r, s, t };
    case CellShape::Pyramid:
      return { rest.x * rest.y * rest.z, r * rest.y * rest.z, r * s * rest.z, rest.x * s * rest.z,
        t };
    case CellShape::Wedge:
    {
      const double first = 1.0 - r - s;
      return { first * rest.z, r * rest.z, s * rest.z, first * t, r * t, s * t };
    }
    case CellShape::Hexahedron:
      return { rest.x * rest.y * rest.z, r * rest.y * rest.z, rest.x * s * rest.z, r * s * rest.z,
        rest.x * rest.y * t, r * rest.y * t, rest.x * s * t, r * s * t };
    default:
      return {};
  }
}

glm::dvec3 PositionAt(CellShape shape, const CellCorners& corners, const glm::dvec3& place)
{
  const std::array<double, 8> weights = WeightsAt(shape, place);
  // From the first corner on: small cells far from the origin keep their digits.
  glm::dvec3 position(0.0);
  for (std::size_t i = 1; i < static_cast<std::size_t>(CornersOf(shape)); ++i)
  {
    position += weights[i] * (corners[i] - corners[0]);
  }
  return corners[0] + position;
}

bool FindPlace(CellShape shape, const CellCorners& corners, const glm::dvec3& point,
  double tolerance, glm::dvec3& place)
{
  FaceTolerances tolerances;
  tolerances.fill(tolerance);
  return FindPlace(shape, corners, point, tolerances, place);
}

bool FindPlace(CellShape shape, const CellCorners& corners, const glm::dvec3& point,
  const FaceTolerances& tolerances, glm::dvec3& place)
{
  if (shape == CellShape::None)
  {
    return false;
  }
  const ShapeMap map(shape, corners);
  const glm::dvec3 target = point - corners[0];
  glm::dvec3 at = map.Middle();
  for (int i = 0; i < MostSteps; ++i)
  {
    glm::dvec3 step;
    if (!Solve(map.JacobianAt(at), target - map.At(at), step))
    {
      return false;
    }
    if (!std::isfinite(step.x + step.y + step.z))
    {
      return false;
    }
    at = glm::clamp(at + step, -Farthest, Farthest);
    if (Largest(step) < Converged)
    {
      place = map.PlaceOf(at);
      return map.Inside(at, tolerances);
    }
  }
  return false;
}

} // namespace banyan
