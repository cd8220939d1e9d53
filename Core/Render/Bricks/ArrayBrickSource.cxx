// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/ArrayBrickSource.h"

#include "Base/Error.h"
#include "Base/ThreadPool.h"
#include "Render/Bricks/SampledBox.h"
#include "Render/Scene/LevelEdges.h"

#include <algorithm>

namespace banyan
{
namespace
{

glm::ivec3 PositionOf(std::int64_t brick, const glm::ivec3& counts)
{
  return { static_cast<int>(brick % counts.x), static_cast<int>(brick / counts.x % counts.y),
    static_cast<int>(brick / counts.x / counts.y) };
}

} // namespace

ArrayBrickSource::ArrayBrickSource(
  const SampleArray& array, int brickCells, const MaskRange& masks, ThreadPool& pool)
  : Values(std::make_shared<ArraySamples>(array))
  , BrickCells(brickCells)
  , Over(masks)
{
  if (brickCells < 1)
  {
    throw Error("A brick needs at least one cell per axis");
  }
  if (array.Samples.Empty())
  {
    this->BrickCounts = glm::ivec3(0);
    return;
  }
  this->Cells = { array.Samples.Lo, array.Samples.Hi - 1 };
  this->Held = array.Samples.Size();
  this->CutIntoBricks();
  std::vector<Box> boxes;
  for (std::size_t brick = 0; brick < this->Ranges.size(); ++brick)
  {
    boxes.push_back(this->SamplesOf(static_cast<std::int64_t>(brick)));
  }
  const std::vector<BoxSummary> summaries = this->Values->Summarize(boxes, this->Over, pool);
  for (std::size_t brick = 0; brick < summaries.size(); ++brick)
  {
    this->Ranges[brick] = summaries[brick].Range;
    this->Masks[brick] = summaries[brick].Mask;
    this->Uniform[brick] = summaries[brick].Uniform ? 1 : 0;
  }
}

ArrayBrickSource::ArrayBrickSource(const ArrayBrickSource& finest, const glm::ivec3& edges)
  : Values(finest.Values)
  , Every(edges)
  , BrickCells(finest.BrickCells)
  , Over(finest.Over)
{
  this->Cells = { glm::ivec3(0), (finest.Cells.Hi + this->Every - 1) / this->Every };
  this->Held = this->Cells.Hi + 1;
  this->CutIntoBricks();
  std::fill(this->Uniform.begin(), this->Uniform.end(), std::uint8_t{ 1 });
  for (std::size_t fine = 0; fine < finest.Ranges.size(); ++fine)
  {
    const glm::ivec3 position =
      PositionOf(static_cast<std::int64_t>(fine), finest.BrickCounts) / this->Every;
    const auto brick = static_cast<std::size_t>(NumberOf(position, this->BrickCounts));
    this->Ranges[brick].Include(finest.Ranges[fine]);
    this->Masks[brick] |= finest.Masks[fine];
    this->Uniform[brick] &= finest.Uniform[fine];
  }
}

std::unique_ptr<BrickSource> ArrayBrickSource::MakeLevel(int level, const Box& domain)
{
  const bool whole = this->Cells == domain && domain.Lo == glm::ivec3(0) && !domain.Empty();
  if (!whole || level >= 30)
  {
    return nullptr;
  }
  const glm::ivec3 edges = LevelEdges::Following(domain.Size()).At(level);
  return std::unique_ptr<BrickSource>(new ArrayBrickSource(*this, edges));
}

void ArrayBrickSource::CutIntoBricks()
{
  this->FirstBrick = this->Cells.Lo / this->BrickCells;
  const glm::ivec3 lastCell = glm::max(this->Cells.Hi - 1, this->Cells.Lo);
  this->BrickCounts = lastCell / this->BrickCells - this->FirstBrick + 1;
  const std::size_t count =
    static_cast<std::size_t>(this->BrickCounts.x) * this->BrickCounts.y * this->BrickCounts.z;
  this->Ranges.resize(count);
  this->Masks.resize(count);
  this->Uniform.resize(count);
}

Box ArrayBrickSource::CellsOf(std::int64_t brick) const
{
  const glm::ivec3 low =
    (this->FirstBrick + PositionOf(brick, this->BrickCounts)) * this->BrickCells;
  return Intersection(Box{ low, low + this->BrickCells }, this->Cells);
}

/// Positions in the array, from 0, with the layer that neighbours share.
Box ArrayBrickSource::SamplesOf(std::int64_t brick) const
{
  const Box cells = this->CellsOf(brick);
  return { cells.Lo - this->Values->Array().Samples.Lo,
    cells.Hi + 1 - this->Values->Array().Samples.Lo };
}

/// Signs of zeros and the rounding of magnitudes do not matter: zeros find one entry of a table,
/// and magnitudes are not known. Nor are colours, which differ where opacities are equal.
std::optional<UniformValue> ArrayBrickSource::UniformValueOf(std::int64_t brick) const
{
  const ValueRange& range = this->Ranges[brick];
  const bool known = this->Uniform[brick] != 0 && range.Low == range.High;
  if (!known || this->Values->Array().Component < 0)
  {
    return std::nullopt;
  }
  return UniformValue{ range.Low, this->Values->Array().Type };
}

std::optional<Hash128> ArrayBrickSource::ContentOf(std::int64_t brick) const
{
  return this->Contents.empty() ? std::nullopt : this->Contents[static_cast<std::size_t>(brick)];
}

void ArrayBrickSource::LookAt(const std::vector<std::int64_t>& bricks)
{
  this->Contents.resize(this->Ranges.size());
  ThreadPool::Process().ParallelFor(static_cast<std::int64_t>(bricks.size()),
    [&](std::int64_t i)
    {
      const std::int64_t brick = bricks[static_cast<std::size_t>(i)];
      std::optional<Hash128>& content = this->Contents[static_cast<std::size_t>(brick)];
      if (!content)
      {
        content = HashOfSamples(this->Load(brick), this->SamplesOf(brick).Size());
      }
    });
}

std::size_t ArrayBrickSource::LoadBytes(std::int64_t brick) const
{
  return this->Values->ViewBytes(this->SamplesOf(brick), this->Every);
}

BrickView ArrayBrickSource::Load(std::int64_t brick)
{
  return this->Values->View(this->SamplesOf(brick), this->Every);
}

BrickView ArrayBrickSource::LoadAround(std::int64_t brick, Box& samples)
{
  const Box own = this->SamplesOf(brick);
  return this->ViewOf({ own.Lo - 1, own.Hi + 1 }, samples);
}

BrickView ArrayBrickSource::LoadTogether(const Box& bricks, bool around, Box& samples)
{
  const Box own{ this->SamplesOf(NumberOf(bricks.Lo, this->BrickCounts)).Lo,
    this->SamplesOf(NumberOf(bricks.Hi - 1, this->BrickCounts)).Hi };
  const int layer = around ? 1 : 0;
  return this->ViewOf({ own.Lo - layer, own.Hi + layer }, samples);
}

/// @param wanted positions in the array, of which some may be beyond it
/// @param samples set to those that the view has
BrickView ArrayBrickSource::ViewOf(const Box& wanted, Box& samples) const
{
  const Box part = Intersection(wanted, { glm::ivec3(0), this->Held });
  const glm::ivec3& first = this->Values->Array().Samples.Lo;
  samples = { part.Lo + first, part.Hi + first };
  return this->Values->View(part, this->Every);
}

} // namespace banyan
