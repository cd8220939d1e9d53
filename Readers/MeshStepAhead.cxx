#include "MeshStepAhead.h"

#include "Base/ThreadPool.h"
#include "Cache/BrickCache.h"

#include <exception>
#include <numeric>
#include <utility>

namespace banyan
{

void MeshStepAhead::Reading(const SeriesFile& series, int step)
{
  this->Stop();
  this->NextStep = this->Direction.Asked(series, step);
}

void MeshStepAhead::Read(
  const std::shared_ptr<const SeriesFile>& series, std::vector<FieldKey> fields) noexcept
{
  if (this->NextStep < 0)
  {
    return;
  }
  try
  {
    BrickCache& cache = BrickCache::Process();
    std::vector<FieldBricks> wanted;
    for (FieldKey& field : fields)
    {
      const glm::ivec3 counts = series->Layout(field.Level).Bricks();
      std::vector<std::int64_t> bricks(
        static_cast<std::size_t>(std::int64_t{ counts.x } * counts.y * counts.z));
      std::iota(bricks.begin(), bricks.end(), std::int64_t{ 0 });
      field.Step = this->NextStep;
      wanted.push_back({ field, std::move(bricks) });
    }
    if (!this->Decoder)
    {
      this->Decoder = std::make_unique<AheadDecoder>(cache, ThreadPool::Process().Width());
    }
    this->Decoder->Start(series, std::move(wanted), cache.DecodedBudget() / 2);
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
