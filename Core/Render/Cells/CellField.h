// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_CellField_h
#define banyan_Render_Cells_CellField_h

#include "Cells/BorderFaces.h"
#include "Cells/CellLattice.h"
#include "Cells/CellMesh.h"
#include "Cells/CheckMesh.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

namespace banyan
{

class ThreadPool;

/// A mesh as it is drawn: found once for its points and cells, whatever the values.
struct DrawnCells
{
  CellMesh Mesh;
  CellLattice Lattice;
  std::vector<std::uint32_t> Order; ///< numbers of the cells that are drawn, in the global order
  std::vector<BorderFace> Border;   ///< faces that one cell of them has alone
  /// By place in the order: which faces of a cell end the mesh, a bit each. So its samples do not
  /// reach beyond them. Empty where none does.
  std::vector<std::uint8_t> BorderBits;
  glm::dvec3 Low{ 0.0 }; ///< the box around all drawn cells of the whole mesh
  glm::dvec3 High{ 0.0 };
  std::int64_t Count = 0; ///< of these cells

  CellLattice OrderedBy; ///< what the order follows: Lattice without the room around it
  bool IsPiece = false;  ///< whether other ranks may have cells, too
  /// Of a piece of a mesh, by place in the order: which faces of a cell no other cell of the piece
  /// has, a bit each.
  std::vector<std::uint8_t> Alone;

  /// Checks a mesh and finds all that drawing it takes. There is room around the mesh in the index
  /// space, so that rays begin and end outside of it.
  /// @param facts says which cells are left out, and why
  /// Throws Error: see CheckCells and OrderOfCells; and where the points lie apart too far.
  static std::shared_ptr<const DrawnCells> Of(
    const CellMesh& mesh, CellFacts& facts, ThreadPool& pool);

  /// The same for a piece of a mesh, which may be empty. Border has all faces that one cell of the
  /// piece has alone: those which cells of other pieces have, too, are to be taken out. Count has
  /// this piece's cells.
  /// @param facts of this piece; Repeated is set
  /// @param ofAll pieces together
  /// Throws Error where no piece has a cell, and where this one has 2^31.
  static std::shared_ptr<DrawnCells> OfPiece(
    const CellMesh& mesh, CellFacts& facts, const CellExtent& ofAll, ThreadPool& pool);

  void SetBorder(std::vector<BorderFace> border);

  /// Takes points of the mesh to index space.
  glm::dvec3 ToIndex(const glm::dvec3& point) const { return this->Lattice.ToLattice(point); }

  /// Bytes that it takes beside the mesh.
  std::size_t Bytes() const;
};

/// Values on a mesh.
struct CellField
{
  std::shared_ptr<const DrawnCells> Cells;
  std::vector<float> Values; ///< of points, or of cells; without Base
  double Base = 0.0;         ///< was subtracted from values in double
  bool OfCells = false;      ///< one value all over a cell, in place of those of points
  /// Of points, in index space: x, y, z. Empty unless shaded.
  std::vector<float> Gradients;

  /// Values of a cell's corners, or one value for all.
  /// @param number of the cell
  void CornerValues(std::int64_t number, const MeshCell& cell, float (&values)[8]) const
  {
    const int corners = CornersOf(cell.Shape);
    for (int i = 0; i < corners; ++i)
    {
      const std::int64_t from = this->OfCells ? number : cell.Points[static_cast<std::size_t>(i)];
      values[i] = this->Values[static_cast<std::size_t>(from)];
    }
  }
};

} // namespace banyan

#endif
