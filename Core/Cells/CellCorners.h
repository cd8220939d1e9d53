// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_CellCorners_h
#define banyan_Cells_CellCorners_h

#include "Cells/CellMesh.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace banyan
{

/// Where the corners of a cell are, as many as CornersOf tells.
using CellPlaces = std::array<glm::dvec3, 8>;

/// Reads where the corners of cells are: quicker than CellMesh::Point where many are read, because
/// the type of coordinates is known.
/// @tparam Real the type of the mesh's coordinates
template <class Real>
class CornerReader
{
public:
  explicit CornerReader(const CellMesh& mesh)
    : Mesh(mesh)
    , Points(static_cast<const Real*>(mesh.Points))
  {
  }

  /// @param is the cell with this number; its points are in range
  CellPlaces At(std::int64_t cell, const MeshCell& is) const
  {
    CellPlaces places{};
    if (this->Mesh.Is == CellMesh::Kind::Rectilinear)
    {
      this->ReadBox(cell, places);
      return places;
    }
    const auto corners = static_cast<std::size_t>(CornersOf(is.Shape));
    for (std::size_t i = 0; i < corners; ++i)
    {
      const Real* const p = this->Points + 3 * is.Points[i];
      places[i] = glm::dvec3(p[0], p[1], p[2]);
    }
    return places;
  }

private:
  void ReadBox(std::int64_t cell, CellPlaces& places) const
  {
    const std::int64_t row = this->Mesh.Size.x - 1;
    const std::int64_t rows = this->Mesh.Size.y - 1;
    const std::array<std::int64_t, 3> first{ cell % row, cell / row % rows, cell / row / rows };
    std::array<std::array<double, 2>, 3> sides{};
    for (std::size_t axis = 0; axis < 3; ++axis)
    {
      const Real* const values = static_cast<const Real*>(this->Mesh.Axes[axis]) + first[axis];
      sides[axis] = { static_cast<double>(values[0]), static_cast<double>(values[1]) };
    }
    for (std::size_t i = 0; i < 8; ++i)
    {
      places[i] = { sides[0][i & 1], sides[1][i >> 1 & 1], sides[2][i >> 2] };
    }
  }

  const CellMesh& Mesh;
  const Real* Points;
};

/// Calls function(reader) with the CornerReader of a mesh.
template <class Function>
decltype(auto) WithCorners(const CellMesh& mesh, Function&& function)
{
  return mesh.PointType == ScalarType::Float32 ? function(CornerReader<float>(mesh))
                                               : function(CornerReader<double>(mesh));
}

} // namespace banyan

#endif
