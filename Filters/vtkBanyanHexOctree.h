/**
 * @class   vtkBanyanHexOctree
 * @brief   finds the octree that the cells of an unstructured grid are the leaves of, or those of
 * hyper trees or AMR
 *
 * Use it to see whether a mesh of axis-aligned hexahedra or voxels is an octree, as "Banyan Volume"
 * needs it, and how it is made. Hyper tree grids and
 * overlapping AMR become grids of their visible leaves. The grid passes unchanged (by reference),
 * with
 * - the cell array `octree_level`: 0 for the smallest cells, one more for each doubling,
 * - the point array `hanging`: 1 for points that lie inside a face or an edge of a larger cell,
 * - the field array `octree` with a number in each component: origin and finest edge of the lattice
 * (3 each), the coarsest level, finest cells that no cell covers, points that hang, points that
 * hang where neighbours differ by more than one level, points that have the place of another one.
 *
 * A mesh that is no octree is an error, whose message names the first cell that does not fit, and
 * why.
 *
 * @par Source: section 4 of "Visualizing Very Large-Scale Earthquake Simulations".
 * @par Limits: each piece is looked at by itself, but blocks of AMR hide cells of other ranks: with
 * AMR it is collective over the global controller; of ghost cells the level is -1.
 */
#ifndef vtkBanyanHexOctree_h
#define vtkBanyanHexOctree_h

#include "BanyanFiltersModule.h" // For export macro
#include "vtkUnstructuredGridAlgorithm.h"

class BANYANFILTERS_EXPORT vtkBanyanHexOctree : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkBanyanHexOctree* New();
  vtkTypeMacro(vtkBanyanHexOctree, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// How far a point may lie beside the lattice, in edges of the smallest cell. Default 1/1024;
  /// allowed [0, 1/16].
  vtkSetClampMacro(MeshTolerance, double, 0.0, 0.0625);
  vtkGetMacro(MeshTolerance, double);
  ///@}

protected:
  vtkBanyanHexOctree() = default;
  ~vtkBanyanHexOctree() override = default;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  double MeshTolerance = 1.0 / 1024;

  vtkBanyanHexOctree(const vtkBanyanHexOctree&) = delete;
  void operator=(const vtkBanyanHexOctree&) = delete;
};

#endif
