// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_PieceExchange_h
#define banyan_Parallel_Fields_PieceExchange_h

#include "Base/Hash.h"
#include "Parallel/Communicate/Communicator.h"
#include "Parallel/Fields/FetchedBricks.h"
#include "Parallel/Fields/PieceGrid.h"
#include "Parallel/Fields/PieceSamples.h"

#include <string>
#include <vector>

namespace banyan
{

class ThreadPool;

/// Holds what all ranks know of the bricks of a grid in pieces.
struct PieceSummaries
{
  MaskRange Masks;                   ///< over the finite values of all pieces
  std::vector<BoxSummary> Bricks;    ///< of nobody's bricks: nothing
  std::vector<Hash128> Contents;     ///< of samples and place of each brick; empty: not looked at
  std::vector<ScalarType> Types;     ///< of the array of each rank
  std::vector<ScalarType> ViewTypes; ///< PieceSamples::Type of each rank
  bool Colours = false;              ///< whether the array of some rank has colours
};

/// Collective: each rank looks at its own bricks once, and tells the others.
/// @param mine of this rank
/// @param looks whether to tell what bricks hold, too; the same on all ranks
/// Throws CollectiveError when one cannot.
PieceSummaries GatherSummaries(Communicator& communicator, const PieceGrid& grid,
  const PieceSamples& mine, ThreadPool& pool, bool looks = false);

/// Collective: gives every rank the layer of samples around what it holds. No messages are needed
/// to ask for it: every rank knows what the others lack.
/// @return bytes that this rank received
/// Throws CollectiveError when one cannot.
std::uint64_t ExchangeShells(Communicator& communicator, const PieceGrid& grid,
  const std::vector<ScalarType>& viewTypes, PieceSamples& mine);

/// Collective: bricks go from those who hold them to those who want them, in messages of about
/// `MessageBytes`, a round of one from and to each rank after the other.
class BrickFetch
{
public:
  static constexpr std::uint64_t MessageBytes = std::uint64_t{ 1 } << 20;

  /// Everything referred to must stay.
  /// @param around whether bricks come with a layer around them
  BrickFetch(const PieceGrid& grid, const std::vector<ScalarType>& viewTypes,
    const PieceSamples& mine, bool around);

  /// Bytes that a brick takes on its way.
  std::uint64_t BytesOf(std::int64_t brick) const;

  /// Collective.
  /// @param wanted of this rank, ascending, held by others
  /// @param counts `[asking rank][holding rank]`: how many bricks of each other all ranks want
  /// @param into receives them
  /// Throws CollectiveError when one could not give what was asked for, or keep what
  /// it got; then nothing is kept, not even what was there before.
  void Exchange(Communicator& communicator, const std::vector<std::int64_t>& wanted,
    const std::vector<std::int32_t>& counts, FetchedBricks& into);

private:
  using Lists = std::vector<std::vector<std::int64_t>>; ///< bricks by rank

  ScalarType TypeOf(std::int64_t brick) const;
  void ExchangeTogether(Communicator& communicator, const std::vector<std::int64_t>& wanted,
    const std::vector<std::int32_t>& counts, FetchedBricks& into);
  Lists TellHolders(
    Communicator& communicator, const Lists& from, const std::vector<std::int32_t>& counts);
  std::size_t EndOfMessage(const std::vector<std::int64_t>& bricks, std::size_t first) const;
  std::uint64_t BytesOf(
    const std::vector<std::int64_t>& bricks, std::size_t first, std::size_t last) const;
  void Pack(
    const std::vector<std::int64_t>& bricks, std::size_t first, std::size_t last, char* out);
  void Unpack(const std::vector<std::int64_t>& bricks, std::size_t first, std::size_t last,
    const char* in, FetchedBricks& into);

  const PieceGrid& Grid;
  const std::vector<ScalarType>& ViewTypes;
  const PieceSamples& Mine;
  bool Around;
  std::string Failure;
};

} // namespace banyan

#endif
