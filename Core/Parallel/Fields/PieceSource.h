// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Fields_PieceSource_h
#define banyan_Parallel_Fields_PieceSource_h

#include "Parallel/Fields/FetchedBricks.h"
#include "Parallel/Fields/PieceExchange.h"
#include "Parallel/Fields/PieceGrid.h"
#include "Parallel/Fields/PieceSamples.h"
#include "Render/Bricks/BrickSource.h"

#include <memory>
#include <vector>

namespace banyan
{

class PieceLevels;

/// Bricks of a grid of plain data that lies in pieces on the ranks: all of them are known on every
/// rank, and can be loaded where their samples are, which is where the piece lies, or where they
/// were fetched to (PieceExchange) before drawing. Which rank draws which brick, and how the grid
/// is cut into pieces, changes no bit of a sample or of a gradient.
///
/// Coarser levels are there once they were made (PieceLevels).
class PieceSource : public BrickSource
{
public:
  /// Everything referred to must stay.
  /// @param known of all bricks of the grid
  /// @param edges of its cells, as CellEdges
  PieceSource(const PieceGrid& grid, int rank, const PieceSamples& samples,
    const FetchedBricks& fetched, PieceSummaries known, const glm::ivec3& edges = glm::ivec3(1));

  glm::ivec3 Bricks() const override { return this->Grid.Bricks(); }
  Box CellsOf(std::int64_t brick) const override { return this->Grid.CellsOf(brick); }
  ValueRange RangeOf(std::int64_t brick) const override { return this->At(brick).Range; }
  ValueMask MaskOf(std::int64_t brick) const override { return this->At(brick).Mask; }
  MaskRange MasksAreOver() const override { return this->Known.Masks; }
  bool HasColours() const override { return this->Known.Colours; }
  /// Of all bricks, on all ranks alike, if they were looked at when they were gathered.
  std::optional<Hash128> ContentOf(std::int64_t brick) const override;
  std::optional<UniformValue> UniformValueOf(std::int64_t brick) const override;
  std::size_t LoadBytes(std::int64_t brick) const override;
  /// Throws Error when the brick is another rank's and was not fetched.
  BrickView Load(std::int64_t brick) override;
  BrickView LoadAround(std::int64_t brick, Box& samples) override;

  /// LevelEdges::Following.
  glm::ivec3 CellEdges() const override { return this->Edges; }

  bool IsOwn(std::int64_t brick) const { return this->Grid.HolderOf(brick) == this->Rank; }

  /// @param levels must stay; those that it has when AtLevel asks for them
  void SetLevels(const PieceLevels* levels) { this->Coarser = levels; }

protected:
  std::unique_ptr<BrickSource> MakeLevel(int level, const Box& domain) override;

private:
  const BoxSummary& At(std::int64_t brick) const
  {
    return this->Known.Bricks[static_cast<std::size_t>(brick)];
  }
  BrickView ViewOf(std::int64_t brick, const Box& samples) const;

  const PieceGrid& Grid;
  int Rank;
  const PieceSamples& Samples;
  const FetchedBricks& Fetched;
  PieceSummaries Known;
  glm::ivec3 Edges;
  const PieceLevels* Coarser = nullptr;
};

} // namespace banyan

#endif
