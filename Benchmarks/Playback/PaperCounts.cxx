// SPDX-License-Identifier: BSD-3-Clause
#include "PaperCounts.h"

#include "Base/ThreadPool.h"

#include <algorithm>
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
    Brick brick{ infinity, -infinity, !first };
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
        brick.Same =
          brick.Same && std::equal(begin + box.Lo.x, begin + box.Hi.x,
                          this->Values.begin() + static_cast<std::ptrdiff_t>(row) + box.Lo.x);
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
  std::vector<char> spoils(this->Now.size()); // the rays that meet it
  std::int64_t same = 0;
  for (std::size_t i = 0; i < this->Now.size(); ++i)
  {
    const Brick& now = this->Now[i];
    shown[i] = visible.Any(now.Low, now.High) ? 1 : 0;
    const bool showed = visible.Any(this->Before[i].Low, this->Before[i].High);
    spoils[i] = !now.Same && (shown[i] || showed) ? 1 : 0;
    same += now.Same ? 1 : 0;
  }
  std::int64_t all = 0;
  std::int64_t allSame = 0;
  std::int64_t seen = 0;
  std::int64_t seenSame = 0;
  std::int64_t kept = 0;
  for (const auto& block : this->Blocks)
  {
    std::int64_t here = 0;
    bool spoilt = false;
    for (const auto& [brick, samples] : block)
    {
      const bool equal = this->Now[brick].Same;
      all += samples;
      allSame += equal ? samples : 0;
      here += shown[brick] ? samples : 0;
      seenSame += shown[brick] && equal ? samples : 0;
      spoilt = spoilt || spoils[brick];
    }
    seen += here;
    kept += spoilt ? 0 : here;
  }
  return { Share(same, static_cast<std::int64_t>(this->Now.size())), Share(seen, all),
    Share(allSame, all), Share(seenSame, seen), Share(kept, seen) };
}

} // namespace banyan::bench
