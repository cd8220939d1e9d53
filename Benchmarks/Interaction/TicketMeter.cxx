// SPDX-License-Identifier: BSD-3-Clause
#include "TicketMeter.h"

#include <ctime>

namespace banyan::bench
{

/// The sum of all ranks is that of all their threads, without that in messages.
double TicketMeter::ProcessorSeconds() const
{
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  const double process = static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
  const bool counts = !this->OneProcess || this->Ranks.Rank() == 0;
  return (counts ? process : 0.0) - this->Ranks.Total().ProcessorSeconds;
}

void TicketMeter::Begin()
{
  this->Ranks.Barrier();
  this->Before = this->Ranks.Total();
  this->ProcessorBefore = this->ProcessorSeconds();
  this->Clock.Restart();
}

PictureTook TicketMeter::End(double asks)
{
  PictureTook took;
  took.Milliseconds = this->Milliseconds();
  const CountingCommunicator::Counts now = this->Ranks.Total();
  this->Ranks.Barrier();
  const double processor = this->ProcessorSeconds() - this->ProcessorBefore;
  const auto collectives = static_cast<double>(now.Collectives - this->Before.Collectives);
  this->Ranks.Broadcast(0, &asks, sizeof(asks));
  took.Asks = asks;
  took.Collectives = collectives - asks;
  took.Messages = AllSum(this->Ranks, static_cast<double>(now.Messages - this->Before.Messages));
  took.Bytes = AllSum(this->Ranks, static_cast<double>(now.Bytes - this->Before.Bytes));
  took.ProcessorMilliseconds = 1e3 * AllSum(this->Ranks, processor) / this->Ranks.Size();
  return took;
}

} // namespace banyan::bench
