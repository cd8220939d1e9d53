// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Bricks/VisibleContent.h"

#include "Base/Digest.h"
#include "Render/Bricks/VisibleBricks.h"

#include <optional>
#include <string>
#include <vector>

namespace banyan
{
namespace
{

std::vector<std::int64_t> NumbersOf(const std::vector<bool>& bricks)
{
  std::vector<std::int64_t> numbers;
  for (std::size_t brick = 0; brick < bricks.size(); ++brick)
  {
    if (bricks[brick])
    {
      numbers.push_back(static_cast<std::int64_t>(brick));
    }
  }
  return numbers;
}

/// The bricks whose samples can decide a pixel.
std::vector<std::int64_t> BricksThatCount(const RayScene& scene, const BrickSource& source)
{
  const VisibleBricks visible(scene, source);
  const glm::ivec3 counts = source.Bricks();
  const auto all = static_cast<std::size_t>(std::int64_t{ counts.x } * counts.y * counts.z);
  std::vector<bool> seen(all);
  for (std::size_t brick = 0; brick < all; ++brick)
  {
    seen[brick] = visible.Contains(static_cast<std::int64_t>(brick));
  }
  if (!scene.Shading.On)
  {
    return NumbersOf(seen);
  }
  // Gradients take one more layer of samples, of the bricks around.
  std::vector<bool> around(all);
  const Box bricks{ glm::ivec3(0), counts };
  for (std::size_t brick = 0; brick < all; ++brick)
  {
    if (seen[brick])
    {
      const auto number = static_cast<int>(brick);
      const glm::ivec3 at(
        number % counts.x, number / counts.x % counts.y, number / counts.x / counts.y);
      for (int i = 0; i < 27; ++i)
      {
        const glm::ivec3 place = at + glm::ivec3(i % 3, i / 3 % 3, i / 9) - 1;
        if (bricks.Contains(place))
        {
          around[static_cast<std::size_t>(BrickSource::NumberOf(place, counts))] = true;
        }
      }
    }
  }
  return NumbersOf(around);
}

/// Nothing where a brick's content is not known.
std::optional<Hash128> ContentOfLevel(const RayScene& scene, BrickSource& source)
{
  struct Entry
  {
    std::int64_t Brick;
    Hash128 Content;
  };
  const std::vector<std::int64_t> bricks = BricksThatCount(scene, source);
  source.LookAt(bricks);
  std::vector<Entry> entries;
  for (const std::int64_t brick : bricks)
  {
    const std::optional<Hash128> content = source.ContentOf(brick);
    if (!content)
    {
      return std::nullopt;
    }
    entries.push_back({ brick, *content });
  }
  Digest digest;
  const MaskRange range = source.MasksAreOver();
  digest.Add(source.Bricks());
  digest.Add(source.CellsOf(0));
  digest.Add(source.HasColours());
  digest.Add(range.Low);
  digest.Add(range.High);
  digest.Add(entries);
  if (source.Hidden())
  {
    const std::string hidden = source.Hidden()->ToBytes();
    digest.Add(HashOf(hidden.data(), hidden.size()));
  }
  return digest.Get();
}

} // namespace

std::vector<Hash128> VisibleContent(const RayScene& scene, BrickSource& source, int coarsest)
{
  std::vector<Hash128> levels;
  for (int level = 0; level <= coarsest; ++level)
  {
    BrickSource* const at = source.AtLevel(level, scene.DomainCells);
    if (!at)
    {
      break;
    }
    const std::optional<Hash128> content = ContentOfLevel(scene, *at);
    if (!content)
    {
      return {};
    }
    levels.push_back(*content);
  }
  return levels;
}

} // namespace banyan
