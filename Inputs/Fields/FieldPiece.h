// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Inputs_Fields_FieldPiece_h
#define banyan_Inputs_Fields_FieldPiece_h

#include "BanyanInputsModule.h" // for export macro
#include "Mesh/Octree/CellNodes.h"
#include "Render/Steps/TemporalEnhancement.h"

#include <string>

class vtkDataArray;
class vtkDataObject;
class vtkDataSet;
class vtkDataSetAttributes;
class vtkImageData;
class vtkUnstructuredGrid;

namespace banyan
{

/// The array that is drawn of some data.
struct DrawnArray
{
  vtkDataArray* Array = nullptr; ///< null if there is none; of blocks: the first one's
  ValuesOn Where = ValuesOn::Points;
};

/// This rank's part of a field of scalars.
struct FieldPiece
{
  vtkImageData* Image = nullptr;       ///< null on ranks without data
  vtkUnstructuredGrid* Grid = nullptr; ///< in place of Image: cells of any shapes
  vtkDataSet* Curved = nullptr;        ///< in place of both: any other grid of cells
  vtkDataObject* Leaves = nullptr;     ///< in place of both: vtkHyperTreeGrid or vtkOverlappingAMR
  vtkDataArray* Array = nullptr;       ///< of Image or Grid
  std::string ArrayName;               ///< of Leaves
  ValuesOn Where = ValuesOn::Points;   ///< points of Image; points or cells of Grid or Leaves
  int Component = 0;          ///< or SampleArray::Magnitude; of an image also SampleArray::Colours
  double MeshTolerance = 0.0; ///< of Grid and Leaves: FieldInput::MeshTolerance
  bool KeepsCellValues = false; ///< of Grid and Curved: FieldInput::KeepsCellValues
  /// Of pieces of an encoded series, as they are drawn; plain ones have it already. The same on all
  /// ranks. Off where Strength is 0.
  TemporalEnhancement Enhancement{ 0.0, 1.0, 0.0 };
  std::string Problem; ///< why this rank's data cannot be drawn; empty if it can

  bool HasData() const { return this->Image || this->Grid || this->Curved || this->Leaves; }
  /// Cells as they are; null for images and leaves.
  vtkDataSet* Cells() const;
};

/// Returns the first array that something may be drawn of: the active scalars, or the first array
/// of numbers that are no flags. Null if there is none.
BANYANINPUTS_EXPORT vtkDataArray* FirstDrawable(vtkDataSetAttributes* attributes);

/// Returns what some data give this rank to draw, without an array: nothing is converted or
/// decoded. Its Problem says when data of the type cannot be drawn.
/// @param data may be null; without cells they are nothing
BANYANINPUTS_EXPORT FieldPiece PieceOfData(vtkDataObject* data);

/// Sets the array of a piece that has data. Its Problem says when the array does not fit.
/// @param drawn of the data
BANYANINPUTS_EXPORT void SetArray(FieldPiece& piece, const DrawnArray& drawn);

/// Bounds of a hyper tree grid or AMR. @return `bounds` itself
BANYANINPUTS_EXPORT double* BoundsOfLeaves(vtkDataObject* data, double* bounds);

} // namespace banyan

#endif
