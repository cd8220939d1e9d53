// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/DistributedField.h"

#include "Base/ThreadPool.h"
#include "Parallel/Communicate/Collective.h"
#include "Parallel/Fields/PiecesField.h"
#include "Parallel/Fields/SeriesField.h"
#include "Parallel/Fields/WholeField.h"
#include "Render/Bricks/ArrayBrickSource.h"
#include "Series/Decode/CacheContext.h"

#include <algorithm>
#include <utility>

namespace banyan
{
namespace
{

/// Most cells per axis of the bricks that plain data is cut into.
constexpr int PlainBrickCells = 16;

std::unique_ptr<ArrayBrickSource> BricksOf(const SampleArray& samples)
{
  ThreadPool& pool = ThreadPool::Process();
  const ValueRange range = FiniteRange(samples, pool);
  const MaskRange masks = range.Empty() ? MaskRange{} : MaskRange{ range.Low, range.High };
  return std::make_unique<ArrayBrickSource>(samples, PlainBrickCells, masks, pool);
}

const PieceFacts& FactsHere(const std::vector<PieceFacts>& all, const Communicator& communicator)
{
  return all[static_cast<std::size_t>(communicator.Rank())];
}

} // namespace

DistributedField::DistributedField()
  : Field(std::make_unique<WholeField>())
{
}

DistributedField::~DistributedField() = default;

void DistributedField::Reset()
{
  this->Stamp = InputStamp();
}

void DistributedField::SetLoadBalancing(LoadBalancing mode)
{
  if (mode != this->Balancing)
  {
    this->Balancing = mode;
    this->Reset();
  }
}

std::uint64_t DistributedField::DrawingBudget()
{
  // Less than the cache has: what one batch holds is then never evicted by that batch itself.
  constexpr std::uint64_t least = std::uint64_t{ 16 } << 20;
  BrickSource* const source = this->Field->Source();
  return std::max(
    source ? source->Kept().ShareBytes() : CacheContext::Process()->DrawingBudgetBytes(), least);
}

const std::vector<Hash128>& DistributedField::VisibleContent(const RayScene& scene, bool looks)
{
  KnownContent& known = this->Known;
  if (known.Version != this->Updates || !(known.Transfer == scene.Transfer) ||
      known.Blend != scene.Blend.Mode || known.Shaded != scene.Shading.On || known.Looked != looks)
  {
    known.Version = 0;
    known.Levels.clear();
    if (looks || this->Field->IsEncoded() || this->Field->IsMesh())
    {
      known.Levels = this->Field->VisibleContent(scene);
    }
    if (known.Levels.empty())
    {
      // The number of bytes tells it from a hash of contents.
      known.Levels = { HashOf(&this->Updates, sizeof(this->Updates)) };
    }
    known.Transfer = scene.Transfer;
    known.Blend = scene.Blend.Mode;
    known.Shaded = scene.Shading.On;
    known.Looked = looks;
    known.Version = this->Updates;
  }
  return known.Levels;
}

/// The field, which is another one if it was of another kind.
template <class Kind>
Kind& DistributedField::Become()
{
  auto* field = dynamic_cast<Kind*>(this->Field.get());
  if (!field)
  {
    this->Field = std::make_unique<WholeField>(); // not two of them at once
    auto made = std::make_unique<Kind>();
    field = made.get();
    this->Field = std::move(made);
  }
  return *field;
}

void DistributedField::Update(Communicator& communicator, FieldInput& input)
{
  if (!this->Stamp.Become(communicator, input.Stamp()))
  {
    return;
  }
  ++this->Updates;
  this->LargestEncodingError = 0.0;
  this->Colours = false;
  this->ProblemText.clear();
  try
  {
    Collective(communicator, [&] { this->Take(communicator, input); });
  }
  catch (const CollectiveError& error)
  {
    this->ProblemText = error.what();
    this->Field->Clear();
    this->Where = FieldPlace{};
  }
  const ValueRange range = this->Field->RangeHere();
  this->ValuesRange.Low = -AllMax(communicator, -range.Low);
  this->ValuesRange.High = AllMax(communicator, range.High);
}

bool DistributedField::IsOf(const FieldInput& input) const
{
  return this->Stamp == input.Stamp();
}

void DistributedField::Take(Communicator& communicator, FieldInput& input)
{
  PieceFacts mine;
  Collective(communicator, [&] { mine = input.Facts(); });
  std::vector<PieceFacts> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());
  this->Where = FieldPlace{};
  if (std::any_of(all.begin(), all.end(), [](const PieceFacts& facts) { return facts.IsMesh(); }))
  {
    this->TakeMesh(communicator, input, all);
  }
  else if (std::any_of(
             all.begin(), all.end(), [](const PieceFacts& facts) { return facts.IsImage(); }))
  {
    this->TakeImages(communicator, input, all);
  }
  else
  {
    this->Become<WholeField>().Clear();
  }
}

