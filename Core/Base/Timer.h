// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Base_Timer_h
#define banyan_Base_Timer_h

#include <chrono>

namespace banyan
{

/// Wall-clock seconds since construction or the last `Restart()`.
class Timer
{
public:
  double Seconds() const
  {
    return std::chrono::duration<double>(Clock::now() - this->Start).count();
  }
  void Restart() { this->Start = Clock::now(); }

private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point Start = Clock::now();
};

} // namespace banyan

#endif
