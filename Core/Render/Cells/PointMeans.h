// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Render_Cells_PointMeans_h
#define banyan_Render_Cells_PointMeans_h

#include "Cells/PointTwins.h"
#include "Render/Cells/CellField.h"

#include <vector>

namespace banyan
{

class ThreadPool;

/// Sums over the cells around points, which those of pieces of a mesh are added up from. Points in
/// the same place are one: all of them have the sums of all.
struct PointSums
{
  int Width = 0;                ///< numbers per point
  std::vector<double> Numbers;  ///< of each point: weighted sums, then the weights'
  std::vector<PointTwin> Twins; ///< see TwinsOf

  /// Gives points in the same place what the first of them has.
  void GiveToTwins();
};

/// Sums that PointGradients divides, and its results.
PointSums GradientSums(const DrawnCells& cells, const std::vector<float>& values, ThreadPool& pool);
std::vector<float> GradientsOf(const PointSums& sums);

/// Sums that PointMeans divides, and its results.
PointSums MeanSums(const DrawnCells& cells, const std::vector<float>& values, ThreadPool& pool);
std::vector<float> MeansOf(const PointSums& sums);

/// Gradients of a field at the points of a mesh: the means of those that its cells have in that
/// corner, weighted by how large they are there. Points in the same place are one, as for the
/// border: it does not matter whether cells share them. Exact for linear fields. Cells whose
/// gradient is not finite do not count; 0 where none is left. The same bits for any number of
/// threads, and any order of the cells and points in memory.
/// @param values of points
/// @return x, y, z of each point, in index space: per edge of the lattice. Takes 32 bytes more per
/// point meanwhile
std::vector<float> PointGradients(
  const DrawnCells& cells, const std::vector<float>& values, ThreadPool& pool);

/// Values at the points of a mesh, made of those of its cells: means, weighted by how large the
/// cells are in that corner. Points in the same place are one. NaN at points of no cell.
/// @param values of cells, by their numbers in the mesh
std::vector<float> PointMeans(
  const DrawnCells& cells, const std::vector<float>& values, ThreadPool& pool);

} // namespace banyan

#endif
