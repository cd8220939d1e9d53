// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_Fields_InputOfPiece_h
#define banyan_Inputs_Fields_InputOfPiece_h

#include "BanyanInputsModule.h" // for export macro
#include "Fields/FieldPiece.h"

#include "Parallel/Fields/FieldInput.h"

#include "vtkSmartPointer.h"

#include <memory>

namespace banyan
{

struct LinearParts;

/// A piece of VTK's data as the input of a field.
class BANYANINPUTS_EXPORT InputOfPiece final : public FieldInput
{
public:
  /// @param piece its objects must stay as long as the input is used
  /// @param parts of cells that are not linear: those of the step before, and then of this one;
  /// may be null
  explicit InputOfPiece(FieldPiece piece, std::shared_ptr<const LinearParts>* parts = nullptr);
  ~InputOfPiece() override;

  InputStamp Stamp() const override;
  PieceFacts Facts() const override;
  std::shared_ptr<const SeriesFile> Series() const override;
  TemporalEnhancement Enhancement() const override { return this->Piece.Enhancement; }
  SampleArray Samples(const glm::ivec3& first) const override;
  void HideCells(const glm::ivec3& first, HiddenCells& hidden) const override;
  double MeshTolerance() const override { return this->Piece.MeshTolerance; }
  bool KeepsCellValues() const override;
  MeshField::Piece Mesh(Communicator& communicator, bool leaves) override;
  CellsField::Piece Cells() override;

private:
  FieldPiece Piece;
  std::shared_ptr<const LinearParts>* Parts;
  vtkSmartPointer<vtkUnstructuredGrid> Voxels; ///< of leaves
  vtkSmartPointer<vtkDataArray> Values;        ///< of the mesh
};

} // namespace banyan

#endif
