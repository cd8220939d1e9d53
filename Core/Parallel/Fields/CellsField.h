// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_CellsField_h
#define banyan_Parallel_Fields_CellsField_h

#include "Base/Hash.h"
#include "Mesh/Cells/CellArray.h"
#include "Parallel/Fields/DrawnField.h"
#include "Render/Cells/CellSource.h"

#include <memory>
#include <string>

namespace banyan
{

/// A field on any mesh of cells that lies in pieces on the ranks, drawn cell by cell. Cells are put
/// in order, and the border is found, once per mesh; new values touch values only. Cells stay on
/// their ranks: see DrawPieces.
class CellsField final : public DrawnField
{
public:
  /// This rank's part. Its mesh must stay until the next one is taken; values belong to the caller,
  /// until Take returns.
  struct Piece
  {
    CellMesh Mesh;    ///< without cells on ranks that have none
    NodeArray Values; ///< of its points or cells; anything on ranks without cells
    ValuesOn Where = ValuesOn::Points;
    bool KeepsCellValues = false; ///< FieldInput::KeepsCellValues
    std::string OtherCells;       ///< that are left out, as a user reads it; empty if none
  };

  /// Collective: whether the mesh on all ranks is the one that was taken last. Take the pieces
  /// then.
  bool Has(Communicator& communicator, const CellMesh& piece);

  /// Collective: takes the pieces of all ranks.
  /// @param has what Has said of them
  /// Throws CollectiveError when one rank cannot draw or read the mesh.
  void Take(Communicator& communicator, Piece piece, bool has);

  /// Of the last Take.
  FieldPlace Place() const;

  void Clear() override { this->Drawn.reset(); }
  BrickSource* Source() override { return this->Drawn.get(); }
  CellSource* PieceOfCells() const override { return this->Drawn.get(); }
  const std::vector<Box>& Zones() const override { return this->ZoneCells; }
  std::vector<Hash128> VisibleContent(const RayScene& scene) override;
  bool IsMesh() const override { return true; }
  /// Level 1 has places half as far apart as points are.
  int LeastCells() const override { return 16; }
  std::string Note() const override { return this->NoteText; }
  MeshBytes Bytes() const override;

private:
  void TakeMesh(Communicator& communicator, const Piece& piece);
  void TakeMeans(Communicator& communicator, CellField& field) const;
  Hash128 HashOfAll(Communicator& communicator, const Hash128& values) const;

  std::shared_ptr<const DrawnCells> Cells; ///< of the piece; null when the mesh cannot be drawn
  Hash128 PieceHash;                       ///< of this rank's points and cells
  std::string NoteText;
  std::unique_ptr<CellSource> Drawn;
  Hash128 Content; ///< of points, cells and values of all ranks
  std::vector<Box> ZoneCells;
};

} // namespace banyan

#endif
