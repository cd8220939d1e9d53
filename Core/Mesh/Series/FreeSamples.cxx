// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Series/FreeSamples.h"

#include "Base/ThreadPool.h"
#include "Mesh/Series/Rounded.h"

#include <glm/common.hpp>

#include <algorithm>

namespace banyan
{
namespace
{

/// An image of which some samples have values.
struct Partial
{
  glm::ivec3 Size{ 0 };
  std::vector<double> Values;
  std::vector<std::uint8_t> Known;

  std::int64_t Row(int y, int z) const
  {
    return (std::int64_t{ z } * this->Size.y + y) * this->Size.x;
  }
  std::size_t At(const glm::ivec3& p) const
  {
    return static_cast<std::size_t>(this->Row(p.y, p.z) + p.x);
  }
};

/// Samples of twice the distance: each the average of up to eight.
Partial Coarser(const Partial& fine, ThreadPool& pool)
{
  Partial coarse;
  coarse.Size = (fine.Size + 1) / 2;
  const std::int64_t count = std::int64_t{ coarse.Size.x } * coarse.Size.y * coarse.Size.z;
  coarse.Values.resize(static_cast<std::size_t>(count));
  coarse.Known.resize(static_cast<std::size_t>(count));
  pool.ParallelFor(std::int64_t{ coarse.Size.y } * coarse.Size.z,
    [&](std::int64_t row)
    {
      glm::ivec3 p{ 0, static_cast<int>(row % coarse.Size.y),
        static_cast<int>(row / coarse.Size.y) };
      for (; p.x < coarse.Size.x; ++p.x)
      {
        const glm::ivec3 end = glm::min(2 * p + 2, fine.Size);
        double sum = 0.0;
        int known = 0;
        for (int z = 2 * p.z; z < end.z; ++z)
        {
          for (int y = 2 * p.y; y < end.y; ++y)
          {
            for (int x = 2 * p.x; x < end.x; ++x)
            {
              const std::size_t i = fine.At({ x, y, z });
              if (fine.Known[i] != 0)
              {
                sum += fine.Values[i] / 8.0; // finite where values are as large as can be
                ++known;
              }
            }
          }
        }
        const std::size_t i = coarse.At(p);
        coarse.Known[i] = known > 0 ? 1 : 0;
        coarse.Values[i] = known > 0 ? MeanOfPart(sum, known / 8.0) : 0.0;
      }
    });
  return coarse;
}

/// The sample next to p / 2 that lies on p's side, and how much it counts.
constexpr double NearPart = 0.75;

void Interpolate(const Partial& coarse, Partial& fine, ThreadPool& pool)
{
  pool.ParallelFor(std::int64_t{ fine.Size.y } * fine.Size.z,
    [&](std::int64_t row)
    {
      glm::ivec3 p{ 0, static_cast<int>(row % fine.Size.y), static_cast<int>(row / fine.Size.y) };
      for (; p.x < fine.Size.x; ++p.x)
      {
        const std::size_t i = fine.At(p);
        if (fine.Known[i] != 0)
        {
          continue;
        }
        const glm::ivec3 near = p / 2;
        const glm::ivec3 far =
          glm::clamp(near + (p - 2 * near) * 2 - 1, glm::ivec3{ 0 }, coarse.Size - 1);
        double sum = 0.0;
        for (int c = 0; c < 8; ++c)
        {
          const glm::ivec3 at{ (c & 1) != 0 ? far.x : near.x, (c & 2) != 0 ? far.y : near.y,
            (c & 4) != 0 ? far.z : near.z };
          const double part = ((c & 1) != 0 ? 1.0 - NearPart : NearPart) *
                              ((c & 2) != 0 ? 1.0 - NearPart : NearPart) *
                              ((c & 4) != 0 ? 1.0 - NearPart : NearPart);
          sum += part * coarse.Values[coarse.At(at)];
        }
        fine.Values[i] = sum;
      }
    });
}

} // namespace

void FillFreeSamples(const glm::ivec3& samples, const std::vector<std::uint8_t>& known,
  std::vector<double>& values, ThreadPool& pool)
{
  std::vector<Partial> levels(1);
  levels[0].Size = samples;
  levels[0].Known = known;
  levels[0].Values = std::move(values);
  while (levels.back().Size != glm::ivec3{ 1 })
  {
    levels.push_back(Coarser(levels.back(), pool));
  }
  if (levels.back().Known[0] == 0)
  {
    std::fill(levels[0].Values.begin(), levels[0].Values.end(), 0.0);
  }
  else
  {
    for (std::size_t level = levels.size() - 1; level-- > 0;)
    {
      Interpolate(levels[level + 1], levels[level], pool);
    }
  }
  values = std::move(levels[0].Values);
}

} // namespace banyan
