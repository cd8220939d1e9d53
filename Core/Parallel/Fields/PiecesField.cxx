// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/PiecesField.h"

#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Series/Decode/CacheContext.h"

namespace banyan
{

void PiecesField::Take(Communicator& communicator, const std::vector<Box>& samples,
  const SampleArray& mine, const glm::ivec3& cells, int brickCells, LoadBalancing mode)
{
  if (!this->Pieces)
  {
    this->Pieces = std::make_unique<PieceField>(&BrickCache::Of(*CacheContext::Process()));
  }
  try
  {
    this->Pieces->Take(communicator, samples, mine, cells, brickCells, mode, ThreadPool::Process());
  }
  catch (...)
  {
    this->Pieces.reset();
    throw;
  }
}

void PiecesField::BeginFrame(Communicator& communicator, RayScene& scene)
{
  if (this->Pieces)
  {
    this->Pieces->BeginFrame(communicator, scene, CacheContext::Process()->DecodedBudgetBytes());
  }
}

void PiecesField::BringLevels(Communicator& communicator, const RayScene& scene, int coarsest)
{
  if (this->Pieces)
  {
    this->Pieces->BringLevels(communicator, scene, coarsest,
      CacheContext::Process()->DecodedBudgetBytes() / 8, ThreadPool::Process());
  }
}

void PiecesField::EndFrame(Communicator& communicator)
{
  if (this->Pieces)
  {
    this->Pieces->EndFrame(communicator);
  }
}

const std::vector<Box>& PiecesField::Zones() const
{
  static const std::vector<Box> none;
  return this->Pieces ? this->Pieces->Zones() : none;
}

DrawnField::Movement PiecesField::Moved() const
{
  Movement moved;
  if (this->Pieces)
  {
    const PieceField::Statistics& numbers = this->Pieces->FrameStatistics();
    moved = { static_cast<double>(numbers.BytesMoved), numbers.Hits, numbers.Misses,
      this->Pieces->FetchedBytes() };
  }
  return moved;
}

} // namespace banyan
