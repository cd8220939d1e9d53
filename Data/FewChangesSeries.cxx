// SPDX-License-Identifier: BSD-3-Clause
#include "FewChangesSeries.h"

#include "StandardField.h"

#include "Base/ThreadPool.h"

#include <glm/geometric.hpp>

#include <algorithm>
#include <cmath>

namespace banyan
{

namespace
{

/// Of the box.
constexpr double Radius = 0.08;
constexpr double Orbit = 0.3;

/// Values of the ball, 1 in its middle, over what is there.
void PutBall(const glm::dvec3& centre, int size, ThreadPool& pool, float* values)
{
  const double last = size - 1.0;
  const auto first = static_cast<int>(std::floor((centre.z - Radius) * last));
  const auto count = static_cast<int>(std::ceil(2.0 * Radius * last)) + 2;
  pool.ParallelFor(std::min(count, size - first),
    [&](std::int64_t i)
    {
      const int z = first + static_cast<int>(i);
      for (int y = 0; y < size; ++y)
      {
        float* const row = values + (std::int64_t{ z } * size + y) * size;
        for (int x = 0; x < size; ++x)
        {
          const double away = glm::length(glm::dvec3(x, y, z) / last - centre);
          row[x] = std::max(row[x], static_cast<float>(1.0 - away / Radius));
        }
      }
    });
}

void Generate(const GenerateOptions& options, ThreadPool& pool, const SeriesSink& sink)
{
  const int size = options.Size;
  const StandardFieldSlices field(size);
  const std::int64_t slice = std::int64_t{ size } * size;
  std::vector<float> rest(static_cast<std::size_t>(slice * size));
  pool.ParallelFor(
    size, [&](std::int64_t z) { field.Slice(static_cast<int>(z), rest.data() + z * slice); });
  std::vector<ImageArray> arrays(1);
  arrays[0].Name = options.Arrays.at(0);
  for (int step = 0; step < options.Steps; ++step)
  {
    const double turn = 2.0 * std::acos(-1.0) * step / options.Steps;
    arrays[0].Values = rest;
    PutBall({ 0.5 + Orbit * std::cos(turn), 0.5, 0.5 + Orbit * std::sin(turn) }, size, pool,
      arrays[0].Values.data());
    sink(TimeOfStep(options, step), arrays);
  }
}

} // namespace

SeriesKind FewChangesSeries()
{
  SeriesKind kind;
  kind.Name = "few-changes";
  kind.FileName = "few_changes";
  kind.Description = "blobs and waves at rest, and a ball that goes round in them; unit spacing";
  kind.Arrays = { "value" };
  kind.DefaultSize = 128;
  kind.DefaultSteps = 50;
  kind.Edge = 0.0;
  kind.Generate = Generate;
  return kind;
}

} // namespace banyan
