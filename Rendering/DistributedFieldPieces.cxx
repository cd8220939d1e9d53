// SPDX-License-Identifier: BSD-3-Clause
// The part of DistributedField that is for plain image data.
#include "DistributedField.h"

#include "HiddenInImage.h"
#include "PlainSource.h"

#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Parallel/Fields/PieceField.h"
#include "Render/Bricks/TimeStepPrefetcher.h"

namespace banyan
{

/// Collective, where some cell of some rank is hidden.
void DistributedField::HideCells(
  Communicator& communicator, const FieldPiece& piece, const glm::ivec3& first)
{
  try
  {
    const std::shared_ptr<const HiddenCells> hidden =
      GatherHiddenCells(communicator, piece.Array ? piece.Image : nullptr, first, this->Domain.Hi);
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

/// Values that are in memory.
void DistributedField::TakePieces(Communicator& communicator, const FieldPiece& piece,
  const std::vector<Box>& pieces, const glm::ivec3& first)
{
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
    this->Pieces.reset();
    return;
  }
  try
  {
    if (communicator.Size() == 1)
    {
      this->ZoneCells = { this->Domain };
      this->Bricks = MakePlainSource(piece.Image, piece.Array, piece.Component, first);
      return;
    }
    if (!this->Pieces)
    {
      this->Pieces = std::make_unique<PieceField>(&BrickCache::Process());
    }
    this->Pieces->Take(communicator, pieces, mine, this->Domain.Hi, PlainBrickCells,
      this->Balancing, ThreadPool::Process());
  }
  catch (const std::exception& error)
  {
    this->Pieces.reset();
    this->ProblemText = error.what();
  }
}

/// Agrees on the range of the values of all sources.
void DistributedField::AgreeOnRange(Communicator& communicator)
{
  ValueRange range;
  if (this->Bricks && this->Series)
  {
    const MaskRange all = this->Bricks->MasksAreOver();
    range = { all.Low, all.High };
  }
  else if (const BrickSource* const source = this->Source())
  {
    const glm::ivec3 counts = source->Bricks();
    for (std::int64_t i = 0; i < std::int64_t{ counts.x } * counts.y * counts.z; ++i)
    {
      range.Include(source->RangeOf(i));
    }
  }
  this->ValuesRange.Low = -AllMax(communicator, -range.Low);
  this->ValuesRange.High = AllMax(communicator, range.High);
}

} // namespace banyan
