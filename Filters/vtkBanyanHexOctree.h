// SPDX-License-Identifier: BSD-3-Clause
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
 * why. With SampleGeneralMeshes the output is instead a grid of the boxes that "Banyan Volume"
 * draws of it (see SampledGrid): axis-aligned voxels with values at their points, which the writer
 * of series takes. Finding the boxes shows progress, and ends with an empty output when
 * AbortExecute is set.
 *
 * Blocks of a composite data set are one mesh. Points of blocks at one place become one. Arrays
 * that not all blocks have are left out, with a warning that names them.
 *
 * @par Source: section 4 of "Visualizing Very Large-Scale Earthquake Simulations".
 * @par Limits: it is collective over the global controller. Levels, the lattice and the coarsest
 * level are those of all ranks. For the rest each piece is looked at by itself: points that hang on
 * cells of other ranks do not count, nor do cells that overlap those of others. With
 * SampleGeneralMeshes the first rank has the whole mesh. Of ghost cells the level is -1.
 */
#ifndef vtkBanyanHexOctree_h
#define vtkBanyanHexOctree_h

#include "BanyanFiltersModule.h" // For export macro
#include "vtkUnstructuredGridAlgorithm.h"

#include <memory> // For Sampled

namespace banyan
{
class Communicator;
class ElementOctree;
class SampledGrid;
}

class BANYANFILTERS_EXPORT vtkBanyanHexOctree : public vtkUnstructuredGridAlgorithm
{
public:
  static vtkBanyanHexOctree* New();
  vtkTypeMacro(vtkBanyanHexOctree, vtkUnstructuredGridAlgorithm);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  ///@{
  /// How far a point may lie beside the lattice, in edges of the smallest cell. Default 1/1024;
  /// allowed [0, 1/16]. NaN, infinities and negative numbers are refused, here and below.
  virtual void SetMeshTolerance(double number);
  vtkGetMacro(MeshTolerance, double);
  ///@}

  ///@{
  /// Whether meshes that are no octree (curved or warped hexahedra, topography, mixed cells) become
  /// boxes that they are sampled at. Default: no.
  vtkSetMacro(SampleGeneralMeshes, bool);
  vtkGetMacro(SampleGeneralMeshes, bool);
  vtkBooleanMacro(SampleGeneralMeshes, bool);
  ///@}

  ///@{
  /// The largest difference from the mesh's own field between samples, as a part of the spread of
  /// the values around, whatever they are. Default 1/4; allowed [1/1024, 1].
  virtual void SetMeshSamplingTolerance(double number);
  vtkGetMacro(MeshSamplingTolerance, double);
  ///@}

  ///@{
  /// How many boxes there may be: where more would be needed, they stay coarser, with a warning.
  /// Default 2^20; allowed [2^10, 2^26].
  vtkSetClampMacro(MeshSamplingBoxes, int, 1 << 10, 1 << 26);
  vtkGetMacro(MeshSamplingBoxes, int);
  ///@}

protected:
  vtkBanyanHexOctree();
  ~vtkBanyanHexOctree() override;

  int FillInputPortInformation(int port, vtkInformation* info) override;
  int RequestData(
    vtkInformation* request, vtkInformationVector** inputs, vtkInformationVector* outputs) override;

private:
  void Describe(
    banyan::Communicator& ranks, vtkUnstructuredGrid* input, vtkUnstructuredGrid* output);
  std::shared_ptr<const banyan::ElementOctree> Survey(
    vtkUnstructuredGrid* input, vtkUnstructuredGrid* output);

  double MeshTolerance = 1.0 / 1024;
  bool SampleGeneralMeshes = false;
  double MeshSamplingTolerance = 1.0 / 4;
  int MeshSamplingBoxes = 1 << 20;
  std::unique_ptr<banyan::SampledGrid> Sampled;

  vtkBanyanHexOctree(const vtkBanyanHexOctree&) = delete;
  void operator=(const vtkBanyanHexOctree&) = delete;
};

#endif
