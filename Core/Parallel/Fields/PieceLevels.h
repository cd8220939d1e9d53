// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_PieceLevels_h
#define banyan_Parallel_Fields_PieceLevels_h

#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Fields/FetchedBricks.h"
#include "Parallel/Fields/PieceExchange.h"
#include "Parallel/Fields/PieceGrid.h"
#include "Parallel/Fields/PieceSamples.h"
#include "Parallel/Fields/PieceSource.h"

#include <memory>
#include <vector>

namespace banyan
{

struct RayScene;
class ThreadPool;

/// Coarser levels of a grid of plain data that lies in pieces on the ranks: some samples of the
/// whole grid (LevelEdges::Following), wherever pieces begin; where the last cell is not whole, one
/// more sample repeats the last fine one. So ranks together have the level that one rank makes of
/// everything.
///
/// The coarse cells that begin in a rank's piece are its own. Samples of them that lie in others'
/// pieces come from there: one layer, on the far side. All levels together take less than a fifth
/// of the memory of the finest one, and of flat grids up to all of it.
class PieceLevels
{
public:
  /// Collective: makes levels 1 to `coarsest`, of what lies on the ranks now.
  /// @param finest the grid of which `mine` has this rank's samples
  /// @param viewTypes PieceSamples::Type of each rank
  /// @param cells of the whole grid
  /// @param brickCells as for PieceGrid
  /// @param hidden cells of the whole grid; null for none
  /// @param looks GatherSummaries
  /// Throws CollectiveError when one cannot; there are no levels then.
  void Make(Communicator& communicator, const PieceGrid& finest, const PieceSamples& mine,
    const std::vector<ScalarType>& viewTypes, const glm::ivec3& cells, int brickCells, int coarsest,
    ThreadPool& pool, const std::shared_ptr<const HiddenCells>& hidden = nullptr,
    bool looks = false);
  void Clear() { this->Levels.clear(); }

  /// 0 while there is none but the finest.
  int Coarsest() const { return static_cast<int>(this->Levels.size()); }

  /// The bricks of a level in [1, Coarsest()], which refer to this.
  std::unique_ptr<PieceSource> SourceOf(int level, int rank) const;

  /// Collective, before a frame: fetches what zones take of all levels and others hold.
  /// @param zones cells of the finest level of each rank, the same list on all ranks
  /// @param budgetBytes for fetched bricks of all levels on this rank
  /// @return bytes that this rank received
  /// Throws CollectiveError when one fails.
  std::uint64_t Bring(Communicator& communicator, const RayScene& scene,
    const std::vector<Box>& zones, std::uint64_t budgetBytes);

private:
  struct Level
  {
    glm::ivec3 Edges{ 1 }; ///< of its cells
    PieceGrid Grid;
    PieceSamples Samples;
    PieceSummaries Known;
    FetchedBricks Fetched;
    std::shared_ptr<const HiddenCells> Hidden;
  };

  std::vector<std::unique_ptr<Level>> Levels; ///< from level 1 on
};

} // namespace banyan

#endif
