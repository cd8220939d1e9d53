// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_CellPlacer_h
#define banyan_Mesh_Octree_CellPlacer_h

#include "Mesh/Octree/ElementOctree.h"

#include <glm/common.hpp>

#include <algorithm>
#include <cmath>
#include <string>

namespace banyan
{

/// A cell on the lattice.
struct LatticeCell
{
  glm::ivec3 Corner{ 0 };
  int Level = 0;
  std::array<std::uint8_t, 8> Order{}; ///< the place of each of its points
};

/// Puts cells onto the lattice, one after the other.
template <class Real, class Id>
class CellPlacer
{
public:
  CellPlacer(const ElementOctree& tree, const Real* points, const Id* ids)
    : Tree(tree)
    , Points(points)
    , Ids(ids)
    , Origin(tree.Origin())
    , PerEdge(1.0 / tree.Edge())
    , Allowed(tree.Tolerance() / tree.Edge())
  {
  }

  /// @return what is wrong with the cell; empty if nothing is
  std::string Place(std::int64_t cell, LatticeCell& placed) const
  {
    return this->PlaceBox(cell, placed) ? std::string() : this->PlaceClosely(cell, placed);
  }

private:
  static std::string Text(const glm::dvec3& v)
  {
    return std::to_string(v.x) + " x " + std::to_string(v.y) + " x " + std::to_string(v.z);
  }

  static std::string Text(const glm::ivec3& v)
  {
    return std::to_string(v.x) + " x " + std::to_string(v.y) + " x " + std::to_string(v.z);
  }

  static std::string CellText(std::int64_t cell) { return "Cell " + std::to_string(cell); }

  /// The level of a size; -1 when it is no power of two.
  static int LevelOf(int size)
  {
    int level = 0;
    while (level < 30 && 1 << level < size)
    {
      ++level;
    }
    return 1 << level == size ? level : -1;
  }

  static constexpr double Rounder = 6755399441055744.0; ///< 1.5 * 2^52

  /// Rounded to a whole number, which takes a function call on processors without SSE4.
  static double Rounded(double exact) { return (exact + Rounder) - Rounder; }

  /// The quick way for a cell whose points have two coordinates along each axis, without rounding.
  /// @return false when it is none, or does not fit
  bool PlaceBox(std::int64_t cell, LatticeCell& placed) const
  {
    Real corners[3][8];
    for (int i = 0; i < 8; ++i)
    {
      const Real* point = this->Points + 3 * static_cast<std::int64_t>(this->Ids[8 * cell + i]);
      for (int axis = 0; axis < 3; ++axis)
      {
        corners[axis][i] = point[axis];
      }
    }
    bool fits = true;
    std::uint8_t places[8] = {};
    glm::ivec3 size;
    for (int axis = 0; axis < 3; ++axis)
    {
      const Real* const x = corners[axis];
      const Real low = std::min(std::min(std::min(x[0], x[6]), std::min(x[1], x[7])),
        std::min(std::min(x[2], x[4]), std::min(x[3], x[5])));
      const Real high = std::max(std::max(std::max(x[0], x[6]), std::max(x[1], x[7])),
        std::max(std::max(x[2], x[4]), std::max(x[3], x[5])));
      for (int i = 0; i < 8; ++i)
      {
        fits &= (x[i] == low) | (x[i] == high);
        places[i] = static_cast<std::uint8_t>(places[i] | (x[i] == high ? 1u << axis : 0u));
      }
      const double begin = (low - this->Origin[axis]) * this->PerEdge[axis];
      const double end = (high - this->Origin[axis]) * this->PerEdge[axis];
      fits &= std::abs(begin - Rounded(begin)) <= this->Allowed[axis];
      fits &= std::abs(end - Rounded(end)) <= this->Allowed[axis];
      placed.Corner[axis] = static_cast<int>(Rounded(begin));
      size[axis] = static_cast<int>(Rounded(end)) - placed.Corner[axis];
    }
    unsigned seen = 0;
    for (std::size_t i = 0; i < 8; ++i)
    {
      placed.Order[i] = places[i];
      seen |= 1u << places[i];
    }
    placed.Level = LevelOf(size.x);
    const int within = placed.Corner.x | placed.Corner.y | placed.Corner.z;
    return fits && seen == 0xff && size.x == size.y && size.x == size.z && placed.Level >= 0 &&
           (within & (size.x - 1)) == 0;
  }

