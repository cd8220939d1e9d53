// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_CellLattice_h
#define banyan_Cells_CellLattice_h

#include "Cells/CheckMesh.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <limits>

namespace banyan
{

class ThreadPool;

/// What the lattice of a mesh follows from. That of several pieces, in any order, is that of the
/// whole mesh. Takes 8 kB.
struct CellExtent
{
  static constexpr int LowestExponent = -511;

  /// The box around all corners of drawn cells; upside down where there are none.
  glm::dvec3 Low{ std::numeric_limits<double>::infinity() };
  glm::dvec3 High{ -std::numeric_limits<double>::infinity() };

  /// How many edges of drawn cells have which power of two next to their length, by the ratio of
  /// the two; from 2^LowestExponent on. An edge counts in each of its cells; those whose ends
  /// coincide do not count.
  std::array<std::int64_t, 1024> Edges{};

  void Include(const CellExtent& other);
};

CellExtent ExtentOf(const CellMesh& mesh, const CellFacts& facts, ThreadPool& pool);

/// The index space of a mesh of cells: affine, without rotation, a cell wide where cells are of the
/// common size.
struct CellLattice
{
  static constexpr int MostEdges = 1 << 20;

  glm::dvec3 Origin{ 0.0 }; ///< a multiple of Edge, at the low corner of the mesh or below
  double Edge = 1.0;        ///< a power of two, in units of the world
  glm::ivec3 Size{ 1 };     ///< edges to the other corner, 1 to MostEdges: all points are between

  /// The place on the lattice of one in the world.
  glm::dvec3 ToLattice(const glm::dvec3& world) const
  {
    return (world - this->Origin) / this->Edge; // exact but for the difference
  }
  glm::dvec3 ToWorld(const glm::dvec3& lattice) const
  {
    return this->Origin + lattice * this->Edge;
  }
};

/// The lattice whose edge is the power of two next to the median length of all edges, doubled as
/// long as the mesh is more than MostEdges across. Throws Error where no cell is drawn.
CellLattice LatticeOf(const CellExtent& extent);

} // namespace banyan

#endif
