// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/Composite/CompositePlanCache.h"

namespace banyan
{

std::shared_ptr<const CompositePlan> CompositePlanCache::Of(
  const std::vector<Footprint>& footprints, const PixelRect& viewport, const PixelRect& behind,
  bool ordered, int root)
{
  if (this->Last && this->Ordered == ordered && this->Root == root && this->Viewport == viewport &&
      this->Behind == behind && this->Footprints == footprints)
  {
    ++this->HitCount;
    return this->Last;
  }
  this->Last.reset(); // should deriving fail, nothing is kept
  this->Last = std::make_shared<const CompositePlan>(
    PlanCompositing(footprints, viewport, behind, ordered, root));
  this->Footprints = footprints;
  this->Viewport = viewport;
  this->Behind = behind;
  this->Ordered = ordered;
  this->Root = root;
  ++this->MissCount;
  return this->Last;
}

} // namespace banyan
