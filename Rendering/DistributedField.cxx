// SPDX-License-Identifier: BSD-3-Clause
#include "DistributedFieldFacts.h"

#include "MeshField.h"
#include "MotionEnhancement.h"
#include "ToleranceControl.h"

#include "Cache/BrickCache.h"
#include "Parallel/Fields/PieceField.h"
#include "Render/Bricks/SeriesBrickSource.h"
#include "Render/Bricks/TimeStepPrefetcher.h"
#include "vtkBanyanDeferred.h"

#include "vtkDataArray.h"
#include "vtkDataObject.h"
#include "vtkImageData.h"
#include "vtkUnstructuredGrid.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

/// Samples per axis of a level as the reader gives them to VTK: those that are also fine ones.
glm::ivec3 ExposedSamples(const SeriesFile& series, int level)
{
  const glm::ivec3 fine = series.Index().Domain.Samples();
  return glm::ivec3(
    ((fine.x - 1) >> level) + 1, ((fine.y - 1) >> level) + 1, ((fine.z - 1) >> level) + 1);
}

} // namespace

DistributedField::DistributedField() = default;
DistributedField::~DistributedField() = default;

void DistributedField::Reset()
{
  this->Fresh = true;
}

std::uint64_t DistributedField::BytesRead() const
{
  return this->Series ? this->Series->BytesRead() : 0;
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
      this->Bricks.reset();
      this->Domain = Box{};
    }
    this->AgreeOnRange(communicator);
  }
}

void DistributedField::SetGrid(const Facts& facts, const Box& samples)
{
  const Grid grid = facts.Geometry();
  this->Domain = { glm::ivec3(0), samples.Size() - 1 };
  glm::dmat4 matrix(1.0);
  this->ShortestEdge = std::numeric_limits<double>::infinity();
  for (int axis = 0; axis < 3; ++axis)
  {
    matrix[axis] = glm::dvec4(grid.Direction[axis] * grid.Spacing[axis], 0.0);
    this->ShortestEdge = std::min(this->ShortestEdge, std::abs(grid.Spacing[axis]));
  }
  const glm::dvec3 first = grid.Origin + grid.Direction * (grid.Spacing * glm::dvec3(samples.Lo));
  matrix[3] = glm::dvec4(first, 1.0);
  this->IndexToPhysicalMatrix = matrix;

  glm::dvec3 low(std::numeric_limits<double>::infinity());
  glm::dvec3 high = -low;
  for (int corner = 0; corner < 8; ++corner)
  {
    const glm::dvec4 index((corner & 1) ? this->Domain.Hi.x : 0,
      (corner & 2) ? this->Domain.Hi.y : 0, (corner & 4) ? this->Domain.Hi.z : 0, 1.0);
    const glm::dvec3 point(matrix * index);
    low = glm::min(low, point);
    high = glm::max(high, point);
  }
  this->PhysicalBounds = { { low.x, high.x, low.y, high.y, low.z, high.z } };
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

  this->Bricks.reset();
  this->Domain = Box{};
  this->PhysicalBounds = { { 1, -1, 1, -1, 1, -1 } };
  this->ZoneCells.assign(all.size(), Box{});
  const auto first =
    std::find_if(all.begin(), all.end(), [](const Facts& facts) { return facts.HasData != 0; });
  if (first == all.end())
  {
    this->Series.reset();
    this->Pieces.reset();
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
  }
  this->SetGrid(*first, samples);

  const bool deferred = std::all_of(all.begin(), all.end(),
    [](const Facts& facts) { return facts.HasData == 0 || facts.Deferred != 0; });
  for (const Facts& facts : all)
  {
    this->LargestEncodingError = std::max(this->LargestEncodingError, facts.EncodingError);
  }
  // Which series it is must be agreed as well; strings do not fit into the facts.
  const vtkBanyanDeferred::Handle* handle =
    deferred && mine.HasData ? vtkBanyanDeferred::From(piece.Array) : nullptr;
  const std::shared_ptr<const SeriesFile> held = handle ? handle->Series : nullptr;
  if (deferred && this->TakeSeries(communicator, held, all, samples))
  {
    this->Pieces.reset();
  }
  else
  {
    this->TakePlain(communicator, piece, all, samples, deferred);
  }
  if (std::any_of(
        all.begin(), all.end(), [](const Facts& facts) { return facts.HiddenCells != 0; }))
  {
    this->HideCells(communicator, piece, samples.Lo);
  }
}

