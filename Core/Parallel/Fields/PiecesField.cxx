// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Fields/PiecesField.h"

#include "Base/Digest.h"
#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"
#include "Render/Bricks/VisibleContent.h"
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
    this->Pieces->Take(
      communicator, samples, mine, cells, brickCells, mode, ThreadPool::Process(), this->Wanted);
    this->Wanted = false;
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

std::vector<Hash128> PiecesField::VisibleContent(const RayScene& scene)
{
  this->Wanted = true;
  if (!this->Pieces)
  {
    return {};
  }
  // Levels are made later in a frame. Their samples are some of the finest ones.
  PieceSource& source = *this->Pieces->Source();
  std::vector<Hash128> levels = banyan::VisibleContent(scene, source, 0);
  Digest all;
  for (std::int64_t brick = 0; !levels.empty() && brick < this->Pieces->Grid().Count(); ++brick)
  {
    const std::optional<Hash128> content = source.ContentOf(brick);
    if (!content)
    {
      return {};
    }
    all.Add(*content);
  }
  if (!levels.empty())
  {
    levels.push_back(all.Get());
  }
  return levels;
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
