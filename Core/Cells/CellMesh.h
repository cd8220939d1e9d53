// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_CellMesh_h
#define banyan_Cells_CellMesh_h

#include "Base/ScalarType.h"
#include "Cells/CellShape.h"

#include <glm/vec3.hpp>

#include <array>
#include <cstdint>
#include <memory>

namespace banyan
{

/// One cell: its shape, and the numbers of its corners.
struct MeshCell
{
  CellShape Shape = CellShape::None;
  std::array<std::int64_t, 8> Points{};
};

/// A mesh of cells in memory, as its owner has it: nothing is copied. It is one of three kinds:
///   - Cells: points, and cells that name them, of any shapes mixed;
///   - Curvilinear: points on a grid, x fastest; cells are hexahedra between them;
///   - Rectilinear: coordinates along three axes; cells are boxes.
struct CellMesh
{
  enum class Kind : std::uint8_t
  {
    Cells,
    Curvilinear,
    Rectilinear
  };

  Kind Is = Kind::Cells;

  // Cells and Curvilinear.
  const void* Points = nullptr;               ///< x, y, z of each point
  ScalarType PointType = ScalarType::Float32; ///< or Float64; of Axes as well
  std::int64_t PointCount = 0;                ///< of all kinds

  // Cells.
  const void* Connectivity = nullptr; ///< numbers of points, cell after cell
  std::int64_t ConnectivityCount = 0; ///< how many these are
  const void* Offsets = nullptr;      ///< where cells begin in Connectivity, and one more; may be
                                      ///< null where all cells have as many points as PerCell
  ScalarType IdType = ScalarType::Int64; ///< of both, or Int32
  const std::uint8_t* Types = nullptr;   ///< of cells, as VTK numbers them
  int PerCell = 0;                       ///< points of each cell where Offsets is null
  std::int64_t CellCount = 0;            ///< of all kinds

  // Curvilinear and Rectilinear.
  glm::ivec3 Size{ 0 };              ///< points along each axis, at least 2
  std::array<const void*, 3> Axes{}; ///< Rectilinear: coordinates

  const std::uint8_t* Hidden = nullptr; ///< not 0 for cells that are not drawn; null for none
  std::shared_ptr<const void> Owner;    ///< keeps the arrays alive; may be empty

  /// The shape of a type of VTK.
  static CellShape ShapeOf(std::uint8_t type);

  /// Where a cell of Kind::Cells begins and ends in Connectivity, as the arrays say: see CheckMesh.
  struct Listed
  {
    std::int64_t Begin;
    std::int64_t End;
  };
  Listed ListOf(std::int64_t cell) const;

  /// A cell; its shape is None when it is hidden, or of a type that is not drawn. Points may be out
  /// of range: see CheckMesh.
  MeshCell Cell(std::int64_t cell) const;

  glm::dvec3 Point(std::int64_t point) const;