  /// Any cell; says what does not fit.
  std::string PlaceClosely(std::int64_t cell, LatticeCell& placed) const
  {
    glm::ivec3 corners[8];
    for (int i = 0; i < 8; ++i)
    {
      const Real* point = this->Points + 3 * static_cast<std::int64_t>(this->Ids[8 * cell + i]);
      for (int axis = 0; axis < 3; ++axis)
      {
        const double exact = (point[axis] - this->Origin[axis]) * this->PerEdge[axis];
        const double whole = Rounded(exact);
        if (!(std::abs(exact - whole) <= this->Allowed[axis]))
        {
          return this->Off(cell, i, axis, exact - whole);
        }
        corners[i][axis] = static_cast<int>(whole);
      }
    }
    glm::ivec3 low = corners[0];
    glm::ivec3 high = corners[0];
    for (const glm::ivec3& corner : corners)
    {
      low = glm::min(low, corner);
      high = glm::max(high, corner);
    }
    return this->Fit(cell, corners, low, high, placed);
  }

  std::string Off(std::int64_t cell, int corner, int axis, double off) const
  {
    return CellText(cell) + " is no box of an octree: its point " +
           std::to_string(static_cast<std::int64_t>(this->Ids[8 * cell + corner])) + " lies " +
           std::to_string(std::abs(off)) + " of the finest edge (" +
           std::to_string(this->Tree.Edge()[axis]) +
           ") beside the corners of the other cells along " + "xyz"[axis] + ", and " +
           std::to_string(this->Allowed[axis]) +
           " is allowed: raise 'Mesh Tolerance' (MeshTolerance) if that is rounding";
  }

  std::string Fit(std::int64_t cell, const glm::ivec3 (&corners)[8], const glm::ivec3& low,
    const glm::ivec3& high, LatticeCell& placed) const
  {
    const glm::ivec3 size = high - low;
    placed.Corner = low;
    placed.Level = LevelOf(size.x);
    if (size.y != size.x || size.z != size.x || placed.Level < 0)
    {
      return CellText(cell) + " spans " + Text(size) + " of the finest edges (" +
             Text(this->Tree.Edge()) +
             "); in an octree all cells span the same power of two along all axes";
    }
    unsigned seen = 0;
    for (std::size_t i = 0; i < 8; ++i)
    {
      const glm::ivec3 in = corners[i] - low;
      unsigned place = 0;
      for (int axis = 0; axis < 3; ++axis)
      {
        place |= in[axis] == size.x ? 1u << axis : 0u;
        if (in[axis] != 0 && in[axis] != size.x)
        {
          return CellText(cell) + " is not an axis-aligned box: a point of it lies between its " +
                 "corners along " + "xyz"[axis];
        }
      }
      placed.Order[i] = static_cast<std::uint8_t>(place);
      seen |= 1u << place;
    }
    if (seen != 0xff)
    {
      return CellText(cell) + " has two of its points at one corner, and none at another";
    }
    const int mask = size.x - 1;
    if ((low.x & mask) != 0 || (low.y & mask) != 0 || (low.z & mask) != 0)
    {
      return CellText(cell) + ", which is " + std::to_string(size.x) +
             " finest edges long, begins at " + Text(low) +
             " of them: in an octree cells begin at multiples of their size, seen from cell " +
             std::to_string(this->Tree.CellOfLeaf(0)) + " on, one of the largest";
    }
    return {};
  }

  const ElementOctree& Tree;
  const Real* Points;
  const Id* Ids;
  glm::dvec3 Origin;
  glm::dvec3 PerEdge;
  glm::dvec3 Allowed;
};

} // namespace banyan

#endif
