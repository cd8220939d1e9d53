// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/BrickSource.h"

#include "Render/Bricks/SampledBox.h"
#include "Render/Bricks/SummaryTree.h"
#include "Render/Scene/PictureCaster.h"

#include <optional>
#include <vector>

namespace banyan
{
namespace
{

bool IsUniform(const BrickView& view)
{
  return view.Stride[0] == 0 && view.Stride[1] == 0 && view.Stride[2] == 0;
}

/// Bricks of one value may come in another type, which holds the value all the same. Where the
/// others have several, float64 holds them all.
ScalarType TypeOf(const std::vector<SampledBox>& parts)
{
  std::optional<ScalarType> type;
  for (const SampledBox& part : parts)
  {
    if (!IsUniform(part.View))
    {
      type = type.value_or(part.View.Type) == part.View.Type ? part.View.Type : ScalarType::Float64;
    }
  }
  return type.value_or(parts.front().View.Type);
}

/// Which bricks of one level differ from those of another source.
class ChangedBricks
{
public:
  ChangedBricks(const BrickSource& before, BrickSource& now)
    : Now(now)
    , Counts(now.Bricks())
  {
    const std::int64_t all = std::int64_t{ this->Counts.x } * this->Counts.y * this->Counts.z;
    this->SameGrid = before.Bricks() == this->Counts && before.CellsOf(0) == now.CellsOf(0) &&
                     before.CellsOf(all - 1) == now.CellsOf(all - 1);
    this->SameRange = before.MasksAreOver() == now.MasksAreOver();
    std::vector<std::int64_t> known;
    for (std::int64_t brick = 0; this->SameGrid && brick < all; ++brick)
    {
      if (before.ContentOf(brick))
      {
        known.push_back(brick);
      }
    }
    now.LookAt(known);
    this->Changed.assign(static_cast<std::size_t>(all), true);
    for (const std::int64_t brick : known)
    {
      this->Changed[static_cast<std::size_t>(brick)] =
        now.ContentOf(brick) != before.ContentOf(brick);
    }
  }

