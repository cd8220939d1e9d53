// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_Interaction_TicketMeter_h
#define banyan_Benchmarks_Interaction_TicketMeter_h

#include "CountingCommunicator.h"

#include "Base/Timer.h"

namespace banyan::bench
{

/// What one picture took. The same on all ranks, but for wall-clock times, which are this rank's.
struct PictureTook
{
  double Milliseconds = 0.0;
  double CoarseMilliseconds = 0.0;    ///< until the coarse picture; 0 where there is none
  double ProcessorMilliseconds = 0.0; ///< mean of all ranks, without that in messages
  double Collectives = 0.0;           ///< operations that draw the picture
  double Asks = 0.0;     ///< gathers by which main threads learn what the threads of all ranks need
  double Messages = 0.0; ///< between single ranks, of all ranks
  double Bytes = 0.0;    ///< of these messages
};

/// Measures a picture of all ranks.
class TicketMeter
{
public:
  /// @param oneProcess whether all ranks are threads of this process
  TicketMeter(CountingCommunicator& ranks, bool oneProcess)
    : Ranks(ranks)
    , OneProcess(oneProcess)
  {
  }

  /// Collective.
  void Begin();
  /// Since Begin.
  double Milliseconds() const { return 1e3 * this->Clock.Seconds(); }
  /// Collective.
  /// @param asks on the first rank: how many of the collective operations were such
  PictureTook End(double asks);

private:
  double ProcessorSeconds() const;

  CountingCommunicator& Ranks;
  bool OneProcess;
  Timer Clock;
  CountingCommunicator::Counts Before;
  double ProcessorBefore = 0.0;
};

} // namespace banyan::bench

#endif
