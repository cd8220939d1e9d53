// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Composite_CompositePlanCache_h
#define banyan_Parallel_Composite_CompositePlanCache_h

#include "Parallel/Composite/CompositePlan.h"

#include <cstdint>
#include <map>
#include <memory>

namespace banyan
{

/// The plans of the last frame, one per root: they are those of the next one too, where neither the
/// camera nor zones have moved. Each rank keeps its own; what it gives out is what PlanCompositing
/// would derive, so ranks need not agree about it.
class CompositePlanCache
{
public:
  /// The arguments are those of PlanCompositing.
  std::shared_ptr<const CompositePlan> Of(const std::vector<Footprint>& footprints,
    const PixelRect& viewport, const PixelRect& behind, bool ordered, int root = 0);

  /// The same of a plan that is kept nowhere, where `plans` is null.
  static std::shared_ptr<const CompositePlan> From(CompositePlanCache* plans,
    const std::vector<Footprint>& footprints, const PixelRect& viewport, const PixelRect& behind,
    bool ordered, int root)
  {
    CompositePlanCache once;
    return (plans ? *plans : once).Of(footprints, viewport, behind, ordered, root);
  }

  /// How often a plan was derived, and how often the last one was used again.
  std::int64_t Misses() const { return this->MissCount; }
  std::int64_t Hits() const { return this->HitCount; }

private:
  struct Item
  {
    std::shared_ptr<const CompositePlan> Plan; ///< of the following
    std::vector<Footprint> Footprints;
    PixelRect Viewport;
    PixelRect Behind;
    bool Ordered = false;
  };
  std::map<int, Item> OfRoot; ///< places of a picture have different ones
  std::int64_t MissCount = 0;
  std::int64_t HitCount = 0;
};

} // namespace banyan

#endif
