// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Cells/CellSetup.h"

#include "Render/Scene/RayLattice.h"

#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>

#include <algorithm>
#include <cmath>

namespace banyan
{
namespace
{

constexpr double Unit = 1 << FractionBits;
/// Bent terms below this part of a cell's edge change no value that anybody can see.
constexpr double LeastBend = 1.0 / (1 << 17);
/// Where bent terms lead places further away than this, taking them once brings a first guess no
/// nearer: cells may fold, and Newton's method is to come from their middle.
constexpr double MostLean = 0.5;
/// Of a face whose middle is this far from where two of its corners have it, in places: its cell
/// folds.
constexpr float MostBulge = 1.0f;
/// Cells that extend further than this may lie further than 128 cells from their middle.
constexpr double WidestNarrow = 60.0;
/// Below this part of the product of its edges a cell's middle counts as flat.
constexpr double LeastVolume = 1e-9;

/// A polynomial with values in T: double or glm::dvec3.
template <class T>
struct Terms
{
  T Base{ 0.0 };
  T Linear[3] = { T(0.0), T(0.0), T(0.0) };
  T Bent[4] = { T(0.0), T(0.0), T(0.0), T(0.0) };
};

template <class T>
Terms<T> TermsOfHexahedron(const T* c)
{
  // Sums and differences along one axis after the other.
  T x[8];
  for (int i = 0; i < 4; ++i)
  {
    x[i] = c[2 * i] + c[2 * i + 1];
    x[4 + i] = c[2 * i + 1] - c[2 * i];
  }
  T y[8];
  for (int i = 0; i < 2; ++i)
  {
    y[i] = x[2 * i] + x[2 * i + 1];
    y[2 + i] = x[2 * i + 1] - x[2 * i];
    y[4 + i] = x[4 + 2 * i] + x[5 + 2 * i];
    y[6 + i] = x[5 + 2 * i] - x[4 + 2 * i];
  }
  const double eighth = 0.125;
  Terms<T> terms;
  terms.Base = eighth * (y[0] + y[1]);
  terms.Linear[0] = eighth * (y[4] + y[5]);
  terms.Linear[1] = eighth * (y[2] + y[3]);
  terms.Linear[2] = eighth * (y[1] - y[0]);
  terms.Bent[0] = eighth * (y[6] + y[7]);
  terms.Bent[1] = eighth * (y[3] - y[2]);
  terms.Bent[2] = eighth * (y[5] - y[4]);
  terms.Bent[3] = eighth * (y[7] - y[6]);
  return terms;
}

template <class T>
Terms<T> TermsOfTetrahedron(const T* c)
{
  Terms<T> terms;
  terms.Base = c[0];
  for (int i = 0; i < 3; ++i)
  {
    terms.Linear[i] = c[i + 1] - c[0];
  }
  return terms;
}

template <class T>
Terms<T> TermsOfWedge(const T* c)
{
  Terms<T> terms;
  terms.Base = 0.5 * (c[0] + c[3]);
  terms.Linear[2] = 0.5 * (c[3] - c[0]);
  for (int i = 0; i < 2; ++i)
  {
    const T below = c[i + 1] - c[0];
    const T above = c[i + 4] - c[3];
    terms.Linear[i] = 0.5 * (above + below);
    terms.Bent[i] = 0.5 * (above - below);
  }
  return terms;
}

template <class T>
Terms<T> TermsOfPyramid(const T* c)
{
  Terms<T> terms;
  terms.Base = c[4];
  terms.Linear[0] = 0.25 * ((c[1] - c[0]) + (c[2] - c[3]));
  terms.Linear[1] = 0.25 * ((c[3] - c[0]) + (c[2] - c[1]));
  terms.Linear[2] = 0.25 * ((c[0] + c[2]) + (c[1] + c[3])) - c[4];
  terms.Bent[0] = 0.25 * ((c[0] - c[1]) + (c[2] - c[3]));
  return terms;
}

template <class T>
Terms<T> TermsOf(CellShape shape, const T* corners)
{
  switch (shape)
  {
    case CellShape::Tetrahedron:
      return TermsOfTetrahedron(corners);
    case CellShape::Wedge:
      return TermsOfWedge(corners);
    case CellShape::Pyramid:
      return TermsOfPyramid(corners);
    default:
      return TermsOfHexahedron(corners);
  }
}

/// The matrix that takes positions to places, without the bent terms.
/// @return false when there is none
bool Invert(const Terms<glm::dvec3>& terms, glm::dmat3& inverse)
{
  const glm::dmat3 linear(terms.Linear[0], terms.Linear[1], terms.Linear[2]);
  const double volume = glm::determinant(linear);
  const double edges =
    glm::length(terms.Linear[0]) * glm::length(terms.Linear[1]) * glm::length(terms.Linear[2]);
  if (!(std::abs(volume) > LeastVolume * edges))
  {
    return false;
  }
  const glm::dvec3 rows[3] = { glm::cross(linear[1], linear[2]), glm::cross(linear[2], linear[0]),
    glm::cross(linear[0], linear[1]) };
  for (int i = 0; i < 3; ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      inverse[axis][i] = rows[i][axis] / volume;
    }
  }
  return std::isfinite(inverse[0][0] + inverse[1][1] + inverse[2][2]);
}

/// Where bent terms lead places.
struct Leans
{
  glm::dvec3 Of[4] = { glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0), glm::dvec3(0.0) };
  double Most = 0.0; ///< of all together, at most
};

