// SPDX-License-Identifier: BSD-3-Clause
#include "MeshStepAhead.h"

#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"

#include <exception>
#include <utility>

namespace banyan
{

void MeshStepAhead::Reading(const SeriesFile& series, int step)
{
  this->Stop();
  this->NextStep = this->Direction.Asked(series, step);
}

void MeshStepAhead::Read(
  const std::shared_ptr<const SeriesFile>& series, std::vector<FieldBricks> bricks) noexcept
{
  if (this->NextStep < 0)
  {
    return;
  }
  try
  {
    BrickCache& cache = BrickCache::Of(*series);
    for (FieldBricks& wanted : bricks)
    {
      wanted.Field.Step = this->NextStep;
    }
    if (!this->Decoder || this->DecodesInto != &cache)
    {
      this->Decoder = std::make_unique<BackgroundDecoder>(cache, ThreadPool::Process().Width());
      this->DecodesInto = &cache;
    }
    this->Decoder->Start(series, std::move(bricks), cache.Budget() / 2);
  }
  catch (const std::exception&)
  {
    this->Decoder.reset(); // no threads, no memory: steps are decoded when they are read
  }
}

void MeshStepAhead::Stop()
{
  if (this->Decoder)
  {
    this->Decoder->Stop();
  }
}

void MeshStepAhead::Finish()
{
  if (this->Decoder)
  {
    this->Decoder->Finish();
  }
}

} // namespace banyan
