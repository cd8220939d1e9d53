// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_StopFlag_h
#define banyan_Base_StopFlag_h

#include "Base/Interruption.h"

#include <atomic>

namespace banyan
{

/// Asks work in other threads to end early. Whoever works calls Check between its parts.
class StopFlag
{
public:
  void Ask() noexcept { this->Asked.store(true, std::memory_order_relaxed); }
  bool IsAsked() const noexcept { return this->Asked.load(std::memory_order_relaxed); }

  /// Throws Interruption if somebody has asked.
  void Check() const
  {
    if (this->IsAsked())
    {
      throw Interruption("The work was stopped.");
    }
  }

private:
  std::atomic<bool> Asked{ false };
};

} // namespace banyan

#endif