Leans LeansOf(const Terms<glm::dvec3>& terms, const glm::dmat3& inverse)
{
  Leans leans;
  glm::dvec3 sum(0.0);
  for (int i = 0; i < 4; ++i)
  {
    leans.Of[i] = inverse * terms.Bent[i];
    sum += glm::abs(leans.Of[i]);
  }
  leans.Most = std::max({ sum.x, sum.y, sum.z });
  return leans;
}

/// How far places may be off. Beyond faces at the border of the mesh, samples that may lie on the
/// face are the cell's, and no others: a ray that passes beside the mesh would stand for an
/// interval in it. Where faces hang, the border is that of two cells, and a sample between them is
/// in one.
/// @param size of the box around the cell
float MarginAtBorder(const glm::dmat3& inverse, const glm::dvec3& size, double lean)
{
  // Each place is a sum of three products, of numbers up to the size with errors of 2^-25 of it.
  constexpr double rounding = 1.0 / (1 << 21);
  constexpr double lastStep = CellSetup::LastStep;
  double most = 0.0;
  for (int i = 0; i < 3; ++i)
  {
    most = std::max(most, std::abs(inverse[0][i]) * size.x + std::abs(inverse[1][i]) * size.y +
                            std::abs(inverse[2][i]) * size.z);
  }
  // Below the least bend there is no Newton's method, and the bent terms are missing. Elsewhere
  // their part grows from the middle to the faces, here up to twice.
  const double bent = lean > LeastBend ? 2.0 * lastStep * lastStep * lean : lean;
  return static_cast<float>(std::min(rounding * most + bent, double{ CellSetup::Margin }));
}

/// Which places a quad has; its first corner is where u and v are -1.
FanBound BoundOf(CellShape shape, int face)
{
  FanBound bound;
  if (shape == CellShape::Pyramid)
  {
    return { { 0.0f, 0.0f, 1.0f }, { 1.0f, 0.0f, 0.0f, 0.0f }, { 0.0f, 1.0f, 0.0f }, 0.0f, 1.0f };
  }
  if (shape == CellShape::Wedge)
  {
    switch (face)
    {
      case 2:
        return { { 0.0f, -1.0f, 0.0f }, { 2.0f, 0.0f, 0.0f, -1.0f }, { 0.0f, 0.0f, 1.0f } };
      case 3:
        return { { 1.0f, 1.0f, 0.0f }, { 0.0f, 2.0f, 0.0f, -1.0f }, { 0.0f, 0.0f, 1.0f }, 0.0f,
          1.0f };
      default:
        return { { -1.0f, 0.0f, 0.0f }, { 0.0f, -2.0f, 0.0f, 1.0f }, { 0.0f, 0.0f, 1.0f } };
    }
  }
  const int axis = face / 2;
  bound.Out[axis] = face % 2 == 0 ? -1.0f : 1.0f;
  bound.U[(axis + 1) % 3] = 1.0f;
  bound.V[(axis + 2) % 3] = 1.0f;
  bound.Most = 1.0f;
  return bound;
}

} // namespace

