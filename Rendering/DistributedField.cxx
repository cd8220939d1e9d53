// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedFieldFacts.h"

#include "GridOfLeaves.h"
#include "HiddenInImage.h"
#include "PieceOfMesh.h"
#include "PlainSource.h"

#include "Cache/BrickCache.h"
#include "Parallel/Fields/PiecesField.h"
#include "Parallel/Fields/SeriesField.h"
#include "Parallel/Fields/WholeField.h"
#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <utility>

namespace banyan
{

DistributedField::DistributedField()
  : Field(std::make_unique<WholeField>())
{
}

DistributedField::~DistributedField() = default;

void DistributedField::Reset()
{
  this->Fresh = true;
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
  const std::uint64_t all = BrickCache::Process().DrawingBudget();
  return std::max(this->Source() ? this->Source()->Kept().ShareOf(all) : all, least);
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

bool DistributedField::ChangedHere(const FieldPiece& piece)
{
  const std::array<std::uint64_t, 10> stamp{ { reinterpret_cast<std::uintptr_t>(piece.Image),
    piece.Image ? piece.Image->GetMTime() : 0, reinterpret_cast<std::uintptr_t>(piece.Array),
    piece.Array ? piece.Array->GetMTime() : 0, static_cast<std::uint64_t>(piece.Component + 1),
    reinterpret_cast<std::uintptr_t>(piece.Grid), piece.Grid ? piece.Grid->GetMTime() : 0,
    reinterpret_cast<std::uintptr_t>(piece.Leaves), piece.Leaves ? piece.Leaves->GetMTime() : 0,
    static_cast<std::uint64_t>(piece.Where) } };
  const bool changed =
    this->Fresh || stamp != this->Stamp || !(piece.Mesh == this->StampedOptions) ||
    piece.Enhancement.Strength != this->Enhancement.Strength ||
    piece.Enhancement.Scale != this->Enhancement.Scale || piece.Problem != this->PieceProblem;
  this->StampedOptions = piece.Mesh;
  this->Enhancement = piece.Enhancement;
  this->Stamp = stamp;
  this->PieceProblem = piece.Problem;
  this->Fresh = false;
  return changed;
}

void DistributedField::Update(Communicator& communicator, const FieldPiece& piece)
{
  const bool changed = this->ChangedHere(piece);
  if (AllMax(communicator, changed ? 1.0 : 0.0) > 0.0)
  {
    ++this->Updates;
    this->LargestEncodingError = 0.0;
    this->ProblemText = piece.Problem;
    if (!this->TakeMesh(communicator, piece))
    {
      this->Agree(communicator, piece);
    }
    // One rank may have failed alone, at the end: what there is to draw is nothing on all of them
    // then.
    if (!AgreeOnError(communicator, this->ProblemText).empty())
    {
      this->Field->Clear();
      this->Place = FieldPlace{};
    }
    this->AgreeOnRange(communicator);
  }
}

/// Collective. @return false when no rank has a mesh
bool DistributedField::TakeMesh(Communicator& communicator, FieldPiece piece)
{
  const double mine = piece.Leaves ? 2.0 : piece.Grid ? 1.0 : 0.0;
  const double most = AllMax(communicator, mine);
  if (most == 0.0)
  {
    return false;
  }
  auto& field = this->Become<MeshField>();
  field.Clear();
  this->Place = FieldPlace{};
  if (this->ProblemText.empty() && piece.Image)
  {
    this->ProblemText = "One rank has image data and another one hexahedra.";
  }
  // Nobody waits for a rank that has nothing to give.
  if (!AgreeOnError(communicator, this->ProblemText).empty())
  {
    return true;
  }
  try
  {
    vtkSmartPointer<vtkUnstructuredGrid> leaves;
    if (most == 2.0)
    {
      TakeLeaves(communicator, piece, leaves);
    }
    MeshField::Piece cells;
    vtkSmartPointer<vtkDataArray> kept;
    std::string failure;
    try
    {
      cells = PieceOfMesh(piece, kept);
    }
    catch (const std::exception& error)
    {
      failure = error.what();
    }
    field.Take(communicator, cells, piece.Mesh, this->Balancing, failure);
    this->Place = field.Place();
  }
  catch (const std::exception& error)
  {
    this->ProblemText = error.what();
  }
  return true;
}

void DistributedField::Agree(Communicator& communicator, const FieldPiece& piece)
{
  Facts mine;
  try
  {
    mine = this->FactsOf(piece);
  }
  catch (const std::exception& error)
  {
    this->ProblemText = error.what();
  }
  std::vector<Facts> all(static_cast<std::size_t>(communicator.Size()));
  communicator.AllGather(&mine, sizeof(mine), all.data());

  this->Place = FieldPlace{};
  const auto first =
    std::find_if(all.begin(), all.end(), [](const Facts& facts) { return facts.HasData != 0; });
  if (first == all.end())
  {
    this->Become<WholeField>().Clear();
    return;
  }
  if (mine.HasData && this->ProblemText.empty())
  {
    this->ProblemText = this->CheckAgainst(mine, *first, static_cast<int>(first - all.begin()));
  }
  Box samples;
  for (const Facts& facts : all)
  {
    samples = facts.HasData ? Union(samples, facts.Samples()) : samples;
    this->LargestEncodingError = std::max(this->LargestEncodingError, facts.EncodingError);
  }
  this->Place = PlaceOfSamples(first->Geometry(), samples);
  const bool deferred = std::all_of(all.begin(), all.end(),
    [](const Facts& facts) { return facts.HasData == 0 || facts.Deferred != 0; });
  if (!deferred || !this->TakeSeries(communicator, piece, all, samples))
  {
    this->TakePlain(communicator, piece, all, samples, deferred);
  }
  if (std::any_of(
        all.begin(), all.end(), [](const Facts& facts) { return facts.HiddenCells != 0; }))
  {
    this->HideCells(communicator, piece, samples.Lo);
  }
}

/// Collective. @return false when the pieces are not all of one step of a series
bool DistributedField::TakeSeries(Communicator& communicator, const FieldPiece& piece,
  const std::vector<Facts>& all, const Box& samples)
{
  std::vector<SeriesField::Piece> pieces;
  for (const Facts& facts : all)
  {
    pieces.push_back({ facts.HasData != 0, facts.Step, facts.Array, facts.Component, facts.Level });
  }
  const vtkBanyanDeferred::Handle* handle =
    all[static_cast<std::size_t>(communicator.Rank())].HasData
      ? vtkBanyanDeferred::From(piece.Array)
      : nullptr;
  // Another kind of field keeps what it knows until this one fits.
  auto* const drawn = dynamic_cast<SeriesField*>(this->Field.get());
  auto made = drawn ? nullptr : std::make_unique<SeriesField>();
  const bool fits = (drawn ? drawn : made.get())
                      ->Take(communicator, handle ? handle->Series : nullptr, pieces,
                        { samples, this->Balancing, this->Enhancement }, this->ProblemText);
  if (fits && made)
  {
    this->Field = std::move(made);
  }
  return fits;
}

/// Values in memory, of all pieces.
/// @param deferred whether they could be those of a series
void DistributedField::TakePlain(Communicator& communicator, const FieldPiece& piece,
  const std::vector<Facts>& all, const Box& samples, bool deferred)
{
  if (deferred && this->Enhancement.Strength > 0.0 && this->ProblemText.empty())
  {
    this->ProblemText =
      "Only whole steps of an encoded series can be enhanced while they are drawn: put "
      "the filter 'Banyan Temporal Enhancement' behind the reader.";
  }
  std::vector<Box> pieces;
  for (const Facts& facts : all)
  {
    const Box own = facts.Samples();
    pieces.push_back(facts.HasData ? Box{ own.Lo - samples.Lo, own.Hi - samples.Lo } : Box{});
  }
  this->TakeSamples(communicator, piece, pieces, samples.Lo);
}

void DistributedField::TakeSamples(Communicator& communicator, const FieldPiece& piece,
  const std::vector<Box>& pieces, const glm::ivec3& first)
{
  const bool alone = communicator.Size() == 1;
  DrawnField& field = alone ? static_cast<DrawnField&>(this->Become<WholeField>())
                            : static_cast<DrawnField&>(this->Become<PiecesField>());
  SampleArray mine;
  if (piece.Array && piece.Image && this->ProblemText.empty())
  {
    try
    {
      mine = PlainSamples(piece.Image, piece.Array, piece.Component, first);
    }
    catch (const std::exception& error)
    {
      this->ProblemText = error.what();
    }
  }
  // Nobody waits for a rank that has nothing to give.
  if (!AgreeOnError(communicator, this->ProblemText).empty())
  {
    field.Clear();
    return;
  }
  try
  {
    if (alone)
    {
      field.Clear();
      this->Become<WholeField>().Take(
        MakePlainSource(piece.Image, piece.Array, piece.Component, first), this->Place.Cells);
    }
    else
    {
      this->Become<PiecesField>().Take(
        communicator, pieces, mine, this->Place.Cells.Hi, PlainBrickCells, this->Balancing);
    }
  }
  catch (const std::exception& error)
  {
    this->ProblemText = error.what();
  }
}

/// Collective, where some cell of some rank is hidden.
void DistributedField::HideCells(
  Communicator& communicator, const FieldPiece& piece, const glm::ivec3& first)
{
  try
  {
    const std::shared_ptr<const HiddenCells> hidden = GatherHiddenCells(
      communicator, piece.Array ? piece.Image : nullptr, first, this->Place.Cells.Hi);
    if (BrickSource* const source = this->Source())
    {
      source->Hide(hidden);
    }
  }
  catch (const std::exception& error)
  {
    this->ProblemText = error.what();
  }
}

/// Agrees on the range of the values of all sources.
void DistributedField::AgreeOnRange(Communicator& communicator)
{
  const ValueRange range = this->Field->RangeHere();
  this->ValuesRange.Low = -AllMax(communicator, -range.Low);
  this->ValuesRange.High = AllMax(communicator, range.High);
}

} // namespace banyan
