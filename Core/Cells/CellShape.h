// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Cells_CellShape_h
#define banyan_Cells_CellShape_h

#include <array>
#include <cstdint>

namespace banyan
{

/// The shapes of cells that are drawn. Corners stand as VTK has them, but for hexahedra, whose
/// corners stand x fastest, as those of VTK_VOXEL.
enum class CellShape : std::uint8_t
{
  None, ///< not drawn: points, lines, faces, and what is not known
  Tetrahedron,
  Pyramid, ///< four corners of the base, then the apex
  Wedge,   ///< three corners of a triangle, then three of the other one
  Hexahedron
};

/// How many corners cells of a shape have.
constexpr int CornersOf(CellShape shape)
{
  switch (shape)
  {
    case CellShape::Tetrahedron:
      return 4;
    case CellShape::Pyramid:
      return 5;
    case CellShape::Wedge:
      return 6;
    case CellShape::Hexahedron:
      return 8;
    default:
      return 0;
  }
}

/// A face: three or four corners of the cell, one after the other around it. Seen from outside of a
/// cell that is not mirrored they go round against the clock.
struct CellFace
{
  int Count = 0;
  std::array<int, 4> Corners{};
};

/// The faces of a shape: Count of them.
struct CellFaces
{
  int Count = 0;
  std::array<CellFace, 6> Faces{};
};

namespace cell_faces
{

inline constexpr CellFaces None{};
inline constexpr CellFaces Tetrahedron{ 4,
  { { { 3, { 0, 2, 1 } }, { 3, { 0, 1, 3 } }, { 3, { 1, 2, 3 } }, { 3, { 2, 0, 3 } } } } };
inline constexpr CellFaces Pyramid{ 5,
  { { { 4, { 0, 3, 2, 1 } }, { 3, { 0, 1, 4 } }, { 3, { 1, 2, 4 } }, { 3, { 2, 3, 4 } },
    { 3, { 3, 0, 4 } } } } };
// The first triangle of VTK_WEDGE looks away from the second one.
inline constexpr CellFaces Wedge{ 5,
  { { { 3, { 0, 1, 2 } }, { 3, { 3, 5, 4 } }, { 4, { 0, 3, 4, 1 } }, { 4, { 1, 4, 5, 2 } },
    { 4, { 2, 5, 3, 0 } } } } };
inline constexpr CellFaces Hexahedron{ 6,
  { { { 4, { 0, 4, 6, 2 } }, { 4, { 1, 3, 7, 5 } }, { 4, { 0, 1, 5, 4 } }, { 4, { 2, 6, 7, 3 } },
    { 4, { 0, 2, 3, 1 } }, { 4, { 4, 5, 7, 6 } } } } };

} // namespace cell_faces

constexpr const CellFaces& FacesOf(CellShape shape)
{
  switch (shape)
  {
    case CellShape::Tetrahedron:
      return cell_faces::Tetrahedron;
    case CellShape::Pyramid:
      return cell_faces::Pyramid;
    case CellShape::Wedge:
      return cell_faces::Wedge;
    case CellShape::Hexahedron:
      return cell_faces::Hexahedron;
    default:
      return cell_faces::None;
  }
}

} // namespace banyan

#endif
