// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_PeakMemory_h
#define banyan_Benchmarks_PeakMemory_h

#include <fstream>
#include <malloc.h>
#include <string>

namespace banyan::bench
{

/// Megabytes that the process has taken at most since the last call of ForgetPeak.
inline double PeakMegabytes()
{
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
  {
    if (line.rfind("VmHWM:", 0) == 0)
    {
      return std::stod(line.substr(6)) / 1024.0;
    }
  }
  return 0.0;
}

/// What was freed goes back to the system first, so that it counts when it is taken again.
inline void ForgetPeak()
{
  malloc_trim(0);
  std::ofstream("/proc/self/clear_refs") << "5";
}

} // namespace banyan::bench

#endif
