// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Mesh_Octree_HexMesh_h
#define banyan_Mesh_Octree_HexMesh_h

#include "Base/ScalarType.h"

#include <cstdint>
#include <memory>

namespace banyan
{

/// A mesh of hexahedra in memory, as its owner has it: nothing is copied.
struct HexMesh
{
  const void* Points = nullptr;               ///< x, y, z of each point
  ScalarType PointType = ScalarType::Float32; ///< or Float64
  std::int64_t PointCount = 0;
  /// Eight points of each cell, in any order: an axis-aligned box is the same whatever corner comes
  /// first. `[cell][8]`.
  const void* Connectivity = nullptr;
  ScalarType IdType = ScalarType::Int64; ///< or Int32
  std::int64_t CellCount = 0;
  std::size_t ConnectivityBytes() const
  {
    return 8 * SizeOf(this->IdType) * static_cast<std::size_t>(this->CellCount);
  }
  std::shared_ptr<const void> Owner; ///< keeps the arrays alive; may be empty
  /// Keeps the points alive, if something else than Owner does: ElementOctree lets them go then, as
  /// soon as it does not need them any more.
  std::shared_ptr<const void> PointOwner;
};

/// Calls function(points, ids) with pointers of the types that a mesh has.
/// Throws Error for other types.
template <class Function>
decltype(auto) DispatchMesh(const HexMesh& mesh, Function&& function)
{
  const bool wide = mesh.IdType == ScalarType::Int64;
  if ((!wide && mesh.IdType != ScalarType::Int32) ||
      (mesh.PointType != ScalarType::Float32 && mesh.PointType != ScalarType::Float64))
  {
    throw Error("A mesh has points of float32 or float64 and ids of int32 or int64");
  }
  const auto with = [&](auto* points)
  {
    return wide ? function(points, static_cast<const std::int64_t*>(mesh.Connectivity))
                : function(points, static_cast<const std::int32_t*>(mesh.Connectivity));
  };
  return mesh.PointType == ScalarType::Float32 ? with(static_cast<const float*>(mesh.Points))
                                               : with(static_cast<const double*>(mesh.Points));
}

} // namespace banyan

#endif