  /// Ask the caches for what Cell and Point will need. The place of a cell is where its numbers of
  /// points begin: it is wanted sooner.
  void PrefetchPlace(std::int64_t cell) const;
  void PrefetchCell(std::int64_t cell) const;
  void PrefetchPoint(std::int64_t point) const;

private:
  template <class Id>
  MeshCell CellOf(std::int64_t cell, const Id* connectivity, const Id* offsets) const;
  MeshCell CellOfGrid(std::int64_t cell) const;
};

inline CellShape CellMesh::ShapeOf(std::uint8_t type)
{
  switch (type)
  {
    case 10:
      return CellShape::Tetrahedron;
    case 11: // voxel
    case 12:
      return CellShape::Hexahedron;
    case 13:
      return CellShape::Wedge;
    case 14:
      return CellShape::Pyramid;
    default:
      return CellShape::None;
  }
}

inline CellMesh::Listed CellMesh::ListOf(std::int64_t cell) const
{
  if (!this->Offsets)
  {
    return { cell * this->PerCell, (cell + 1) * this->PerCell };
  }
  const auto at = [this](std::int64_t i)
  {
    return this->IdType == ScalarType::Int64 ? static_cast<const std::int64_t*>(this->Offsets)[i]
                                             : static_cast<const std::int32_t*>(this->Offsets)[i];
  };
  return { at(cell), at(cell + 1) };
}

template <class Id>
inline MeshCell CellMesh::CellOf(std::int64_t cell, const Id* connectivity, const Id* offsets) const
{
  // From x fastest to around each face.
  static constexpr std::array<int, 8> hexahedron{ 0, 1, 3, 2, 4, 5, 7, 6 };
  MeshCell result;
  const std::uint8_t type = this->Types[cell];
  const std::int64_t begin =
    offsets ? static_cast<std::int64_t>(offsets[cell]) : cell * this->PerCell;
  const std::int64_t count =
    offsets ? static_cast<std::int64_t>(offsets[cell + 1]) - begin : this->PerCell;
  const CellShape shape = ShapeOf(type);
  const int corners = CornersOf(shape);
  if (count != corners)
  {
    return result;
  }
  result.Shape = shape;
  for (int i = 0; i < corners; ++i)
  {
    const auto to = static_cast<std::size_t>(i);
    const int from = type == 12 ? hexahedron[to] : i;
    result.Points[to] = static_cast<std::int64_t>(connectivity[begin + from]);
  }
  return result;
}

inline MeshCell CellMesh::CellOfGrid(std::int64_t cell) const
{
  const std::int64_t nx = this->Size.x;
  const std::int64_t row = nx - 1;
  const std::int64_t rows = this->Size.y - 1;
  const std::int64_t x = cell % row;
  const std::int64_t y = cell / row % rows;
  const std::int64_t z = cell / row / rows;
  const std::int64_t first = x + nx * (y + this->Size.y * z);
  const std::int64_t slice = nx * this->Size.y;
  return { CellShape::Hexahedron,
    { first, first + 1, first + nx, first + nx + 1, first + slice, first + slice + 1,
      first + slice + nx, first + slice + nx + 1 } };
}

inline MeshCell CellMesh::Cell(std::int64_t cell) const
{
  if (this->Hidden && this->Hidden[cell] != 0)
  {
    return {};
  }
  if (this->Is != Kind::Cells)
  {
    return this->CellOfGrid(cell);
  }
  return this->IdType == ScalarType::Int64
           ? this->CellOf(cell, static_cast<const std::int64_t*>(this->Connectivity),
               static_cast<const std::int64_t*>(this->Offsets))
           : this->CellOf(cell, static_cast<const std::int32_t*>(this->Connectivity),
               static_cast<const std::int32_t*>(this->Offsets));
}

inline glm::dvec3 CellMesh::Point(std::int64_t point) const
{
  const auto at = [this](const void* values, std::int64_t i) -> double
  {
    return this->PointType == ScalarType::Float32
             ? static_cast<double>(static_cast<const float*>(values)[i])
             : static_cast<const double*>(values)[i];
  };
  if (this->Is == Kind::Rectilinear)
  {
    const std::int64_t x = point % this->Size.x;
    const std::int64_t y = point / this->Size.x % this->Size.y;
    const std::int64_t z = point / this->Size.x / this->Size.y;
    return { at(this->Axes[0], x), at(this->Axes[1], y), at(this->Axes[2], z) };
  }
  return { at(this->Points, 3 * point), at(this->Points, 3 * point + 1),
    at(this->Points, 3 * point + 2) };
}

inline void CellMesh::PrefetchPlace(std::int64_t cell) const
{
  if (this->Is == Kind::Cells)
  {
    const auto size = static_cast<std::int64_t>(SizeOf(this->IdType));
    __builtin_prefetch(this->Types + cell);
    if (this->Offsets)
    {
      __builtin_prefetch(static_cast<const char*>(this->Offsets) + cell * size);
    }
  }
}

inline void CellMesh::PrefetchCell(std::int64_t cell) const
{
  if (this->Is == Kind::Cells)
  {
    const auto* const ids = static_cast<const char*>(this->Connectivity);
    const auto size = static_cast<std::int64_t>(SizeOf(this->IdType));
    if (!this->Offsets)
    {
      __builtin_prefetch(ids + cell * this->PerCell * size);
      return;
    }
    const auto* const offsets = static_cast<const char*>(this->Offsets) + cell * size;
    const std::int64_t first = this->IdType == ScalarType::Int64
                                 ? *reinterpret_cast<const std::int64_t*>(offsets)
                                 : *reinterpret_cast<const std::int32_t*>(offsets);
    __builtin_prefetch(ids + first * size);
  }
}

inline void CellMesh::PrefetchPoint(std::int64_t point) const
{
  if (this->Is != Kind::Rectilinear)
  {
    const auto size = static_cast<std::int64_t>(SizeOf(this->PointType));
    __builtin_prefetch(static_cast<const char*>(this->Points) + 3 * point * size);
  }
}

} // namespace banyan

#endif
