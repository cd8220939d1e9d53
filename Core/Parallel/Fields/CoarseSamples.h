// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_CoarseSamples_h
#define banyan_Parallel_Fields_CoarseSamples_h

#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Fields/PieceGrid.h"
#include "Parallel/Fields/PieceSamples.h"

#include <vector>

namespace banyan
{

/// The samples of one level of a grid in pieces: which ranks have them, and which they need. Known
/// to every rank alone, from the extents of all pieces.
class CoarsePieces
{
public:
  /// @param cells of the whole grid at the finest level
  /// @param edges of cells of the level, in cells of the finest one
  CoarsePieces(const PieceGrid& finest, const glm::ivec3& cells, const glm::ivec3& edges);

  /// Returns a box for each rank, in samples of the level: the samples of the coarse cells that
  /// begin in its piece. A layer of them on the far side may lie in other pieces.
  const std::vector<Box>& All() const { return this->Needed; }

  /// Collective: this rank's samples of the level.
  /// @param viewTypes PieceSamples::Type of each rank
  /// Throws CollectiveError when one cannot.
  PieceSamples Gather(Communicator& communicator, const PieceSamples& mine,
    const std::vector<ScalarType>& viewTypes) const;

private:
  PieceSamples GatherTogether(Communicator& communicator, const PieceSamples& mine,
    const std::vector<ScalarType>& viewTypes) const;
  /// Copies samples of the level that are in this rank's array, x fastest.
  void Copy(const PieceSamples& mine, const Box& samples, ScalarType type, void* out) const;

  glm::ivec3 Every;    ///< fine sample along each axis
  glm::ivec3 LastFine; ///< sample
  std::vector<Box> Held;
  std::vector<Box> Needed;
};

} // namespace banyan

#endif
