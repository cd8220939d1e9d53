// SPDX-License-Identifier: BSD-3-Clause
#include "CountingCommunicator.h"

#include <ctime>

namespace banyan::bench
{
namespace
{

double ThreadSeconds()
{
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

} // namespace

/// Adds what the calling thread takes.
class CountingCommunicator::Inside
{
public:
  explicit Inside(Counts& counts)
    : To(counts)
  {
  }
  ~Inside() { this->To.ProcessorSeconds += ThreadSeconds() - this->Began; }
  Inside(const Inside&) = delete;
  Inside& operator=(const Inside&) = delete;

private:
  Counts& To;
  double Began = ThreadSeconds();
};

void CountingCommunicator::Send(int to, int tag, const void* data, std::size_t bytes)
{
  const Inside inside(this->Counted);
  ++this->Counted.Messages;
  this->Counted.Bytes += static_cast<std::int64_t>(bytes);
  this->Inner.Send(to, tag, data, bytes);
}

void CountingCommunicator::Receive(int from, int tag, void* data, std::size_t bytes)
{
  const Inside inside(this->Counted);
  this->Inner.Receive(from, tag, data, bytes);
}

void CountingCommunicator::WaitAll()
{
  const Inside inside(this->Counted);
  this->Inner.WaitAll();
}

void CountingCommunicator::SendWhole(int to, int tag, const void* data, std::size_t bytes)
{
  const Inside inside(this->Counted);
  ++this->Counted.Messages;
  this->Counted.Bytes += static_cast<std::int64_t>(bytes);
  this->Inner.SendWhole(to, tag, data, bytes);
}

void CountingCommunicator::ReceiveWhole(int from, int tag, void* data, std::size_t capacity)
{
  const Inside inside(this->Counted);
  this->Inner.ReceiveWhole(from, tag, data, capacity);
}

Communicator::Arrival CountingCommunicator::WaitAnyWhole()
{
  const Inside inside(this->Counted);
  return this->Inner.WaitAnyWhole();
}

bool CountingCommunicator::TakeAnyWhole(Arrival& arrival)
{
  const Inside inside(this->Counted);
  return this->Inner.TakeAnyWhole(arrival);
}

void CountingCommunicator::Barrier()
{
  const Inside inside(this->Counted);
  ++this->Counted.Collectives;
  this->Inner.Barrier();
}

void CountingCommunicator::Broadcast(int root, void* data, std::size_t bytes)
{
  const Inside inside(this->Counted);
  ++this->Counted.Collectives;
  this->Inner.Broadcast(root, data, bytes);
}

void CountingCommunicator::AllGather(const void* mine, std::size_t bytes, void* all)
{
  const Inside inside(this->Counted);
  ++this->Counted.Collectives;
  this->Inner.AllGather(mine, bytes, all);
}

} // namespace banyan::bench
