// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_MeshSurvey_h
#define banyan_Mesh_Octree_MeshSurvey_h

#include "Mesh/Octree/HexMesh.h"

#include <glm/vec3.hpp>

#include <vector>

namespace banyan
{

class ThreadPool;

/// Holds what a first look at all cells of a mesh finds.
struct MeshSurvey
{
  glm::dvec3 Shortest{ 0.0 };   ///< edge of a cell along each axis
  std::int64_t LongestCell = 0; ///< one of those with the longest edge along x
  double LongestEdge = 0.0;     ///< of it, along x
  glm::dvec3 Largest{ 0.0 };    ///< absolute value of a coordinate
  /// Whether all coordinates are numbers of float32, whatever type they are stored as.
  bool AllFloat = true;
  bool StoredAsFloat = false;
  /// Different coordinates of the cells' faces along each axis, in ascending order.
  std::vector<double> Planes[3];
};

/// Throws Error for the first cell that is none: with points that do not exist or are not finite,
/// without extent, or far from an axis-aligned box; and for meshes without cells or with more than
/// 2^32 - 2 of them.
MeshSurvey SurveyMesh(const HexMesh& mesh, ThreadPool& pool);

/// Where the planes x = Origin + i * Edge of a lattice lie along one axis.
struct LatticeAxis
{
  double Origin = 0.0;
  double Edge = 1.0;
  /// How far a coordinate may lie from a plane of the lattice to be taken for it: a part of the
  /// finest edge that is asked for, or twice the distance of neighbouring numbers of the
  /// coordinates' type if that is more: what rounding explains.
  double Tolerance = 0.0;
};

/// The lattice that the faces of the cells lie on along an axis. Steps between neighbouring planes
/// are counted from the shortest to the longest, each with the edge that those before it have on
/// average: rounded coordinates then add up to no wrong count in large meshes.
/// @param tolerance in finest edges
/// Throws Error when coordinates are rounded to more than a sixteenth of an edge.
LatticeAxis FindLattice(const MeshSurvey& survey, int axis, double tolerance);

} // namespace banyan

#endif