/// A cell lies within the hull of its corners, so these bound what is linear.
/// @param offsets of corners from the middle
void CellSetup::SetBounds(const glm::dvec3 (&offsets)[8], const glm::dmat3& inverse)
{
  // More than rounding, and than how far outside of a cell samples count as its own.
  constexpr double margin = 0.001;
  const bool tetrahedron = this->Shape == CellShape::Tetrahedron;
  this->HasSum = tetrahedron || this->Shape == CellShape::Wedge;
  const glm::dvec3 base(this->Base[0], this->Base[1], this->Base[2]);
  glm::dvec3 low(inverse * (offsets[0] - base));
  glm::dvec3 high(low);
  double highSum = low.x + low.y + (tetrahedron ? low.z : 0.0);
  for (int corner = 1; corner < CornersOf(this->Shape); ++corner)
  {
    const glm::dvec3 place = inverse * (offsets[corner] - base);
    low = glm::min(low, place);
    high = glm::max(high, place);
    highSum = std::max(highSum, place.x + place.y + (tetrahedron ? place.z : 0.0));
  }
  this->HighSum = static_cast<float>(highSum + margin);
  for (int i = 0; i < 3; ++i)
  {
    this->Low[i] = static_cast<float>(low[i] - margin);
    this->High[i] = static_cast<float>(high[i] + margin);
  }
}

void CellTerms::Set(CellShape shape, const float (&values)[8])
{
  double numbers[8] = {};
  for (int i = 0; i < CornersOf(shape); ++i)
  {
    numbers[i] = values[i];
  }
  const Terms<double> terms = TermsOf(shape, numbers);
  this->Base = static_cast<float>(terms.Base);
  for (int i = 0; i < 3; ++i)
  {
    this->Linear[i] = static_cast<float>(terms.Linear[i]);
  }
  for (int i = 0; i < 4; ++i)
  {
    this->Bent[i] = static_cast<float>(terms.Bent[i]);
  }
}

/// Where places of the cell end.
/// @param beyond of places, by face
void CellSetup::SetFaces(const float (&beyond)[6])
{
  switch (this->Shape)
  {
    case CellShape::Tetrahedron:
      this->Least[0] = -beyond[3];
      this->Least[1] = -beyond[1];
      this->Least[2] = -beyond[0];
      this->MostSum = 1.0f + beyond[2];
      break;
    case CellShape::Wedge:
      this->Least[0] = -beyond[4];
      this->Least[1] = -beyond[2];
      this->Least[2] = -1.0f - beyond[0];
      this->Most[2] = 1.0f + beyond[1];
      this->MostSum = 1.0f + beyond[3];
      break;
    case CellShape::Pyramid:
      this->Least[0] = -beyond[4];
      this->Most[0] = beyond[2];
      this->Least[1] = -beyond[1];
      this->Most[1] = beyond[3];
      this->Least[2] = -Margin; // the apex is no face
      this->Most[2] = 1.0f + beyond[0];
      break;
    default:
      for (int i = 0; i < 3; ++i)
      {
        this->Least[i] = -1.0f - beyond[2 * i];
        this->Most[i] = 1.0f + beyond[2 * i + 1];
      }
  }
}

