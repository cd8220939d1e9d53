// SPDX-License-Identifier: BSD-3-Clause
#include "Cells/CellJacobian.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

/// A corner, and those at the other ends of three edges, right-handed in cells that are not
/// mirrored.
using Trihedron = std::array<int, 4>;

struct Trihedra
{
  int Count = 0;
  std::array<Trihedron, 8> Corners{};
};

const Trihedra& TrihedraOf(CellShape shape)
{
  static const Trihedra tetrahedron{ 1, { { { 0, 1, 2, 3 } } } };
  // At the apex of a pyramid it is zero.
  static const Trihedra pyramid{ 4,
    { { { 0, 1, 3, 4 }, { 1, 2, 0, 4 }, { 2, 3, 1, 4 }, { 3, 0, 2, 4 } } } };
  static const Trihedra wedge{ 6, { { { 0, 1, 2, 3 }, { 1, 2, 0, 4 }, { 2, 0, 1, 5 },
                                    { 3, 5, 4, 0 }, { 4, 3, 5, 1 }, { 5, 4, 3, 2 } } } };
  static const Trihedra hexahedron{ 8,
    { { { 0, 1, 2, 4 }, { 1, 3, 0, 5 }, { 2, 0, 3, 6 }, { 3, 2, 1, 7 }, { 4, 6, 5, 0 },
      { 5, 4, 7, 1 }, { 6, 7, 4, 2 }, { 7, 5, 6, 3 } } } };
  switch (shape)
  {
    case CellShape::Tetrahedron:
      return tetrahedron;
    case CellShape::Pyramid:
      return pyramid;
    case CellShape::Wedge:
      return wedge;
    default:
      return hexahedron;
  }
}

double LongestOf(const glm::dvec3& v)
{
  return std::max({ std::abs(v.x), std::abs(v.y), std::abs(v.z) });
}

/// Takes the signs of determinants.
class SignTaker
{
public:
  /// @param coordinate the largest one, in the unit of the vectors
  explicit SignTaker(double coordinate)
    : Coordinate(coordinate)
  {
  }

  void Take(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
  {
    // What the differences and products are off by, generously.
    constexpr double rounding = 1.0 / (std::int64_t{ 1 } << 50);
    const double la = LongestOf(a);
    const double lb = LongestOf(b);
    const double lc = LongestOf(c);
    const double most =
      rounding * (la * lb * lc + this->Coordinate * (la * lb + lb * lc + lc * la));
    const double determinant = glm::dot(glm::cross(a, b), c);
    this->Signs.Positive |= determinant > most;
    this->Signs.Negative |= determinant < -most;
  }

  bool HasNone() const { return !this->Signs.Positive && !this->Signs.Negative; }
  const JacobianSigns& Result() const { return this->Signs; }

private:
  double Coordinate;
  JacobianSigns Signs;
};

/// The cell as a hexahedron, with corners that coincide: it fills the same region.
CellPlaces AsHexahedron(CellShape shape, const CellPlaces& p)
{
  switch (shape)
  {
    case CellShape::Pyramid:
      return { p[0], p[1], p[3], p[2], p[4], p[4], p[4], p[4] };
    case CellShape::Wedge:
      return { p[0], p[1], p[2], p[2], p[3], p[4], p[5], p[5] };
    default:
      return p;
  }
}

/// The derivative along an axis, of a trilinear hexahedron.
glm::dvec3 DerivativeOf(const CellPlaces& p, int axis, const glm::dvec3& at)
{
  const int u = 1 << (axis + 1) % 3;
  const int v = 1 << (axis + 2) % 3;
  const auto edge = [&](int corner)
  {
    const auto from = static_cast<std::size_t>(corner);
    return p[from + (std::size_t{ 1 } << axis)] - p[from];
  };
  const double a = at[(axis + 1) % 3];
  const double b = at[(axis + 2) % 3];
  return (edge(0) * (1 - a) + edge(u) * a) * (1 - b) + (edge(v) * (1 - a) + edge(u + v) * a) * b;
}

/// The determinant is of degree 2 along each axis: it is zero everywhere if it is at 3 x 3 x 3
/// places.
void TakeInside(const CellPlaces& hexahedron, SignTaker& signs)
{
  for (int i = 0; i < 27; ++i)
  {
    const glm::dvec3 at = glm::dvec3(i % 3, i / 3 % 3, i / 9) * 0.5;
    signs.Take(DerivativeOf(hexahedron, 0, at), DerivativeOf(hexahedron, 1, at),
      DerivativeOf(hexahedron, 2, at));
  }
}

} // namespace

JacobianSigns SignsOfJacobian(CellShape shape, const CellPlaces& places)
{
  const auto corners = static_cast<std::size_t>(CornersOf(shape));
  CellPlaces scaled{};
  double extent = 0.0;
  double coordinate = 0.0;
  for (std::size_t i = 0; i < corners; ++i)
  {
    scaled[i] = places[i] - places[0];
    extent = std::max(extent, LongestOf(scaled[i]));
    coordinate = std::max(coordinate, LongestOf(places[i]));
  }
  if (extent == 0.0)
  {
    return {};
  }
  // So that no product overflows or vanishes.
  for (std::size_t i = 0; i < corners; ++i)
  {
    scaled[i] = scaled[i] / extent;
  }
  SignTaker signs(coordinate / extent);
  const Trihedra& trihedra = TrihedraOf(shape);
  for (std::size_t i = 0; i < static_cast<std::size_t>(trihedra.Count); ++i)
  {
    const Trihedron& t = trihedra.Corners[i];
    const auto at = [&scaled](int corner) { return scaled[static_cast<std::size_t>(corner)]; };
    signs.Take(at(t[1]) - at(t[0]), at(t[2]) - at(t[0]), at(t[3]) - at(t[0]));
  }
  if (signs.HasNone() && shape != CellShape::Tetrahedron)
  {
    TakeInside(AsHexahedron(shape, scaled), signs);
  }
  return signs.Result();
}

} // namespace banyan