/// Values in memory, of all pieces.
/// @param deferred whether they could be those of a series
void DistributedField::TakePlain(Communicator& communicator, const FieldPiece& piece,
  const std::vector<Facts>& all, const Box& samples, bool deferred)
{
  this->Series.reset();
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
  this->TakePieces(communicator, piece, pieces, samples.Lo);
}

/// Collective. Draws from the file if all pieces come from the same field of the same series and
/// together are all of it.
bool DistributedField::TakeSeries(Communicator& communicator,
  const std::shared_ptr<const SeriesFile>& held, const std::vector<Facts>& all, const Box& samples)
{
  const std::vector<std::string> paths =
    AllGatherStrings(communicator, held ? held->Path() : std::string());
  const std::vector<std::string> fingerprints =
    AllGatherStrings(communicator, held ? ToHex(held->Fingerprint()) : std::string());
  const Facts* first = nullptr;
  std::string path, fingerprint;
  for (std::size_t rank = 0; rank < all.size(); ++rank)
  {
    const Facts& facts = all[rank];
    if (!facts.HasData)
    {
      continue;
    }
    if (!first)
    {
      first = &facts;
      path = paths[rank];
      fingerprint = fingerprints[rank];
    }
    if (paths[rank] != path || fingerprints[rank] != fingerprint || facts.Step != first->Step ||
        facts.Array != first->Array || facts.Component != first->Component ||
        facts.Level != first->Level)
    {
      return false;
    }
  }
  std::string failure;
  bool whole = false;
  try
  {
    if (held)
    {
      this->Series = held;
    }
    else if (!this->Series || this->Series->Path() != path ||
             ToHex(this->Series->Fingerprint()) != fingerprint)
    {
      this->Series = SeriesFile::Open(path);
      if (ToHex(this->Series->Fingerprint()) != fingerprint)
      {
        throw Error(
          "The series was replaced, or is not the same on all ranks: open it again", { path });
      }
    }
    whole = ExposedSamples(*this->Series, first->Level) == samples.Size();
    if (whole && this->ProblemText.empty())
    {
      this->MakeSeriesZones(*first, communicator);
    }
  }
  catch (const std::exception& error)
  {
    failure = error.what();
    whole = true;
  }
  if (!failure.empty() && this->ProblemText.empty())
  {
    this->ProblemText = failure;
  }
  return AllMax(communicator, whole ? 0.0 : 1.0) == 0.0;
}

void DistributedField::MakeSeriesZones(const Facts& field, Communicator& communicator)
{
  FieldKey key;
  key.Step = this->Step = field.Step;
  key.Array = field.Array;
  key.Level = field.Level;
  const BrickLayout layout = this->Series->Layout(field.Level);
  FrameBalancer::Field balanced;
  balanced.Cells = this->Domain.Hi;
  balanced.BrickCells = layout.BrickCells();
  balanced.CoarsestLevel = ToleranceControl::CoarsestLevel;
  balanced.BytesPerCell = static_cast<double>(
    SizeOf(this->Series->Index().Arrays.at(static_cast<std::size_t>(field.Array)).Type));
  this->Balancer.Start(this->Balancing, balanced, communicator.Size());
  this->ZoneCells = this->Balancer.Zones();
  // Ranks without a zone need it too: to know what can be seen of the others'.
  this->Bricks = MakeSeriesSource(this->Series, key, field.Component, this->Enhancement);
}

} // namespace banyan
