// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Cells_CellParts_h
#define banyan_Testing_Core_Cells_CellParts_h

#include "Cells/CellMeshes.h"

/// What makers of meshes share.
namespace cellmeshes
{

/// Numbers of VTK.
enum Type : std::uint8_t
{
  Tetrahedron = 10,
  Voxel = 11,
  Hexahedron = 12,
  Wedge = 13,
  Pyramid = 14
};

inline std::size_t Index(std::int64_t i)
{
  return static_cast<std::size_t>(i);
}

inline void AddPoint(OwnedCellMesh& mesh, const glm::dvec3& p)
{
  mesh.Points.insert(mesh.Points.end(), { p.x, p.y, p.z });
}

inline glm::dvec3 PointOf(const OwnedCellMesh& mesh, std::int64_t i)
{
  return mesh.View().Point(i);
}

/// A cell of VTK, corners x fastest.
inline std::vector<std::int64_t> AsVtkHexahedron(const std::array<std::int64_t, 8>& c)
{
  return { c[0], c[1], c[3], c[2], c[4], c[5], c[7], c[6] };
}

} // namespace cellmeshes

#endif
