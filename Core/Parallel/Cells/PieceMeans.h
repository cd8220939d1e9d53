// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Cells_PieceMeans_h
#define banyan_Parallel_Cells_PieceMeans_h

#include "Render/Cells/CellSource.h"

#include <vector>

namespace banyan
{

class Communicator;
class ThreadPool;

/// Collective: PointGradients of the whole mesh, at the points of a piece. The same but for the
/// last bit of a float. Throws CollectiveError.
std::vector<float> PieceGradients(Communicator& communicator, const DrawnCells& cells,
  const std::vector<float>& values, ThreadPool& pool);

/// Collective: the same of PointMeans.
/// @param values of cells
std::vector<float> PieceMeans(Communicator& communicator, const DrawnCells& cells,
  const std::vector<float>& values, ThreadPool& pool);

/// Collective: gives a piece its gradients, unless all pieces have them.
void GivePieceGradients(Communicator& communicator, CellSource& source, ThreadPool& pool);

} // namespace banyan

#endif
