#include "Render/BrickSource.h"

#include "Render/SampledBox.h"

#include <vector>

namespace banyan
{
namespace
{

bool IsUniform(const BrickView& view)
{
  return view.Stride[0] == 0 && view.Stride[1] == 0 && view.Stride[2] == 0;
}

} // namespace

std::optional<UniformValue> BrickSource::UniformValueOf(std::int64_t) const
{
  return std::nullopt;
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
  }
  return (this->Levels[level] = std::move(source)).get();
}

std::unique_ptr<BrickSource> BrickSource::MakeLevel(int, const Box&)
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
      const std::int64_t number = p.x + counts.x * (p.y + std::int64_t{ counts.y } * p.z);
      const Box cells = this->CellsOf(number);
      neighbours.push_back({ this->Load(number), { cells.Lo, cells.Hi + 1 } });
    }
  }
  // Bricks of one value may come in another type, which holds the value all the same.
  ScalarType type = neighbours.front().View.Type;
  for (const SampledBox& neighbour : neighbours)
  {
    type = IsUniform(neighbour.View) ? type : neighbour.View.Type;
  }
  return Assemble(neighbours, samples, type);
}

} // namespace banyan
