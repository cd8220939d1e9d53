// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/GatherPlan.h"

namespace banyan
{

std::vector<Box> Subtract(const Box& box, const Box& hole)
{
  std::vector<Box> left;
  const Box common = Intersection(box, hole);
  if (common.Empty())
  {
    if (!box.Empty())
    {
      left.push_back(box);
    }
    return left;
  }
  // Cut slabs off, z first: they keep whole rows of samples.
  Box rest = box;
  for (int axis = 2; axis >= 0; --axis)
  {
    Box below = rest;
    below.Hi[axis] = common.Lo[axis];
    Box above = rest;
    above.Lo[axis] = common.Hi[axis];
    for (const Box& slab : { below, above })
    {
      if (!slab.Empty())
      {
        left.push_back(slab);
      }
    }
    rest.Lo[axis] = common.Lo[axis];
    rest.Hi[axis] = common.Hi[axis];
  }
  return left;
}

GatherPlan PlanGathering(const Box& whole, const std::vector<Box>& pieces)
{
  GatherPlan plan;
  if (!whole.Empty())
  {
    plan.Missing.push_back(whole);
  }
  for (std::size_t rank = 0; rank < pieces.size(); ++rank)
  {
    std::vector<Box> missing;
    for (const Box& box : plan.Missing)
    {
      const Box part = Intersection(box, pieces[rank]);
      if (!part.Empty())
      {
        plan.Parts.push_back({ static_cast<int>(rank), part });
      }
      const std::vector<Box> left = Subtract(box, part);
      missing.insert(missing.end(), left.begin(), left.end());
    }
    plan.Missing = std::move(missing);
  }
  return plan;
}

} // namespace banyan
