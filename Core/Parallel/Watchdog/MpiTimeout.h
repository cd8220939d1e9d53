// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Watchdog_MpiTimeout_h
#define banyan_Parallel_Watchdog_MpiTimeout_h

#include <functional>
#include <string>

namespace banyan
{

/// How long ranks are waited for.
struct MpiTimeout
{
  static constexpr double DefaultSeconds = 20.0;

  /// Returns the seconds that the variable BANYAN_RANK_LIMIT_SECONDS says, or DefaultSeconds.
  /// Throws Error.
  static double FromEnvironment();

  /// When a rank gives no sign of life for so long, or does not get on, and others wait for it, the
  /// job ends (MPI_Abort) with a sentence on standard error. Ranks that draw may take as long as
  /// they like. 0 waits for ever.
  double Seconds = FromEnvironment();
  /// Is told the sentence before.
  std::function<void(const std::string&)> Tell;
};

} // namespace banyan

#endif