  /// Whether what was packed has other values now.
  bool Touch(const PackedBrick& packed) const
  {
    // Gradients are packed in parts of the range of values.
    if (!this->SameGrid || (packed.HasGradients() && !this->SameRange))
    {
      return true;
    }
    const glm::ivec3 edge = this->Now.CellsOf(0).Size();
    const int layer = packed.HasGradients() ? 1 : 0;
    const Box cells = packed.Cells();
    const Box near = Intersection({ cells.Lo / edge - layer, (cells.Hi - 1) / edge + 1 + layer },
      { glm::ivec3(0), this->Counts });
    bool any = false;
    for (int z = near.Lo.z; z < near.Hi.z; ++z)
    {
      for (int y = near.Lo.y; y < near.Hi.y; ++y)
      {
        for (int x = near.Lo.x; x < near.Hi.x; ++x)
        {
          any = any || this->Changed[static_cast<std::size_t>(
                         BrickSource::NumberOf({ x, y, z }, this->Counts))];
        }
      }
    }
    return any;
  }

private:
  const BrickSource& Now;
  glm::ivec3 Counts;
  bool SameGrid = false;
  bool SameRange = false;
  std::vector<bool> Changed;
};

} // namespace

std::optional<UniformValue> BrickSource::UniformValueOf(std::int64_t) const
{
  return std::nullopt;
}

const SummaryTree* BrickSource::Summaries() const
{
  if (!this->IsGrid())
  {
    return nullptr;
  }
  std::call_once(this->SummariesMade,
    [this] { this->SummariesHere = std::make_shared<const SummaryTree>(*this); });
  return this->SummariesHere.get();
}

BrickSource* BrickSource::AtLevel(int level, const Box& domain)
{
  if (level == 0)
  {
    return this;
  }
  const std::lock_guard<std::mutex> lock(this->LevelsMutex);
  const auto found = this->Levels.find(level);
  if (found != this->Levels.end())
  {
    return found->second.get();
  }
  std::unique_ptr<BrickSource> source = this->MakeLevel(level, domain);
  if (source)
  {
    source->LevelNumber = level;
    source->KeptOfSource = this->KeptOfSource;
    if (this->HiddenHere && !source->HiddenHere)
    {
      source->Hide(
        std::make_shared<const HiddenCells>(this->HiddenHere->Coarser(source->CellEdges())));
    }
  }
  return (this->Levels[level] = std::move(source)).get();
}

void BrickSource::Hide(std::shared_ptr<const HiddenCells> hidden)
{
  this->HiddenHere = std::move(hidden);
  if (this->HiddenHere)
  {
    this->KeptOfSource->Clear(); // packed without
  }
}

void BrickSource::TakeKept(BrickSource& other, const Box& domain)
{
  if (other.HiddenHere || other.HasColours() != this->HasColours())
  {
    return; // packed without its cells, or without colours
  }
  this->KeptOfSource = other.KeptOfSource;
  std::map<int, std::unique_ptr<const ChangedBricks>> levels;
  this->KeptOfSource->LetGoOf(
    [&](std::int64_t kept, const PackedBrick& packed)
    {
      const int level = static_cast<int>(kept >> LevelShift);
      std::unique_ptr<const ChangedBricks>& changed = levels[level];
      if (!changed)
      {
        const BrickSource* const before = other.AtLevel(level, domain);
        BrickSource* const now = this->AtLevel(level, domain);
        if (!before || !now)
        {
          return true;
        }
        changed = std::make_unique<const ChangedBricks>(*before, *now);
      }
      return changed->Touch(packed);
    });
}

std::unique_ptr<BrickSource> BrickSource::MakeLevel(int, const Box&)
{
  return nullptr;
}

std::unique_ptr<PictureCaster> BrickSource::MakeCaster(
  const RayScene&, const Box&, ThreadPool&, RayStatistics&)
{
  return nullptr;
}

BrickView BrickSource::LoadAround(std::int64_t brick, Box& samples)
{
  const glm::ivec3 counts = this->Bricks();
  const glm::ivec3 position(static_cast<int>(brick % counts.x),
    static_cast<int>(brick / counts.x % counts.y), static_cast<int>(brick / counts.x / counts.y));
  const std::int64_t last = std::int64_t{ counts.x } * counts.y * counts.z - 1;
  const Box own = this->CellsOf(brick);
  samples =
    Intersection({ own.Lo - 1, own.Hi + 2 }, { this->CellsOf(0).Lo, this->CellsOf(last).Hi + 1 });

  std::vector<SampledBox> neighbours;
  for (int i = 0; i < 27; ++i)
  {
    const glm::ivec3 p = position + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
    if (Box{ glm::ivec3(0), counts }.Contains(p))
    {
      const std::int64_t number = NumberOf(p, counts);
      const Box cells = this->CellsOf(number);
      neighbours.push_back({ this->Load(number), { cells.Lo, cells.Hi + 1 } });
    }
  }
  return Assemble(neighbours, samples, TypeOf(neighbours));
}

BrickView BrickSource::LoadTogether(const Box& bricks, bool around, Box& samples)
{
  const glm::ivec3 counts = this->Bricks();
  const glm::ivec3 size = bricks.Size();
  std::vector<SampledBox> parts;
  samples = {};
  for (int i = 0; i < static_cast<int>(bricks.Count()); ++i)
  {
    const glm::ivec3 p =
      bricks.Lo + glm::ivec3(i % size.x, i / size.x % size.y, i / size.x / size.y);
    const std::int64_t number = NumberOf(p, counts);
    const Box cells = this->CellsOf(number);
    SampledBox part{ {}, { cells.Lo, cells.Hi + 1 } };
    part.View = around ? this->LoadAround(number, part.Samples) : this->Load(number);
    samples = Union(samples, part.Samples);
    parts.push_back(std::move(part));
  }
  return parts.size() == 1 ? parts.front().View : Assemble(parts, samples, TypeOf(parts));
}

Box CellsAtLevel(const Box& cells, const glm::ivec3& edges)
{
  return { (cells.Lo + edges - 1) / edges, (cells.Hi + edges - 1) / edges };
}

} // namespace banyan
