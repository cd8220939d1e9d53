// SPDX-License-Identifier: BSD-3-Clause
#include "Mesh/Cells/CellArray.h"

#include "Base/ThreadPool.h"
#include "Mesh/Octree/TakenComponent.h"
#include "Render/Bricks/Interpolators.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace banyan
{
namespace
{

constexpr std::int64_t Run = 1 << 16;

std::int64_t RunsOf(std::int64_t count)
{
  return (count + Run - 1) / Run;
}

/// Calls function(i) for all numbers of a run.
template <class Function>
void ForRun(std::int64_t run, std::int64_t count, const Function& function)
{
  const std::int64_t end = std::min(count, (run + 1) * Run);
  for (std::int64_t i = run * Run; i < end; ++i)
  {
    function(i);
  }
}

/// Floats, and lengths of vectors that may be longer than any float.
float Rounded(double value)
{
  constexpr double most = std::numeric_limits<float>::max();
  return static_cast<float>(std::isfinite(value) ? std::clamp(value, -most, most) : value);
}

} // namespace

double LowestOf(const NodeArray& array, std::int64_t count, ThreadPool& pool)
{
  constexpr double none = std::numeric_limits<double>::infinity();
  if (count == 0)
  {
    return none;
  }
  RequireComponent(array);
  std::vector<double> lowest(static_cast<std::size_t>(RunsOf(count)), none);
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* const from = static_cast<const T*>(array.Values);
      pool.ParallelFor(RunsOf(count),
        [&](std::int64_t run)
        {
          double low = none;
          ForRun(run, count,
            [&](std::int64_t i)
            {
              const double value = TakenComponent(from + i * array.Components, array);
              low = std::isfinite(value) ? std::min(low, value) : low;
            });
          lowest[static_cast<std::size_t>(run)] = low;
        });
    });
  return *std::min_element(lowest.begin(), lowest.end());
}

CellArray CellArrayOf(const NodeArray& array, std::int64_t count, ValuesOn where, ThreadPool& pool,
  std::optional<double> base)
{
  CellArray taken;
  taken.Where = where;
  if (count == 0)
  {
    return taken;
  }
  RequireComponent(array);
  if (!FitsFloat(array.Type))
  {
    const double low = base ? *base : LowestOf(array, count, pool);
    taken.Base = std::isfinite(low) ? low : 0.0;
  }
  taken.Values.resize(static_cast<std::size_t>(count));
  Dispatch(array.Type,
    [&](auto tag)
    {
      using T = typename decltype(tag)::Type;
      const T* const from = static_cast<const T*>(array.Values);
      pool.ParallelFor(RunsOf(count),
        [&](std::int64_t run)
        {
          ForRun(run, count,
            [&](std::int64_t i)
            {
              const double value = TakenComponent(from + i * array.Components, array);
              taken.Values[static_cast<std::size_t>(i)] =
                IsRelative<T> ? CornerValue(value, taken.Base) : Rounded(value);
            });
        });
    });
  return taken;
}

} // namespace banyan