/// Takes faces whose four triangles lie elsewhere than the bilinear face. To first order: the
/// cell's linear part says where.
/// @param beyond grows by what is outside of the bilinear faces
void CellSetup::SetFans(const glm::dvec3 (&corners)[8], unsigned border, float (&beyond)[6])
{
  const CellFaces& faces = FacesOf(this->Shape);
  for (int number = 0; number < faces.Count; ++number)
  {
    const CellFace& face = faces.Faces[static_cast<std::size_t>(number)];
    if ((border >> number & 1) == 0 || face.Count != 4)
    {
      continue;
    }
    const auto corner = [&](std::size_t i) { return corners[face.Corners[i]]; };
    const glm::dvec3 twist = 0.25 * ((corner(0) - corner(1)) + (corner(2) - corner(3)));
    const glm::dvec3 normal = glm::cross(corner(2) - corner(0), corner(3) - corner(1));
    FanBound fan = BoundOf(this->Shape, number);
    const int axis = fan.Out[0] != 0.0f ? 0 : (fan.Out[1] != 0.0f ? 1 : 2);
    const float(&linear)[3] = this->Linear[axis];
    const glm::dvec3 out = double{ fan.Out[axis] } * glm::dvec3(linear[0], linear[1], linear[2]);
    fan.Bulge = static_cast<float>(glm::dot(normal, twist) / glm::dot(normal, out));
    fan.Most += beyond[number];
    if (std::abs(fan.Bulge) > beyond[number] && std::abs(fan.Bulge) < MostBulge)
    {
      // Triangles are a fourth of it away at most.
      beyond[number] += 0.25f * std::abs(fan.Bulge);
      this->Fans[this->FanCount++] = fan;
    }
  }
}

/// @param margin beyond faces at the border
void CellSetup::SetBorder(const glm::dvec3 (&corners)[8], unsigned border, float margin)
{
  float beyond[6];
  for (int face = 0; face < 6; ++face)
  {
    beyond[face] = (border >> face & 1) != 0 ? margin : Margin;
  }
  this->FanCount = 0;
  if (border != 0 && this->IsBent)
  {
    this->SetFans(corners, border, beyond);
  }
  this->SetFaces(beyond);
}

bool CellSetup::Set(CellShape shape, const glm::dvec3 (&corners)[8], unsigned border)
{
  this->Shape = shape;
  const int count = CornersOf(shape);
  glm::dvec3 low = corners[0];
  glm::dvec3 high = corners[0];
  for (int i = 1; i < count; ++i)
  {
    low = glm::min(low, corners[i]);
    high = glm::max(high, corners[i]);
  }
  glm::dvec3 middle(0.0);
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Middle[axis] = std::floor(0.5 * (low[axis] + high[axis]) * Unit);
    middle[axis] = this->Middle[axis] / Unit;
    this->Reach[axis] = (0.51 * (high[axis] - low[axis]) + 0.001) * Unit;
  }
  const glm::dvec3 size = high - low;
  this->IsWide = !(std::max({ size.x, size.y, size.z }) < WidestNarrow);
  glm::dvec3 offsets[8];
  for (int i = 0; i < count; ++i)
  {
    offsets[i] = corners[i] - middle;
  }
  const Terms<glm::dvec3> terms = TermsOf(shape, offsets);
  glm::dmat3 inverse(1.0);
  const bool inverts = Invert(terms, inverse);
  if (!inverts && shape == CellShape::Tetrahedron)
  {
    return false;
  }
  // Where the middle is flat, places are positions until Newton's method finds them.
  const Leans leans = inverts ? LeansOf(terms, inverse) : Leans{};
  for (int axis = 0; axis < 3; ++axis)
  {
    this->Base[axis] = static_cast<float>(terms.Base[axis]);
  }
  for (int i = 0; i < 4; ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Bent[i][axis] = static_cast<float>(terms.Bent[i][axis]);
      this->Lean[i][axis] = leans.Most <= MostLean ? static_cast<float>(leans.Of[i][axis]) : 0.0f;
    }
  }
  this->IsBent = !inverts || leans.Most > LeastBend;
  for (int i = 0; i < 3; ++i)
  {
    for (int axis = 0; axis < 3; ++axis)
    {
      this->Linear[i][axis] = static_cast<float>(terms.Linear[i][axis]);
      this->Inverse[i][axis] = static_cast<float>(inverse[axis][i]);
    }
  }
  this->SetBounds(offsets, inverse);
  this->SetBorder(
    corners, border, border != 0 && inverts ? MarginAtBorder(inverse, size, leans.Most) : Margin);
  return true;
}

} // namespace banyan
