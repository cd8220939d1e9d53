#include "Pieces/PieceLevels.h"

#include "Base/Error.h"
#include "Pieces/CoarseSamples.h"
#include "Render/VisibleBricks.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>

namespace banyan
{
namespace
{

/// The scene in the index space of a level.
RayScene AtLevel(RayScene scene, int every)
{
  scene.IndexToWorld = glm::scale(scene.IndexToWorld, glm::dvec3(every));
  return scene;
}

/// What this rank wants of a level.
struct Wanted
{
  std::vector<std::int64_t> Missing;
  std::vector<std::int32_t> Counts; ///< by holder
  std::uint64_t Bytes = 0;
};

} // namespace

void PieceLevels::Make(Communicator& communicator, const PieceGrid& finest,
  const PieceSamples& mine, const std::vector<ScalarType>& viewTypes, const glm::ivec3& cells,
  int brickCells, int coarsest, ThreadPool& pool)
{
  this->Clear();
  std::vector<std::unique_ptr<Level>> made;
  for (int number = 1; number <= coarsest; ++number)
  {
    auto level = std::make_unique<Level>();
    const CoarsePieces pieces(finest, cells, number);
    level->Samples = pieces.Gather(communicator, mine, viewTypes);
    level->Grid = PieceGrid(pieces.All(), brickCells);
    level->Known = GatherSummaries(communicator, level->Grid, level->Samples, pool);
    made.push_back(std::move(level));
  }
  this->Levels = std::move(made);
}

std::unique_ptr<PieceSource> PieceLevels::SourceOf(int number, int rank) const
{
  const Level& level = *this->Levels.at(static_cast<std::size_t>(number) - 1);
  return std::make_unique<PieceSource>(level.Grid, rank, level.Samples, level.Fetched,
    level.Known.Bricks, level.Known.Types, level.Known.Masks);
}

std::uint64_t PieceLevels::Bring(Communicator& communicator, const RayScene& scene,
  const std::vector<Box>& zones, std::uint64_t budgetBytes)
{
  const auto self = static_cast<std::size_t>(communicator.Rank());
  const std::size_t ranks = zones.size();
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
    fetches.emplace_back(communicator, level.Grid, level.Known.ViewTypes, level.Samples, around);
    level.Fetched.BeginFrame();
    wanted[i].Counts.assign(ranks, 0);
    try
    {
      const int number = static_cast<int>(i) + 1;
      const std::unique_ptr<PieceSource> source = this->SourceOf(number, communicator.Rank());
      const Box zone = CoarsePieces::CellsBeginningIn(zones[self], number);
      for (const std::int64_t brick : BricksToLoad(AtLevel(scene, 1 << number), *source, zone))
      {
        if (source->IsOwn(brick))
        {
          continue;
        }
        if (level.Fetched.Has(brick, level.Grid.BrickSamples(brick, around)))
        {
          level.Fetched.Use(brick);
          continue;
        }
        wanted[i].Missing.push_back(brick);
        wanted[i].Bytes += fetches[i].BytesOf(brick);
        ++wanted[i].Counts[static_cast<std::size_t>(level.Grid.HolderOf(brick))];
      }
    }
    catch (const std::exception& error)
    {
      failure = error.what();
    }
  }

  // One message tells all ranks how many bricks each wants of whom, of all levels.
  std::vector<std::int32_t> mine{ failure.empty() ? 0 : 1 };
  for (const Wanted& of : wanted)
  {
    mine.insert(mine.end(), of.Counts.begin(), of.Counts.end());
  }
  std::vector<std::int32_t> all(mine.size() * ranks);
  communicator.AllGather(mine.data(), mine.size() * sizeof(std::int32_t), all.data());
  bool failed = false;
  for (std::size_t i = 0; i <= this->Levels.size(); ++i)
  {
    std::vector<std::int32_t> counts;
    bool some = false;
    for (std::size_t rank = 0; rank < ranks; ++rank)
    {
      const std::int32_t* const said = all.data() + rank * mine.size();
      failed = failed || said[0] != 0;
      if (i > 0)
      {
        const std::int32_t* const first = said + 1 + (i - 1) * ranks;
        counts.insert(counts.end(), first, first + ranks);
        some = some || std::any_of(first, first + ranks, [](std::int32_t n) { return n > 0; });
      }
    }
    if (failed)
    {
      throw Error(AgreeOnError(communicator, failure));
    }
    if (some)
    {
      Level& level = *this->Levels[i - 1];
      level.Fetched.MakeRoom(wanted[i - 1].Bytes, budgetBytes / this->Levels.size());
      const std::string problem = AgreeOnError(
        communicator, fetches[i - 1].Exchange(wanted[i - 1].Missing, counts, level.Fetched));
      if (!problem.empty())
      {
        throw Error(problem);
      }
      bytes += wanted[i - 1].Bytes;
    }
  }
  return bytes;
}

} // namespace banyan
