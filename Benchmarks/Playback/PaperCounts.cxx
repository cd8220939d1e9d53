// SPDX-License-Identifier: BSD-3-Clause
#include "PaperCounts.h"

#include "Base/ThreadPool.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan::bench
{
namespace
{

constexpr int BlockEdge = 4; ///< pixels

double Share(std::int64_t part, std::int64_t whole)
{
  return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
}

/// The largest difference of a channel of two entries, premultiplied, of values in a range that are
/// at most so far apart.
double LargestChange(const TransferFunction& function, double low, double high, double apart)
{
  const auto last = static_cast<std::ptrdiff_t>(function.Entries.size()) - 1;
  const double perValue = static_cast<double>(last) / (function.High - function.Low);
  const auto entryOf = [&](double value)
  {
    return std::clamp(
      static_cast<std::ptrdiff_t>((value - function.Low) * perValue), std::ptrdiff_t{ 0 }, last);
  };
  const std::ptrdiff_t first = entryOf(low);
  const std::ptrdiff_t end = std::min(entryOf(high) + 1, last);
  const auto reach =
    static_cast<std::ptrdiff_t>(std::min(apart * perValue, static_cast<double>(last))) + 1;
  const auto at = [&](std::ptrdiff_t entry)
  {
    const glm::vec4& of = function.Entries[static_cast<std::size_t>(entry)];
    return glm::vec4(glm::vec3(of) * of.a, of.a);
  };
  float largest = 0.0f;
  for (std::ptrdiff_t i = first; i <= end; ++i)
  {
    for (std::ptrdiff_t j = i + 1; j <= std::min(i + reach, end); ++j)
    {
      const glm::vec4 change = glm::abs(at(i) - at(j));
      largest = std::max({ largest, change.r, change.g, change.b, change.a });
    }
  }
  return largest;
}

} // namespace

PaperCounts::PaperCounts(const RayScene& scene, const glm::ivec3& samples, int brickCells)
  : Samples(samples)
  , BrickCells(brickCells)
  , Counts((samples - 2) / brickCells + 1)
  , Now(static_cast<std::size_t>(this->Counts.x) * this->Counts.y * this->Counts.z)
{
  this->MeetBricks(scene);
}

void PaperCounts::MeetBricks(const RayScene& scene)
{
  const RayCamera camera = scene.Camera.InSpace(scene.IndexToWorld);
  const glm::ivec2 size = camera.ImageSize();
  const glm::ivec2 blocks = (size + BlockEdge - 1) / BlockEdge;
  const glm::dvec3 end(this->Samples - 1);
  this->Blocks.resize(static_cast<std::size_t>(blocks.x) * blocks.y);
  const auto meet = [&](std::int64_t number)
  {
    const auto block = static_cast<std::size_t>(number);
    std::vector<int> met(this->Now.size(), 0);
    const glm::ivec2 first = BlockEdge * glm::ivec2(number % blocks.x, number / blocks.x);
    for (int y = first.y; y < std::min(first.y + BlockEdge, size.y); ++y)
    {
      for (int x = first.x; x < std::min(first.x + BlockEdge, size.x); ++x)
      {
        const Ray ray = camera.RayOf(x, y);
        for (auto k = static_cast<std::int64_t>(ray.Near); k + 0.5 < ray.Far; ++k)
        {
          const glm::dvec3 at = ray.Origin + (k + 0.5) * ray.Direction;
          if (glm::all(glm::greaterThanEqual(at, glm::dvec3(0.0))) &&
              glm::all(glm::lessThan(at, end)))
          {
            const glm::ivec3 brick = glm::ivec3(at) / this->BrickCells;
            ++met[(static_cast<std::size_t>(brick.z) * this->Counts.y + brick.y) * this->Counts.x +
                  brick.x];
          }
        }
      }
    }
    for (std::size_t brick = 0; brick < met.size(); ++brick)
    {
      if (met[brick] > 0)
      {
        this->Blocks[block].emplace_back(brick, met[brick]);
      }
    }
  };
  ThreadPool::Process().ParallelFor(static_cast<std::int64_t>(this->Blocks.size()), meet);
}

Box PaperCounts::SamplesOf(std::int64_t brick) const
{
  const std::int64_t row = brick / this->Counts.x;
  const glm::ivec3 lo = this->BrickCells * glm::ivec3(brick % this->Counts.x, row % this->Counts.y,
                                             row / this->Counts.y);
  return { lo, glm::min(lo + this->BrickCells + 1, this->Samples) };
}

void PaperCounts::Take(std::vector<float> values)
{
  std::swap(this->Before, this->Now);
  this->Now.resize(this->Before.size());
  const bool first = this->Values.empty();
  const auto look = [&](std::int64_t number)
  {
    const Box box = this->SamplesOf(number);
    constexpr float infinity = std::numeric_limits<float>::infinity();
    Brick brick{ infinity, -infinity, first ? infinity : 0.0f, !first };
    for (int z = box.Lo.z; z < box.Hi.z; ++z)
    {
      for (int y = box.Lo.y; y < box.Hi.y; ++y)
      {
        const std::size_t row =
          (static_cast<std::size_t>(z) * this->Samples.y + y) * this->Samples.x;
        const auto begin = values.begin() + static_cast<std::ptrdiff_t>(row);
        const auto [low, high] = std::minmax_element(begin + box.Lo.x, begin + box.Hi.x);
        brick.Low = std::min(brick.Low, *low);
        brick.High = std::max(brick.High, *high);
        for (int x = box.Lo.x; x < box.Hi.x && !first; ++x)
        {
          const auto at = static_cast<std::size_t>(x) + row;
          brick.Apart = std::max(brick.Apart, std::abs(values[at] - this->Values[at]));
        }
        brick.Same = !first && brick.Apart == 0.0f;
      }
    }
    this->Now[static_cast<std::size_t>(number)] = brick;
  };
  ThreadPool::Process().ParallelFor(static_cast<std::int64_t>(this->Now.size()), look);
  this->Values = std::move(values);
}

PaperCounts::Shares PaperCounts::Of(const TransferFunction& function) const
{
  const VisibleValues visible(function);
  std::vector<char> shown(this->Now.size());
  std::vector<char> spoils(this->Now.size());        // the rays that meet it
  std::vector<double> change(this->Now.size(), 0.0); // of a sample
  std::int64_t same = 0;
  for (std::size_t i = 0; i < this->Now.size(); ++i)
  {
    const Brick& now = this->Now[i];
    shown[i] = visible.Any(now.Low, now.High) ? 1 : 0;
    const bool showed = visible.Any(this->Before[i].Low, this->Before[i].High);
    spoils[i] = !now.Same && (shown[i] || showed) ? 1 : 0;
    same += now.Same ? 1 : 0;
    if (spoils[i])
    {
      change[i] = LargestChange(function, std::min(now.Low, this->Before[i].Low),
        std::max(now.High, this->Before[i].High), now.Apart);
    }
  }
  std::int64_t all = 0;
  std::int64_t allSame = 0;
  std::int64_t seen = 0;
  std::int64_t seenSame = 0;
  std::int64_t kept = 0;
  std::array<std::int64_t, Tolerances.size()> within{};
  for (const auto& block : this->Blocks)
  {
    std::int64_t here = 0;
    bool spoilt = false;
    double changes = 0.0;
    for (const auto& [brick, samples] : block)
    {
      const bool equal = this->Now[brick].Same;
      all += samples;
      allSame += equal ? samples : 0;
      here += shown[brick] ? samples : 0;
      seenSame += shown[brick] && equal ? samples : 0;
      spoilt = spoilt || spoils[brick];
      changes += change[brick] * samples / (BlockEdge * BlockEdge);
    }
    seen += here;
    kept += spoilt ? 0 : here;
    for (std::size_t i = 0; i < within.size(); ++i)
    {
      within[i] += 255.0 * changes <= Tolerances[i] ? here : 0;
    }
  }
  return { Share(same, static_cast<std::int64_t>(this->Now.size())), Share(seen, all),
    Share(allSame, all), Share(seenSame, seen), Share(kept, seen),
    { { Share(within[0], seen), Share(within[1], seen) } } };
}

} // namespace banyan::bench
