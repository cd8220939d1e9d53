// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Rendering_FieldPiece_h
#define banyan_Rendering_FieldPiece_h

#include "Mesh/Sampling/MeshOptions.h"

#include "Mesh/Octree/CellNodes.h"
#include "Render/Bricks/TemporalEnhancement.h"

#include <string>

class vtkDataArray;
class vtkDataObject;
class vtkImageData;
class vtkUnstructuredGrid;

namespace banyan
{

/// This rank's part of a field of scalars.
struct FieldPiece
{
  vtkImageData* Image = nullptr;       ///< null on ranks without data
  vtkUnstructuredGrid* Grid = nullptr; ///< in place of Image: hexahedra
  vtkDataObject* Leaves = nullptr;     ///< in place of both: vtkHyperTreeGrid or vtkOverlappingAMR
  vtkDataArray* Array = nullptr;       ///< of Image or Grid
  std::string ArrayName;               ///< of Leaves
  ValuesOn Where = ValuesOn::Points;   ///< points of Image; points or cells of Grid or Leaves
  int Component = 0;                   ///< -1: Euclidean norm of all components
  MeshOptions Mesh;                    ///< of Grid and Leaves; the same on all ranks
  /// Of pieces of an encoded series, as they are drawn; plain ones have it already. The same on all
  /// ranks. Off where Strength is 0.
  TemporalEnhancement Enhancement{ 0.0, 1.0, 0.0 };
  std::string Problem; ///< why this rank's data cannot be drawn; empty if it can
};

} // namespace banyan

#endif
