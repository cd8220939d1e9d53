// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Testing_Core_Targets_h
#define banyan_Testing_Core_Targets_h

#include <cstdint>
#include <vector>

#include <hwy/targets.h>

namespace targets
{

/// Dispatches to one set of instructions only, until it goes.
class OnlyTarget
{
public:
  explicit OnlyTarget(std::int64_t target)
  {
    hwy::SetSupportedTargetsForTest(target);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  ~OnlyTarget()
  {
    hwy::SetSupportedTargetsForTest(0);
    hwy::GetChosenTarget().Update(hwy::SupportedTargets());
  }
  OnlyTarget(const OnlyTarget&) = delete;
  OnlyTarget& operator=(const OnlyTarget&) = delete;
};

/// All that this machine can run, the poorest included.
inline std::vector<std::int64_t> OfThisMachine()
{
  std::vector<std::int64_t> targets;
  const std::int64_t supported = hwy::SupportedTargets();
  for (int bit = 0; bit < 63; ++bit)
  {
    if ((supported >> bit & 1) != 0)
    {
      targets.push_back(std::int64_t{ 1 } << bit);
    }
  }
  return targets;
}

} // namespace targets

#endif
