// SPDX-License-Identifier: BSD-3-Clause
#ifndef banyan_Benchmarks_Interaction_CountingCommunicator_h
#define banyan_Benchmarks_Interaction_CountingCommunicator_h

#include "Parallel/Communicate/Communicator.h"

namespace banyan::bench
{

/// Another communicator, and what this rank has asked it for.
class CountingCommunicator final : public Communicator
{
public:
  struct Counts
  {
    std::int64_t Collectives = 0;  ///< barriers, broadcasts and gathers
    std::int64_t Messages = 0;     ///< that this rank has sent to single ranks
    std::int64_t Bytes = 0;        ///< of these messages
    double ProcessorSeconds = 0.0; ///< of the calling threads inside of all functions
  };

  /// @param ranks has to stay
  explicit CountingCommunicator(Communicator& ranks)
    : Inner(ranks)
  {
  }
  /// Since this object was made.
  const Counts& Total() const { return this->Counted; }

  int Rank() const override { return this->Inner.Rank(); }
  int Size() const override { return this->Inner.Size(); }
  bool SendsAtOnce() const override { return this->Inner.SendsAtOnce(); }

  void Send(int to, int tag, const void* data, std::size_t bytes) override;
  void Receive(int from, int tag, void* data, std::size_t bytes) override;
  void WaitAll() override;
  void SendWhole(int to, int tag, const void* data, std::size_t bytes) override;
  void ReceiveWhole(int from, int tag, void* data, std::size_t capacity) override;
  Arrival WaitAnyWhole() override;
  bool TakeAnyWhole(Arrival& arrival) override;
  void Barrier() override;
  void Broadcast(int root, void* data, std::size_t bytes) override;
  void AllGather(const void* mine, std::size_t bytes, void* all) override;
  int RanksOnThisNode() override { return this->Inner.RanksOnThisNode(); }
  void LeaveTogether(const std::string& why) override { this->Inner.LeaveTogether(why); }

private:
  class Inside;

  Communicator& Inner;
  Counts Counted;
};

} // namespace banyan::bench

#endif
