// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/CompositePlanCache.h"

namespace banyan
{

std::shared_ptr<const CompositePlan> CompositePlanCache::Of(
  const std::vector<Footprint>& footprints, const PixelRect& viewport, const PixelRect& behind,
  bool ordered, int root)
{
  Item& item = this->OfRoot[root];
  if (item.Plan && item.Ordered == ordered && item.Viewport == viewport && item.Behind == behind &&
      item.Footprints == footprints)
  {
    ++this->HitCount;
    return item.Plan;
  }
  item.Plan.reset(); // should deriving fail, nothing is kept
  item.Plan = std::make_shared<const CompositePlan>(
    PlanCompositing(footprints, viewport, behind, ordered, root));
  item.Footprints = footprints;
  item.Viewport = viewport;
  item.Behind = behind;
  item.Ordered = ordered;
  ++this->MissCount;
  return item.Plan;
}

} // namespace banyan
