// The part of DistributedField that is for plain image data.
#include "DistributedField.h"

#include "PlainSource.h"

#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Pieces/PieceField.h"
#include "Render/StepAhead.h"

namespace banyan
{

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

} // namespace banyan
