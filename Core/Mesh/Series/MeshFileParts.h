// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Series_MeshFileParts_h
#define banyan_Mesh_Series_MeshFileParts_h

#include "Mesh/Series/StoredMesh.h"

#include <cmath>
#include <cstring>
#include <limits>

// Holds what writing and reading the file of a mesh have in common.
namespace banyan::mesh_file
{

constexpr char MeshMagic[8] = { 'B', 'a', 'n', 'y', 'a', 'n', 'M', 'e' };
constexpr std::uint32_t Version = 1;

enum Section
{
  Head,
  Boxes,
  Gaps,         ///< between leaves
  Levels,       ///< of leaves
  Cells,        ///< of leaves; empty: in order
  Types,        ///< of cells in the order of leaves; empty: hexahedra
  Orders,       ///< of corners that occur
  OrderOfLeaf,  ///< empty: all have the first one
  Choices,      ///< among points at one place; empty: no two points have one place
  PointNumbers, ///< of nodes; empty: in order
  Planes,       ///< coordinates of the lattice's planes
  Offsets,      ///< of nodes from them; empty: none
  LoosePoints,  ///< coordinates of points of no cell
  Sections
};

constexpr std::uint8_t Hexahedron = 12;

/// Coordinates as whole numbers that grow with them, so that neighbouring numbers differ by 1.
template <class Real>
std::int64_t Ordered(Real value)
{
  if constexpr (sizeof(Real) == 4)
  {
    const auto bits = BitCast<std::int32_t>(value);
    return bits < 0 ? std::numeric_limits<std::int32_t>::min() - std::int64_t{ bits } - 1 : bits;
  }
  else
  {
    const auto bits = BitCast<std::int64_t>(value);
    return bits < 0 ? std::numeric_limits<std::int64_t>::min() - bits - 1 : bits;
  }
}

/// Inverse of Ordered; whatever the number is.
template <class Real>
Real FromOrdered(std::int64_t number)
{
  if constexpr (sizeof(Real) == 4)
  {
    const auto n = static_cast<std::int32_t>(number);
    return BitCast<float>(
      n < 0 ? static_cast<std::int32_t>(std::numeric_limits<std::int32_t>::min() - (n + 1)) : n);
  }
  else
  {
    return BitCast<double>(
      number < 0 ? std::numeric_limits<std::int64_t>::min() - (number + 1) : number);
  }
}

/// Where a plane of the lattice is expected.
template <class Real>
std::int64_t ExpectedPlane(const StoredMesh& mesh, int axis, std::int64_t plane)
{
  const double at = mesh.Origin[axis] + static_cast<double>(plane) * mesh.Edge[axis];
  return Ordered(static_cast<Real>(at));
}

/// a - b and its inverse, modulo 2^64.
inline std::int64_t Less(std::int64_t a, std::int64_t b)
{
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) - static_cast<std::uint64_t>(b));
}
inline std::int64_t Plus(std::int64_t a, std::int64_t b)
{
  return static_cast<std::int64_t>(static_cast<std::uint64_t>(a) + static_cast<std::uint64_t>(b));
}

/// A corner of a leaf on the lattice, in finest cells.
inline glm::ivec3 CornerOnLattice(const OctreeLeaves& leaves, std::size_t leaf, std::size_t corner)
{
  const int c = static_cast<int>(corner);
  return PositionOfKey(leaves.Keys[leaf]) +
         (glm::ivec3{ c & 1, c >> 1 & 1, c >> 2 } << int{ leaves.Levels[leaf] });
}

/// Calls body(node, position on the lattice) for each node, in order.
template <class Body>
void ForEachNode(
  const StoredMesh& mesh, const std::vector<std::uint32_t>& nodeOfPoint, const Body& body)
{
  std::uint32_t next = 0;
  for (std::size_t leaf = 0; leaf < mesh.Leaves.Keys.size(); ++leaf)
  {
    for (std::size_t corner = 0; corner < 8; ++corner)
    {
      if (nodeOfPoint[static_cast<std::size_t>(mesh.PointAt(leaf, corner))] == next)
      {
        body(next++, CornerOnLattice(mesh.Leaves, leaf, corner));
      }
    }
  }
}

} // namespace banyan::mesh_file

#endif
