// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/SeriesField.h"

#include "Base/Digest.h"
#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Render/Bricks/VisibleContent.h"
#include "Render/Steps/StepSource.h"
#include "Render/Steps/TimeStepPrefetcher.h"
#include "Series/Decode/CacheContext.h"

#include <algorithm>
#include <utility>

namespace banyan
{
namespace
{

/// Samples per axis of a level as the reader gives them: those that are also fine ones.
glm::ivec3 ExposedSamples(const SeriesFile& series, int level)
{
  const glm::ivec3 fine = series.Index().Domain.Samples();
  return glm::ivec3(
    ((fine.x - 1) >> level) + 1, ((fine.y - 1) >> level) + 1, ((fine.z - 1) >> level) + 1);
}

/// The rank whose piece is what those of all others are too; -1 if they are not alike.
int FirstOfAlike(const std::vector<SeriesField::Piece>& pieces,
  const std::vector<std::string>& paths, const std::vector<std::string>& fingerprints)
{
  int first = -1;
  for (std::size_t rank = 0; rank < pieces.size(); ++rank)
  {
    const SeriesField::Piece& piece = pieces[rank];
    if (!piece.HasData)
    {
      continue;
    }
    first = first < 0 ? static_cast<int>(rank) : first;
    const auto other = static_cast<std::size_t>(first);
    if (paths[rank] != paths[other] || fingerprints[rank] != fingerprints[other] ||
        piece.Step != pieces[other].Step || piece.Array != pieces[other].Array ||
        piece.Component != pieces[other].Component || piece.Level != pieces[other].Level ||
        piece.Fraction != pieces[other].Fraction)
    {
      return -1;
    }
  }
  return first;
}

} // namespace

SeriesField::SeriesField() = default;
SeriesField::~SeriesField() = default;

void SeriesField::Open(
  const std::string& path, const std::string& fingerprint, std::int64_t cacheBytes)
{
  if (this->Series && this->Series->Path() == path &&
      ToHex(this->Series->Fingerprint()) == fingerprint &&
      this->Series->Caches()->OwnBudgetBytes() == cacheBytes)
  {
    return;
  }
  this->Series = SeriesFile::Open(path, CacheContext::WithBudget(cacheBytes));
  if (ToHex(this->Series->Fingerprint()) != fingerprint)
  {
    throw Error(
      "The series was replaced, or is not the same on all ranks: open it again", { path });
  }
}

bool SeriesField::Take(Communicator& communicator, const std::shared_ptr<const SeriesFile>& held,
  const std::vector<Piece>& pieces, const Wish& wish, std::string& problem)
{
  if (this->Bricks)
  {
    this->BricksBefore = std::move(this->Bricks);
  }
  // Strings do not fit into the pieces.
  const std::vector<std::string> paths =
    AllGatherStrings(communicator, held ? held->Path() : std::string());
  const std::vector<std::string> fingerprints =
    AllGatherStrings(communicator, held ? ToHex(held->Fingerprint()) : std::string());
  const int rank = FirstOfAlike(pieces, paths, fingerprints);
  if (rank < 0)
  {
    return false;
  }
  const auto first = static_cast<std::size_t>(rank);
  const double cacheBytes =
    AllMax(communicator, held ? static_cast<double>(held->Caches()->OwnBudgetBytes()) : -1.0);
  bool whole = false;
  try
  {
    if (held)
    {
      this->Series = held;
    }
    else
    {
      this->Open(paths[first], fingerprints[first], static_cast<std::int64_t>(cacheBytes));
    }
    whole = ExposedSamples(*this->Series, pieces[first].Level) == wish.Samples.Size();
    if (whole && problem.empty())
    {
      this->MakeZones(pieces[first], wish, communicator.Size());
    }
  }
  catch (const std::exception& error)
  {
    problem = problem.empty() ? error.what() : problem;
    whole = true;
  }
  return AllMax(communicator, whole ? 0.0 : 1.0) == 0.0;
}

void SeriesField::MakeZones(const Piece& field, const Wish& wish, int ranks)
{
  this->Drawn = { field.Step, field.Array, field.Component, field.Level };
  this->Fraction = field.Fraction;
  this->Enhancement = wish.Enhancement;
  if (this->Ahead)
  {
    this->Ahead->Drawing(*this->Series, this->Drawn.Step);
  }
  const BrickLayout layout = this->Series->Layout(field.Level);
  FrameBalancer::Field balanced;
  balanced.Cells = wish.Samples.Size() - 1;
  balanced.CoarsestLevel = CoarsestLevelOf(balanced.Cells);
  // The first planes, too, stand between cells of the coarsest level.
  balanced.BrickCells = std::max(layout.BrickCells(), 1 << balanced.CoarsestLevel);
  balanced.BytesPerCell = static_cast<double>(
    SizeOf(this->Series->Index().Arrays.at(static_cast<std::size_t>(field.Array)).Type));
  this->Balancer.Start(wish.Balancing, balanced, ranks);
  this->ZoneCells = this->Balancer.Zones();
  // Ranks without a zone need it too: to know what can be seen of the others'.
  this->Bricks =
    this->Fraction > 0.0
      ? MakeSourceBetween(this->Series, this->Drawn, this->Drawn.Component, this->Fraction)
      : MakeSeriesSource(this->Series, this->Drawn, this->Drawn.Component, this->Enhancement);
  if (this->BricksBefore && this->BricksBefore->Kept().Caches() == this->Series->Caches())
  {
    this->Bricks->TakeKept(*this->BricksBefore, { glm::ivec3(0), balanced.Cells });
  }
  this->BricksBefore.reset();
}

void SeriesField::BeginFrame(Communicator&, RayScene& scene)
{
  if (!this->Bricks)
  {
    return;
  }
  this->Balancer.BeginFrame(scene, *this->Bricks);
  this->ZoneCells = this->Balancer.Zones();
}

void SeriesField::ReadAhead(const RayScene& scene, const Box& cells)
{
  if (!this->Bricks)
  {
    return;
  }
  try
  {
    BrickCache& cache = BrickCache::Of(*this->Series);
    if (!this->Ahead || &this->Ahead->DecodesInto() != &cache)
    {
      this->Ahead = std::make_unique<TimeStepPrefetcher>(cache, ThreadPool::Process().Width());
      this->Ahead->Drawing(*this->Series, this->Drawn.Step);
    }
    this->Ahead->Drawn(this->Series, scene, Intersection(cells, scene.DomainCells), *this->Bricks);
    auto* const source = dynamic_cast<SeriesBrickSource*>(this->Bricks.get());
    std::vector<FieldBricks> coming;
    if (source)
    {
      coming = this->View.Expected(scene, *source, cells);
    }
    if (this->Ahead->Next() < 0 && !coming.empty())
    {
      this->Ahead->Work().Start(this->Series, std::move(coming), cache.Budget() / 4);
    }
  }
  catch (const std::exception&)
  {
    this->Ahead.reset(); // no threads, no memory: bricks are decoded when they are asked for
  }
}

DrawnField::Place SeriesField::InSeries() const
{
  if (!this->Bricks)
  {
    return {};
  }
  Digest field;
  field.Add(this->Series->Fingerprint());
  field.Add(this->Drawn.Array);
  field.Add(this->Drawn.Component);
  field.Add(this->Drawn.Level);
  field.Add(this->Enhancement);
  return { this->Drawn.Step + this->Fraction, this->Series->Index().Steps(), field.Get() };
}

std::unique_ptr<BrickSource> SeriesField::SourceOfStep(int step)
{
  if (this->Bricks && this->Bricks->Hidden())
  {
    return nullptr; // what is hidden is known of this step alone
  }
  FieldKey key = this->Drawn;
  key.Step = step;
  return MakeSeriesSource(this->Series, key, this->Drawn.Component, this->Enhancement);
}

std::vector<Hash128> SeriesField::VisibleContent(const RayScene& scene)
{
  return this->Bricks
           ? banyan::VisibleContent(scene, *this->Bricks, CoarsestLevelOf(scene.DomainCells.Size()))
           : std::vector<Hash128>();
}

ValueRange SeriesField::RangeHere()
{
  ValueRange range;
  if (this->Bricks)
  {
    const MaskRange all = this->Bricks->MasksAreOver();
    range = { all.Low, all.High };
  }
  return range;
}

std::uint64_t SeriesField::BytesRead() const
{
  return this->Series ? this->Series->BytesRead() : 0;
}

} // namespace banyan
