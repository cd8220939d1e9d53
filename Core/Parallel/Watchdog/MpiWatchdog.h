// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_Watchdog_MpiWatchdog_h
#define banyan_Parallel_Watchdog_MpiWatchdog_h

#include "Base/Timer.h"
#include "Parallel/Watchdog/Heartbeat.h"
#include "Parallel/Watchdog/MpiTimeout.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <memory>
#include <string>

namespace banyan
{

/// Waits for other ranks, and ends the job when one of them is lost, instead of waiting for ever. A
/// communicator has one attached, or waits in calls of MPI. README.md has its protocol.
class MpiWatchdog
{
public:
  /// Collective.
  /// @param timeout that of the first rank counts for all
  /// @return null on all ranks where ranks are waited for as long as it takes, or there is one only
  static std::unique_ptr<MpiWatchdog> Attach(MPI_Comm handle, const MpiTimeout& timeout);
  ~MpiWatchdog();
  MpiWatchdog(const MpiWatchdog&) = delete;
  MpiWatchdog& operator=(const MpiWatchdog&) = delete;

  /// Calls `test` until it returns true: without pause at first, then with pauses that leave the
  /// processor to others. Ends the job when a rank of this machine is lost.
  template <typename Test>
  void Until(const Test& test)
  {
    if (test())
    {
      return;
    }
    const WaitScope scope;
    const Timer timer;
    for (int tries = 1; !test(); ++tries)
    {
      if (tries >= SpinTries)
      {
        this->Pause(timer.Seconds());
      }
    }
  }

  /// Collective among ranks that have failed: returns when all are here. When some are not, for as
  /// long as the limit, while nobody works, this rank has failed alone, and the job ends.
  void LeaveTogether(const std::string& why);

private:
  static constexpr int SpinTries = 64;

  MpiWatchdog(MPI_Comm handle, const MpiTimeout& timeout);
  void Pause(double waited);
  void LookAround(double waited);
  bool OthersWork() const;
  [[noreturn]] void EndJob(const std::string& sentence) const;

  MPI_Comm Handle;
  MPI_Comm Leaving = MPI_COMM_NULL; ///< where those who failed meet, away from others' messages
  int Self = 0;
  MpiTimeout Timeout;
  std::unique_ptr<Heartbeat> Beat; ///< null where ranks cannot see each other
  std::unique_ptr<LostRankDetector> Lost;
  Timer SinceLook;
};

} // namespace banyan

#endif
