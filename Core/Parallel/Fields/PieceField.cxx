// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/PieceField.h"

#include "Base/Timer.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Fields/PieceZones.h"
#include "Render/Bricks/VisibleBricks.h"

#include <algorithm>
#include <array>
#include <iterator>

namespace banyan
{
namespace
{

/// Parts of the way from the pieces to where planes should be that are tried one after the other.
constexpr std::array<double, 6> PartsOfTheWay{ { 0.75, 0.5, 0.5, 0.5, 0.5, 0.0 } };

/// Bytes of a cell that moves, with the layer that its brick has in common with the next ones.
double BytesPerCell(ScalarType type)
{
  return 1.2 * static_cast<double>(SizeOf(type));
}

/// Whether bricks are drawn with a layer around them.
bool IsShaded(const RayScene& scene)
{
  return scene.Shading.On && scene.Blend.Mode == BlendMode::Composite;
}

} // namespace

struct PieceField::Wish
{
  double Fetched = 0.0;           ///< bytes that are to be fetched
  double Drawn = 0.0;             ///< bytes of all bricks that are drawn
  bool Over = false;              ///< whether the budget would not hold what is fetched
  std::vector<std::int64_t> Here; ///< bricks of others that were fetched before
  std::vector<std::int64_t> Missing;
  std::vector<std::int32_t> Counts; ///< of the missing ones, by holder
  std::string Failure;
};

PieceField::PieceField(BrickCache* sharesWith)
  : Fetched(sharesWith)
{
}

void PieceField::Take(Communicator& communicator, const std::vector<Box>& samples,
  const SampleArray& mine, const glm::ivec3& cells, int brickCells, LoadBalancing mode,
  ThreadPool& pool, bool looks)
{
  this->Bricks.reset();
  this->Levels.Clear();
  this->Fetched.Clear();
  this->MostBrickCells = brickCells;
  this->AllCells = cells;
  Collective(communicator,
    [&]
    {
      this->Pieces = PieceGrid(samples, brickCells);
      const bool some = !this->Pieces.SamplesOf(communicator.Rank()).Empty();
      this->Mine = some ? PieceSamples(mine) : PieceSamples();
    });
  PieceSummaries known = GatherSummaries(communicator, this->Pieces, this->Mine, pool, looks);
  this->Looked = looks;
  this->ViewTypes = known.ViewTypes;

  FrameBalancer::Field field;
  field.Cells = cells;
  field.BrickCells = brickCells;
  field.BytesPerCell = 0.0;
  for (const ScalarType type : this->ViewTypes)
  {
    field.BytesPerCell = std::max(field.BytesPerCell, BytesPerCell(type));
  }
  field.Start = ZonesOfPieces(this->Pieces, cells);
  this->Balancer.Start(mode, field, communicator.Size());
  this->Bricks = std::make_unique<PieceSource>(
    this->Pieces, communicator.Rank(), this->Mine, this->Fetched, std::move(known));
  this->Bricks->SetLevels(&this->Levels);
}

PieceField::Wish PieceField::WishOf(
  const RayScene& scene, const BrickFetch& fetch, int rank, std::uint64_t budgetBytes)
{
  Wish wish;
  wish.Counts.assign(static_cast<std::size_t>(this->Pieces.Ranks()), 0);
  Attempt(wish.Failure, [&] { this->AddWishes(scene, fetch, rank, budgetBytes, wish); });
  return wish;
}

void PieceField::AddWishes(
  const RayScene& scene, const BrickFetch& fetch, int rank, std::uint64_t budgetBytes, Wish& wish)
{
  const bool around = IsShaded(scene);
  std::uint64_t held = 0;
  const Box& zone = this->Zones().at(static_cast<std::size_t>(rank));
  for (const std::int64_t brick : BricksToLoad(scene, *this->Bricks, zone))
  {
    const std::uint64_t bytes = fetch.BytesOf(brick);
    wish.Drawn += static_cast<double>(bytes);
    if (this->Bricks->IsOwn(brick))
    {
      continue;
    }
    held += bytes;
    if (this->Fetched.Has(brick, this->Pieces.BrickSamples(brick, around)))
    {
      wish.Here.push_back(brick);
      continue;
    }
    wish.Missing.push_back(brick);
    ++wish.Counts[static_cast<std::size_t>(this->Pieces.HolderOf(brick))];
    wish.Fetched += static_cast<double>(bytes);
  }
  wish.Over = held > budgetBytes;
}

/// Collective, one AllGather. @return whether all that ranks wish for may be fetched
/// Throws CollectiveError when one could not say what it wishes for.
bool PieceField::Fits(
  Communicator& communicator, const Wish& mine, std::vector<std::int32_t>& counts)
{
  const std::size_t ranks = mine.Counts.size();
  std::vector<double> message{ mine.Fetched, mine.Drawn, static_cast<double>(mine.Here.size()),
    mine.Over ? 1.0 : 0.0, mine.Failure.empty() ? 0.0 : 1.0 };
  const std::size_t head = message.size();
  message.insert(message.end(), mine.Counts.begin(), mine.Counts.end());
  std::vector<double> all(message.size() * ranks);
  communicator.AllGather(message.data(), message.size() * sizeof(double), all.data());

  counts.clear();
  std::vector<double> sum(head, 0.0);
  for (auto from = all.begin(); from != all.end(); from += static_cast<std::ptrdiff_t>(ranks))
  {
    for (double& value : sum)
    {
      value += *from++;
    }
    std::transform(from, from + static_cast<std::ptrdiff_t>(ranks), std::back_inserter(counts),
      [](double count) { return static_cast<std::int32_t>(count); });
  }
  const double fetched = sum[0];
  const double drawn = sum[1];
  if (sum[4] > 0.0)
  {
    ThrowTogether(communicator, mine.Failure);
  }
  this->Numbers.Hits = static_cast<std::uint64_t>(sum[2]);
  this->Numbers.Misses = 0;
  for (const std::int32_t count : counts)
  {
    this->Numbers.Misses += static_cast<std::uint64_t>(count);
  }
  this->Numbers.BytesMoved = static_cast<std::uint64_t>(fetched);
  // The balancer has the same limit.
  return sum[3] == 0.0 && fetched <= LoadBalancer::MostBytes(drawn);
}

void PieceField::BeginFrame(Communicator& communicator, RayScene& scene, std::uint64_t budgetBytes)
{
  this->Numbers = {};
  this->Balancer.BeginFrame(scene, *this->Bricks);
  this->Fetched.BeginFrame();
  const bool around = IsShaded(scene);
  std::uint64_t shell = 0;
  if (around && !this->Mine.HasShell())
  {
    shell = ExchangeShells(communicator, this->Pieces, this->ViewTypes, this->Mine);
  }
  BrickFetch fetch(this->Pieces, this->ViewTypes, this->Mine, around);
  std::vector<std::int32_t> counts;
  Wish wish = this->WishOf(scene, fetch, communicator.Rank(), budgetBytes);
  while (!this->Fits(communicator, wish, counts) && this->Balancer.Moves() &&
         this->Numbers.StayedBack < static_cast<int>(PartsOfTheWay.size()))
  {
    this->Balancer.GoBack(PartsOfTheWay[static_cast<std::size_t>(this->Numbers.StayedBack)]);
    ++this->Numbers.StayedBack;
    wish = this->WishOf(scene, fetch, communicator.Rank(), budgetBytes);
  }
  for (const std::int64_t brick : wish.Here)
  {
    this->Fetched.Use(brick);
  }
  this->Fetched.MakeRoom(static_cast<std::uint64_t>(wish.Fetched), budgetBytes);
  if (this->Numbers.Misses > 0)
  {
    const Timer timer;
    fetch.Exchange(communicator, wish.Missing, counts, this->Fetched);
    this->Numbers.FetchSeconds = timer.Seconds();
  }
  this->Numbers.BytesMoved += shell;
}

void PieceField::BringLevels(Communicator& communicator, const RayScene& scene, int coarsest,
  std::uint64_t budgetBytes, ThreadPool& pool)
{
  if (this->Levels.Coarsest() == 0 && coarsest > 0)
  {
    this->Levels.Make(communicator, this->Pieces, this->Mine, this->ViewTypes, this->AllCells,
      this->MostBrickCells, coarsest, pool, this->Bricks->Hidden(), this->Looked);
  }
  const double received =
    static_cast<double>(this->Levels.Bring(communicator, scene, this->Zones(), budgetBytes));
  this->Numbers.BytesMoved += static_cast<std::uint64_t>(AllSum(communicator, received));
}

} // namespace banyan
