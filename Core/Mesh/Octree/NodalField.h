// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_NodalField_h
#define banyan_Mesh_Octree_NodalField_h

#include "Mesh/Octree/ElementOctree.h"

#include <glm/vec3.hpp>

#include <vector>

namespace banyan
{

class ThreadPool;

/// Whether float32 holds all values of a type.
bool FitsFloat(ScalarType type);

/// Values at the points of a mesh, or of its cells.
struct NodeArray
{
  static constexpr int Magnitude = -1;

  const void* Values = nullptr; ///< `[point or cell][component]`
  ScalarType Type = ScalarType::Float32;
  int Components = 1;
  int Component = 0; ///< in [0, Components), or Magnitude: the Euclidean length of all
};

/// A field that is trilinear in each element and continuous everywhere: points that hang take the
/// value that the largest element around has there, whatever the array says, and of points at one
/// place the first one counts.
///
/// Exact in the corners of elements; in between within rounding of double precision.
class NodalField
{
public:
  /// Copies the values (4 bytes per point, 8 for types that float32 cannot hold), which is all that
  /// new values take: the octree stays as it is.
  /// Throws Error when the array has no such component.
  NodalField(std::shared_ptr<const ElementOctree> tree, const NodeArray& array, ThreadPool& pool);

  /// The field of a coarser mesh: values at points that do not hang there are those of this one.
  /// @param nodeOfPoint see HexBricks::Level
  NodalField(std::shared_ptr<const ElementOctree> coarser, const NodalField& finer,
    const HeldArray<std::uint32_t>& nodeOfPoint);

  /// A field of values that are continuous already (MakeContinuous), which are not copied.
  /// @param values one per point of the mesh, float32 or float64
  /// @param owner keeps them
  NodalField(std::shared_ptr<const ElementOctree> tree, const NodeArray& values,
    const std::shared_ptr<const void>& owner);

  /// Does in place what other constructors do with their copy.
  /// @param values one per point of the mesh, float32 or float64: those of points that hang, and of
  /// all but the first one at a place, are replaced
  static void MakeContinuous(const ElementOctree& tree, void* values, ScalarType type);

  const ElementOctree& Tree() const { return *this->Octree; }

  /// Float32, or Float64 where float32 cannot hold the values.
  ScalarType Type() const
  {
    return this->Floats.empty() ? ScalarType::Float64 : ScalarType::Float32;
  }

  double AtNode(std::int64_t node) const
  {
    const auto i = static_cast<std::size_t>(node);
    return this->Floats.empty() ? this->Doubles[i] : double{ this->Floats[i] };
  }

  /// One per point of the mesh.
  const void* Values() const
  {
    return this->Floats.empty() ? static_cast<const void*>(this->Doubles.data())
                                : static_cast<const void*>(this->Floats.data());
  }
  std::size_t Bytes() const { return this->Floats.Bytes() + this->Doubles.Bytes(); }

  /// At the eight corners of a leaf, x fastest.
  void CornersOf(std::int64_t leaf, double (&values)[8]) const;

  /// Calls function(leaf, values) for leaves that follow one another, with the values of CornersOf.
  template <class Function>
  void ForCorners(std::int64_t first, std::int64_t end, const Function& function) const
  {
    // So many steps take about as long as a read from memory.
    constexpr std::int64_t ahead = 12;
    const auto each = [&](const auto& from)
    {
      std::int64_t nodes[8];
      double values[8];
      for (std::int64_t leaf = first; leaf < end; ++leaf)
      {
        this->Octree->PrefetchLeaf(leaf + ahead);
        this->Octree->NodesOfLeaf(leaf, nodes);
        for (int corner = 0; corner < 8; ++corner)
        {
          values[corner] = static_cast<double>(from[static_cast<std::size_t>(nodes[corner])]);
        }
        function(leaf, values);
      }
    };
    this->Floats.empty() ? each(this->Doubles) : each(this->Floats);
  }

  /// The trilinear interpolant of eight corners.
  /// @param part from 0 to 1 along each axis
  static double Interpolate(const double (&corners)[8], const glm::dvec3& part);

  /// At a point of the lattice; NaN where no element touches it.
  double AtPoint(const glm::ivec3& point) const;

private:
  template <class Out>
  std::vector<Out> Taken(const NodeArray& array, ThreadPool& pool) const;

  std::shared_ptr<const ElementOctree> Octree;
  HeldArray<float> Floats;
  HeldArray<double> Doubles;
};

} // namespace banyan

#endif