/// Collective, where some rank has a mesh.
void DistributedField::TakeMesh(
  Communicator& communicator, FieldInput& input, const std::vector<PieceFacts>& all)
{
  ThrowTogether(communicator, FactsHere(all, communicator).IsImage()
                                ? "One rank has image data and another one a mesh of cells."
                                : "");
  const auto some = [&](PieceFacts::Kind kind)
  {
    return std::any_of(
      all.begin(), all.end(), [&](const PieceFacts& facts) { return facts.Has == kind; });
  };
  const bool leaves = some(PieceFacts::Kind::Leaves);
  const bool keeps = !leaves && AllMax(communicator, input.KeepsCellValues() ? 1.0 : 0.0) >
                                  0.0; // octrees have means
  if (leaves ||
      (!keeps && !some(PieceFacts::Kind::Cells) && !this->HasBeenCells(communicator, input)))
  {
    if (this->TakeOctree(communicator, input, leaves))
    {
      return;
    }
  }
  auto& field = this->Become<CellsField>();
  field.Clear();
  CellsField::Piece cells;
  Collective(communicator, [&] { cells = input.Cells(); });
  const bool has = field.Has(communicator, cells.Mesh);
  field.Take(communicator, std::move(cells), has);
  this->NoOctreeAt = keeps ? NotTried : input.MeshTolerance();
  this->Where = field.Place();
}

/// Collective: whether the mesh was taken before, and was no octree.
bool DistributedField::HasBeenCells(Communicator& communicator, FieldInput& input)
{
  auto* const field = dynamic_cast<CellsField*>(this->Field.get());
  if (!field || input.MeshTolerance() != this->NoOctreeAt)
  {
    return false;
  }
  CellMesh mesh;
  Collective(communicator, [&] { mesh = input.Cells().Mesh; });
  return field->Has(communicator, mesh);
}

/// Collective. @return false when the mesh is no octree
bool DistributedField::TakeOctree(Communicator& communicator, FieldInput& input, bool leaves)
{
  auto& field = this->Become<MeshField>();
  field.Clear();
  try
  {
    MeshField::Piece cells;
    Collective(communicator, [&] { cells = input.Mesh(communicator, leaves); });
    field.Take(communicator, std::move(cells), input.MeshTolerance(), this->Balancing);
  }
  catch (const CollectiveError&)
  {
    if (leaves)
    {
      throw;
    }
    return false; // whatever is wrong with it, cells say so
  }
  this->Where = field.Place();
  return true;
}

