// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/PieceLevels.h"

#include "Parallel/Communicate/Collective.h"
#include "Parallel/Fields/CoarseSamples.h"
#include "Render/Bricks/VisibleBricks.h"
#include "Render/Scene/RayLattice.h"

#include <algorithm>

namespace banyan
{
namespace
{

/// The scene in the index space of a level.
RayScene AtLevel(RayScene scene, const glm::ivec3& edges)
{
  scene.IndexToWorld = IndexToWorldAt(scene, edges);
  return scene;
}

/// Lists what this rank wants of a level.
struct Wanted
{
  std::vector<std::int64_t> Missing;
  std::vector<std::int32_t> Counts; ///< by holder
  std::uint64_t Bytes = 0;
};

/// @param scene in the index space of the level
/// @param zone cells of the level
/// @param fetched what is there of it counts as used
void AddMissing(const RayScene& scene, const PieceSource& source, const PieceGrid& grid,
  const BrickFetch& fetch, const Box& zone, bool around, FetchedBricks& fetched, Wanted& wanted)
{
  for (const std::int64_t brick : BricksToLoad(scene, source, zone))
  {
    if (source.IsOwn(brick))
    {
      continue;
    }
    if (fetched.Has(brick, grid.BrickSamples(brick, around)))
    {
      fetched.Use(brick);
      continue;
    }
    wanted.Missing.push_back(brick);
    wanted.Bytes += fetch.BytesOf(brick);
    ++wanted.Counts[static_cast<std::size_t>(grid.HolderOf(brick))];
  }
}

/// Collective, one message for all levels. @return how many bricks each rank wants of each other:
/// per level `[asking rank][holding rank]`
/// Throws CollectiveError when one has failed.
std::vector<std::vector<std::int32_t>> GatherCounts(
  Communicator& communicator, const std::vector<Wanted>& wanted, const std::string& failure)
{
  const auto ranks = static_cast<std::size_t>(communicator.Size());
  std::vector<std::int32_t> mine{ failure.empty() ? 0 : 1 };
  for (const Wanted& of : wanted)
  {
    mine.insert(mine.end(), of.Counts.begin(), of.Counts.end());
  }
  std::vector<std::int32_t> all(mine.size() * ranks);
  communicator.AllGather(mine.data(), mine.size() * sizeof(std::int32_t), all.data());
  std::vector<std::vector<std::int32_t>> counts(wanted.size());
  bool failed = false;
  for (std::size_t rank = 0; rank < ranks; ++rank)
  {
    auto next = all.begin() + static_cast<std::ptrdiff_t>(rank * mine.size());
    failed = failed || *next != 0;
    ++next;
    for (std::vector<std::int32_t>& of : counts)
    {
      of.insert(of.end(), next, next + static_cast<std::ptrdiff_t>(ranks));
      next += static_cast<std::ptrdiff_t>(ranks);
    }
  }
  if (failed)
  {
    ThrowTogether(communicator, failure);
  }
  return counts;
}

} // namespace

void PieceLevels::Make(Communicator& communicator, const PieceGrid& finest,
  const PieceSamples& mine, const std::vector<ScalarType>& viewTypes, const glm::ivec3& cells,
  int brickCells, int coarsest, ThreadPool& pool, const std::shared_ptr<const HiddenCells>& hidden,
  bool looks)
{
  this->Clear();
  std::vector<std::unique_ptr<Level>> made;
  const LevelEdges edges = LevelEdges::Following(cells);
  for (int number = 1; number <= coarsest; ++number)
  {
    auto level = std::make_unique<Level>();
    level->Edges = edges.At(number);
    const CoarsePieces pieces(finest, cells, level->Edges);
    level->Samples = pieces.Gather(communicator, mine, viewTypes);
    level->Grid = PieceGrid(pieces.All(), brickCells);
    level->Known = GatherSummaries(communicator, level->Grid, level->Samples, pool, looks);
    if (hidden)
    {
      level->Hidden = std::make_shared<const HiddenCells>(hidden->Coarser(level->Edges));
    }
    made.push_back(std::move(level));
  }
  this->Levels = std::move(made);
}

std::unique_ptr<PieceSource> PieceLevels::SourceOf(int number, int rank) const
{
  const Level& level = *this->Levels.at(static_cast<std::size_t>(number) - 1);
  auto source = std::make_unique<PieceSource>(
    level.Grid, rank, level.Samples, level.Fetched, level.Known, level.Edges);
  source->Hide(level.Hidden);
  return source;
}

std::uint64_t PieceLevels::Bring(Communicator& communicator, const RayScene& scene,
  const std::vector<Box>& zones, std::uint64_t budgetBytes)
{
  const int self = communicator.Rank();
  const bool around = scene.Shading.On && scene.Blend.Mode == BlendMode::Composite;
  std::uint64_t bytes = 0;
  std::vector<Wanted> wanted(this->Levels.size());
  std::vector<BrickFetch> fetches;
  std::string failure;
  for (std::size_t i = 0; i < this->Levels.size(); ++i)
  {
    Level& level = *this->Levels[i];
    if (around && !level.Samples.HasShell())
    {
      bytes += ExchangeShells(communicator, level.Grid, level.Known.ViewTypes, level.Samples);
    }
    fetches.emplace_back(level.Grid, level.Known.ViewTypes, level.Samples, around);
    level.Fetched.BeginFrame();
    wanted[i].Counts.assign(zones.size(), 0);
    const int number = static_cast<int>(i) + 1;
    Attempt(failure,
      [&]
      {
        AddMissing(AtLevel(scene, level.Edges), *this->SourceOf(number, self), level.Grid,
          fetches[i], CellsAtLevel(zones.at(static_cast<std::size_t>(self)), level.Edges), around,
          level.Fetched, wanted[i]);
      });
  }

  const std::vector<std::vector<std::int32_t>> counts = GatherCounts(communicator, wanted, failure);
  for (std::size_t i = 0; i < this->Levels.size(); ++i)
  {
    if (std::none_of(counts[i].begin(), counts[i].end(), [](std::int32_t n) { return n > 0; }))
    {
      continue;
    }
    FetchedBricks& fetched = this->Levels[i]->Fetched;
    fetched.MakeRoom(wanted[i].Bytes, budgetBytes / this->Levels.size());
    fetches[i].Exchange(communicator, wanted[i].Missing, counts[i], fetched);
    bytes += wanted[i].Bytes;
  }
  return bytes;
}

} // namespace banyan
