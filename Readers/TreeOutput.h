// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Readers_TreeOutput_h
#define banyan_Readers_TreeOutput_h

#include "vtkBanyanDeferred.h"

#include "vtkSmartPointer.h"

#include <memory>
#include <vector>

class vtkDataArray;
class vtkHyperTreeGrid;

namespace banyan
{

template <class T>
class FillSet;
struct StoredMesh;
struct TreeCells;

/// The mesh of a series as hyper tree grids, with the values of a step in the cells. The trees are
/// made once for each level and piece: steps share them.
class TreeOutput
{
public:
  TreeOutput();
  ~TreeOutput();

  void Forget();

  /// The trees of a piece, on the grid of all; a piece has the trees that begin in its run of
  /// cells. Places that no cell covers are masked.
  void FillTrees(std::shared_ptr<const StoredMesh> mesh, int level, int piece, int pieces,
    vtkHyperTreeGrid* output);

  /// The values of an array in the cells of the last FillTrees(): of point arrays at the centre of
  /// each leaf (see ValueAtCentre), of cell arrays those of the leaves (see MeanOfLeaves); and in
  /// coarser cells the mean of the eight below, without masked ones. Float32 where that holds all
  /// values of the array's type, otherwise float64. Throws Error.
  /// @param handle of the whole image
  vtkSmartPointer<vtkDataArray> Values(const vtkBanyanDeferred::Handle& handle) const;

private:
  class Maker;

  template <class Out, class ValueOfLeaf>
  void Mean(const ValueOfLeaf& valueOfLeaf, int components, int component, Out* means) const;
  template <class T, class Out>
  void FillComponent(const T* samples, const FillSet<T>& fills, bool ofCells, int components,
    int component, Out* means) const;

  std::shared_ptr<const StoredMesh> Mesh;
  std::unique_ptr<const TreeCells> Cells;
  vtkSmartPointer<vtkHyperTreeGrid> Trees;
  int Made[3] = { -1, 0, 0 };
  std::vector<std::int64_t> LeafOf; ///< of each cell of Trees: its leaf; or Coarse, or Masked
  std::vector<std::int64_t> Parent; ///< of each cell: that above it, or -1

  static constexpr std::int64_t Coarse = -1;
  static constexpr std::int64_t Masked = -2;
};

} // namespace banyan

#endif
