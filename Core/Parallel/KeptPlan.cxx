// SPDX-License-Identifier: BSD-3-Clause
#include "Parallel/KeptPlan.h"

namespace banyan
{

std::shared_ptr<const CompositePlan> KeptPlan::Of(const std::vector<Footprint>& footprints,
  const PixelRect& viewport, const PixelRect& behind, bool ordered)
{
  if (this->Last && this->Ordered == ordered && this->Viewport == viewport &&
      this->Behind == behind && this->Footprints == footprints)
  {
    ++this->TimesKept;
    return this->Last;
  }
  this->Last.reset(); // should deriving fail, nothing is kept
  this->Last =
    std::make_shared<const CompositePlan>(PlanCompositing(footprints, viewport, behind, ordered));
  this->Footprints = footprints;
  this->Viewport = viewport;
  this->Behind = behind;
  this->Ordered = ordered;
  ++this->TimesDerived;
  return this->Last;
}

} // namespace banyan
