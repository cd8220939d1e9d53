#include "Render/BrickSource.h"

#include <vector>

namespace banyan
{
namespace
{

/// A brick that is part of what is put together.
struct Neighbour
{
  BrickView View;
  Box Samples;
};

bool IsUniform(const BrickView& view)
{
  return view.Stride[0] == 0 && view.Stride[1] == 0 && view.Stride[2] == 0;
}

/// @param out `[z][y][x]` of `target`
template <class From, class To>
void CopyPart(const Neighbour& from, const Box& target, To* out)
{
  const Box part = Intersection(from.Samples, target);
  const glm::ivec3 size = target.Size();
  const auto* values = static_cast<const From*>(from.View.Values);
  for (int z = part.Lo.z; z < part.Hi.z; ++z)
  {
    for (int y = part.Lo.y; y < part.Hi.y; ++y)
    {
      const glm::ivec3 source = glm::ivec3(part.Lo.x, y, z) - from.Samples.Lo;
      const glm::ivec3 to = glm::ivec3(part.Lo.x, y, z) - target.Lo;
      const From* row = values + source.x * from.View.Stride[0] + source.y * from.View.Stride[1] +
                        source.z * from.View.Stride[2];
      To* outRow = out + (static_cast<std::ptrdiff_t>(to.z) * size.y + to.y) * size.x + to.x;
      for (int x = 0; x < part.Size().x; ++x)
      {
        outRow[x] = static_cast<To>(row[x * from.View.Stride[0]]);
      }
    }
  }
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

  std::vector<Neighbour> neighbours;
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
  BrickView result;
  result.Type = neighbours.front().View.Type;
  for (const Neighbour& neighbour : neighbours)
  {
    result.Type = IsUniform(neighbour.View) ? result.Type : neighbour.View.Type;
  }
  const glm::ivec3 size = samples.Size();
  const auto bytes = std::make_shared<std::vector<double>>(
    (static_cast<std::size_t>(samples.Count()) * SizeOf(result.Type) + sizeof(double) - 1) /
    sizeof(double));
  Dispatch(result.Type,
    [&](auto to)
    {
      using To = typename decltype(to)::Type;
      To* const out = reinterpret_cast<To*>(bytes->data());
      for (const Neighbour& neighbour : neighbours)
      {
        Dispatch(neighbour.View.Type,
          [&](auto from) { CopyPart<typename decltype(from)::Type>(neighbour, samples, out); });
      }
    });
  result.Values = bytes->data();
  result.Stride[1] = size.x;
  result.Stride[2] = std::ptrdiff_t{ size.x } * size.y;
  result.Owner = std::shared_ptr<const void>(bytes, bytes->data());
  return result;
}

} // namespace banyan
