// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/PieceSource.h"

#include "Base/Error.h"
#include "Parallel/Fields/PieceLevels.h"

#include <string>

namespace banyan
{

PieceSource::PieceSource(const PieceGrid& grid, int rank, const PieceSamples& samples,
  const FetchedBricks& fetched, PieceSummaries known, const glm::ivec3& edges)
  : Grid(grid)
  , Rank(rank)
  , Samples(samples)
  , Fetched(fetched)
  , Known(std::move(known))
  , Edges(edges)
{
  if (static_cast<std::int64_t>(this->Known.Bricks.size()) != grid.Count())
  {
    throw Error("There is not one summary for each brick of the pieces.");
  }
}

std::optional<UniformValue> PieceSource::UniformValueOf(std::int64_t brick) const
{
  const BoxSummary& summary = this->At(brick);
  if (!summary.Uniform || summary.Range.Empty())
  {
    return std::nullopt;
  }
  const int holder = this->Grid.HolderOf(brick);
  return UniformValue{ summary.Range.Low, this->Known.Types[static_cast<std::size_t>(holder)] };
}

std::optional<Hash128> PieceSource::ContentOf(std::int64_t brick) const
{
  if (this->Known.Contents.empty())
  {
    return std::nullopt;
  }
  return this->Known.Contents[static_cast<std::size_t>(brick)];
}

std::size_t PieceSource::LoadBytes(std::int64_t brick) const
{
  return this->IsOwn(brick) ? this->Samples.ViewBytes(this->Grid.BrickSamples(brick, false)) : 0;
}

BrickView PieceSource::ViewOf(std::int64_t brick, const Box& samples) const
{
  if (this->IsOwn(brick))
  {
    return this->Samples.View(samples);
  }
  const SampledBox* const fetched = this->Fetched.Find(brick);
  if (!fetched || !fetched->Samples.Contains(samples))
  {
    throw Error("Brick " + std::to_string(brick) + " of rank " +
                std::to_string(this->Grid.HolderOf(brick)) +
                " is to be drawn and was not fetched from there.");
  }
  return ViewFrom(*fetched, samples.Lo);
}

BrickView PieceSource::Load(std::int64_t brick)
{
  return this->ViewOf(brick, this->Grid.BrickSamples(brick, false));
}

BrickView PieceSource::LoadAround(std::int64_t brick, Box& samples)
{
  samples = this->Grid.BrickSamples(brick, true);
  return this->ViewOf(brick, samples);
}

std::unique_ptr<BrickSource> PieceSource::MakeLevel(int level, const Box&)
{
  const bool made = this->Coarser && level <= this->Coarser->Coarsest();
  return made ? this->Coarser->SourceOf(level, this->Rank) : nullptr;
}

} // namespace banyan
