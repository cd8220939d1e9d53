// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_PieceField_h
#define banyan_Parallel_Fields_PieceField_h

#include "Parallel/Balance/FrameBalancer.h"
#include "Parallel/Fields/FetchedBricks.h"
#include "Parallel/Fields/PieceExchange.h"
#include "Parallel/Fields/PieceLevels.h"
#include "Parallel/Fields/PieceSource.h"

#include <memory>
#include <vector>

namespace banyan
{

class BrickCache;
class ThreadPool;

/// A field of plain data that lies in pieces on the ranks, drawn in zones that need not be those of
/// the pieces: before each frame, bricks that a rank draws and another one holds are fetched from
/// there, and kept. Used alike on all ranks.
///
/// Zones begin as the pieces lie, and move as the balancer wants, but never so far that a frame
/// would move more bytes than LoadBalancer::MostBytes, or that a rank would have to hold more
/// fetched bricks than its budget: planes then stay back, on all ranks alike.
class PieceField
{
public:
  /// Sums over all ranks for the frame that was begun last.
  struct Statistics
  {
    std::uint64_t BytesMoved = 0; ///< samples received, layers for shading among them
    std::uint64_t Hits = 0;       ///< bricks of other ranks that were still here
    std::uint64_t Misses = 0;     ///< bricks of other ranks that were fetched
    double FetchSeconds = 0.0; ///< of this rank, until bricks were there; no ray is cast meanwhile
    int StayedBack = 0;        ///< how often planes were put back for the frame
  };

  /// @param sharesWith a cache whose room for decoded bricks fetched ones take; null for none
  explicit PieceField(BrickCache* sharesWith = nullptr);

  /// Collective: new pieces, or new values. Fetched bricks are forgotten. Zones stay where they are
  /// if the pieces lie as before.
  /// @param samples of each rank's piece, the same list on all ranks
  /// @param mine of this rank: samples.at(rank) of it; without effect on ranks without samples
  /// @param cells of the whole grid
  /// @param brickCells as for PieceGrid
  /// @param mode how zones move
  /// @param looks whether BrickSource::ContentOf is known then; the same on all ranks
  /// Throws CollectiveError when one cannot; there is no Source() then.
  void Take(Communicator& communicator, const std::vector<Box>& samples, const SampleArray& mine,
    const glm::ivec3& cells, int brickCells, LoadBalancing mode, ThreadPool& pool,
    bool looks = false);

  /// Null before Take.
  PieceSource* Source() { return this->Bricks.get(); }
  const PieceGrid& Grid() const { return this->Pieces; }

  /// Cells of each rank for the frame that was begun last, or for the next one.
  const std::vector<Box>& Zones() const { return this->Balancer.Zones(); }

  /// Collective: moves the planes, and fetches what this rank's zone takes.
  /// @param scene all of it but its samplings
  /// @param budgetBytes for fetched bricks on this rank
  /// Throws CollectiveError when one fails.
  void BeginFrame(Communicator& communicator, RayScene& scene, std::uint64_t budgetBytes);
  /// Collective, after BeginFrame, for frames that may be drawn from coarser levels: makes them
  /// when they are not there yet, and fetches what this rank's zone takes of them.
  /// @param coarsest the same on all ranks, and from frame to frame
  /// Throws CollectiveError when one fails.
  void BringLevels(Communicator& communicator, const RayScene& scene, int coarsest,
    std::uint64_t budgetBytes, ThreadPool& pool);

  /// Collective, after the frame was drawn.
  void EndFrame(Communicator& communicator) { this->Balancer.EndFrame(communicator); }

  const Statistics& FrameStatistics() const { return this->Numbers; }
  /// Held by this rank.
  std::uint64_t FetchedBytes() const { return this->Fetched.Bytes(); }

private:
  struct Wish;

  Wish WishOf(const RayScene& scene, const BrickFetch& fetch, int rank, std::uint64_t budgetBytes);
  void AddWishes(const RayScene& scene, const BrickFetch& fetch, int rank,
    std::uint64_t budgetBytes, Wish& wish);
  bool Fits(Communicator& communicator, const Wish& mine, std::vector<std::int32_t>& counts);

  PieceGrid Pieces;
  PieceSamples Mine;
  std::vector<ScalarType> ViewTypes; ///< PieceSamples::Type of each rank
  bool Looked = false;               ///< whether it is known what bricks hold
  FetchedBricks Fetched;
  FrameBalancer Balancer;
  PieceLevels Levels;
  int MostBrickCells = 0;
  glm::ivec3 AllCells{ 0 };
  std::unique_ptr<PieceSource> Bricks;
  Statistics Numbers;
};

} // namespace banyan

#endif