/// Collective, where some rank has an image, and none a mesh.
void DistributedField::TakeImages(
  Communicator& communicator, FieldInput& input, const std::vector<PieceFacts>& all)
{
  const auto first =
    std::find_if(all.begin(), all.end(), [](const PieceFacts& facts) { return facts.IsImage(); });
  const PieceFacts& mine = FactsHere(all, communicator);
  ThrowTogether(communicator,
    mine.IsImage() ? mine.DifferenceFrom(*first, static_cast<int>(first - all.begin())) : "");
  Box samples;
  bool deferred = true;
  bool hidden = false;
  bool between = false;
  for (const PieceFacts& facts : all)
  {
    if (facts.IsImage())
    {
      samples = Union(samples, facts.Samples());
      deferred = deferred && facts.Deferred != 0;
      hidden = hidden || facts.HiddenCells != 0;
      between = between || facts.Fraction > 0.0;
      this->LargestEncodingError = std::max(this->LargestEncodingError, facts.EncodingError);
    }
  }
  if (between && input.Enhancement().Strength > 0.0)
  {
    throw Error("Temporal enhancement compares time steps, and these values lie between two: ask "
                "the reader for the time of a step, or switch off 'Interpolate In Time' or the "
                "enhancement.");
  }
  this->Colours = first->Component == SampleArray::Colours;
  this->Where = PlaceOfSamples(first->Geometry(), samples);
  if (!deferred || !this->TakeSeries(communicator, input, all, samples))
  {
    if (deferred && input.Enhancement().Strength > 0.0)
    {
      throw Error("Only whole steps of an encoded series can be enhanced while they are drawn: put "
                  "the filter 'Banyan Temporal Enhancement' behind the reader.");
    }
    this->TakeSamples(communicator, input, all, samples);
  }
  if (hidden)
  {
    this->HideCells(communicator, input, mine.HiddenCells != 0, samples.Lo);
  }
}

/// Collective. @return false when the pieces are not all of one step of a series
bool DistributedField::TakeSeries(Communicator& communicator, const FieldInput& input,
  const std::vector<PieceFacts>& all, const Box& samples)
{
  std::vector<SeriesField::Piece> pieces;
  pieces.reserve(all.size());
  for (const PieceFacts& facts : all)
  {
    pieces.push_back(
      { facts.IsImage(), facts.Step, facts.Array, facts.Component, facts.Level, facts.Fraction });
  }
  // Another kind of field keeps what it knows until this one fits.
  auto* const drawn = dynamic_cast<SeriesField*>(this->Field.get());
  auto made = drawn ? nullptr : std::make_unique<SeriesField>();
  std::string failure;
  const bool fits =
    (drawn ? drawn : made.get())
      ->Take(communicator, FactsHere(all, communicator).IsImage() ? input.Series() : nullptr,
        pieces, { samples, this->Balancing, input.Enhancement() }, failure);
  if (fits && made)
  {
    this->Field = std::move(made);
  }
  ThrowTogether(communicator, failure);
  return fits;
}

/// Collective: values in memory, of all pieces.
void DistributedField::TakeSamples(Communicator& communicator, const FieldInput& input,
  const std::vector<PieceFacts>& all, const Box& samples)
{
  const bool alone = communicator.Size() == 1;
  if (alone)
  {
    this->Become<WholeField>().LetGoOfValues();
  }
  else
  {
    this->Become<PiecesField>();
  }
  SampleArray mine;
  Collective(communicator,
    [&]
    {
      if (FactsHere(all, communicator).IsImage())
      {
        mine = input.Samples(samples.Lo);
      }
    });
  if (alone)
  {
    this->Become<WholeField>().Take(BricksOf(mine), this->Where.Cells);
    return;
  }
  std::vector<Box> pieces;
  for (const PieceFacts& facts : all)
  {
    const Box own = facts.Samples();
    pieces.push_back(facts.IsImage() ? Box{ own.Lo - samples.Lo, own.Hi - samples.Lo } : Box{});
  }
  this->Become<PiecesField>().Take(
    communicator, pieces, mine, this->Where.Cells.Hi, PlainBrickCells, this->Balancing);
}

/// Collective, where some cell of some rank is hidden: in the pieces of all ranks. Where pieces
/// overlap, a cell is hidden that is hidden in one of them.
/// @param here whether some are of this rank's piece
void DistributedField::HideCells(
  Communicator& communicator, const FieldInput& input, bool here, const glm::ivec3& first)
{
  const auto hidden = std::make_shared<HiddenCells>(this->Where.Cells.Hi);
  std::string mine;
  Collective(communicator,
    [&]
    {
      if (here)
      {
        input.HideCells(first, *hidden);
        mine = hidden->ToBytes();
      }
    });
  for (const std::string& bytes : AllGatherStrings(communicator, mine))
  {
    hidden->Add(bytes);
  }
  if (BrickSource* const source = this->Field->Source())
  {
    source->Hide(hidden);
  }
}

} // namespace banyan
