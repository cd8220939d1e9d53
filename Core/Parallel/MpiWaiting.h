// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Parallel_MpiWaiting_h
#define banyan_Parallel_MpiWaiting_h

#include "Base/Timer.h"
#include "Parallel/MpiCommunicator.h"
#include "Parallel/RankPulse.h"

#define OMPI_SKIP_MPICXX 1
#define MPICH_SKIP_MPICXX 1
#include <mpi.h>

#include <memory>
#include <string>

namespace banyan
{

/// Throws Error with MPI's words unless `code` is success.
void CheckMpi(int code, const char* action);

/// Waits for other ranks, and ends the job when one of them is lost, instead of waiting for ever.
class MpiWaiting
{
public:
  /// Collective. The first rank's limit counts for all.
  MpiWaiting(MPI_Comm handle, const MpiPatience& patience);
  ~MpiWaiting();
  MpiWaiting(const MpiWaiting&) = delete;
  MpiWaiting& operator=(const MpiWaiting&) = delete;

  /// Whether waits are to go through `Until` at all.
  bool IsOn() const { return this->Limit > 0.0; }

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

  void Pause(double waited);
  void LookAround(double waited);
  bool OthersWork() const;
  [[noreturn]] void EndJob(const std::string& sentence) const;

  MPI_Comm Handle;
  MPI_Comm Leaving = MPI_COMM_NULL; ///< where those who failed meet, away from others' messages
  int Self = 0;
  double Limit = 0; ///< seconds; 0: for ever
  MpiPatience Patience;
  std::unique_ptr<RankPulse> Pulse; ///< null where ranks cannot see each other
  std::unique_ptr<LostRanks> Lost;
  Timer SinceLook;
};

} // namespace banyan

#endif
