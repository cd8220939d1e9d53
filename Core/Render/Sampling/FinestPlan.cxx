// SPDX-License-Identifier: BSD-3-Clause
#include "Render/Sampling/FinestPlan.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace banyan
{
namespace
{

RaySampling Finer(const RaySampling& a, const RaySampling& b)
{
  return { std::min(a.Level, b.Level), std::min(a.Distance, b.Distance),
    std::min(a.PixelStride, b.PixelStride) };
}

std::shared_ptr<const TileSamplings> FinestSamplings(
  const glm::ivec2& imageSize, const TileSamplings& a, const TileSamplings& b)
{
  std::vector<RaySampling> list;
  std::vector<int> numbers;
  const glm::ivec2 tiles = a.Tiles();
  for (int y = 0; y < tiles.y; ++y)
  {
    for (int x = 0; x < tiles.x; ++x)
    {
      const RaySampling finer = Finer(a.At({ x, y }), b.At({ x, y }));
      const auto known = std::find(list.begin(), list.end(), finer);
      numbers.push_back(static_cast<int>(known - list.begin()));
      if (known == list.end())
      {
        list.push_back(finer);
      }
    }
  }
  auto finest = std::make_shared<TileSamplings>(imageSize, std::move(list));
  for (std::size_t i = 0; i < numbers.size(); ++i)
  {
    const auto tile = static_cast<int>(i);
    finest->SetNumber({ tile % tiles.x, tile / tiles.x }, numbers[i]);
  }
  return finest;
}

} // namespace

SamplingPlan FinestPlan(const glm::ivec2& imageSize, const SamplingPlan& a, const SamplingPlan& b)
{
  SamplingPlan plan;
  // Where nothing was seen, any sampling does.
  plan.Samplings = !a.Samplings   ? b.Samplings
                   : !b.Samplings ? a.Samplings
                                  : FinestSamplings(imageSize, *a.Samplings, *b.Samplings);
  const SamplingPlan& worse = a.EstimatedError > b.EstimatedError ? a : b;
  plan.EstimatedError = worse.EstimatedError;
  plan.Limit = worse.Limit;
  plan.Extrapolated = a.Extrapolated || b.Extrapolated;
  plan.OpacityLimit = std::max(a.OpacityLimit, b.OpacityLimit);
  return plan;
}

} // namespace banyan
